# Puts the page together from its parts, and makes a C++ file of it.
#
# usage: cmake -DOUT=FILE -DPAGE=page.html -DPARTS=FILE,... -P EmbedPage.cmake   (each part goes where its name is
# in double braces)
file(READ ${PAGE} page)
string(REPLACE "," ";" parts "${PARTS}")
foreach(part IN LISTS parts)
    get_filename_component(name ${part} NAME)
    file(READ ${part} text)
    string(REPLACE "{{${name}}}" "${text}" page "${page}")
endforeach()
file(WRITE ${OUT} "// Made by EmbedPage.cmake.\n#include \"report/PageTemplate.h\"\n"
    "#pragma GCC diagnostic ignored \"-Woverlength-strings\" // of clang's, whose limit is C++'s minimum\n"
    "const char* const kPageTemplate = R\"vdbtet(${page})vdbtet\";\n")
