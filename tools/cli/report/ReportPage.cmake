# Included for vdbtet_tool: the report as a page. three.js is a package of Debian and Ubuntu; without it the tool writes
# JSON alone.
find_path(VDBTET_THREE_JS three.min.js PATHS /usr/share/javascript/three /usr/share/nodejs/three/build
    DOC "Folder of three.min.js, for reports in HTML")
set(controls ${VDBTET_THREE_JS}/examples/js/controls/OrbitControls.js)
set(template ${CMAKE_CURRENT_BINARY_DIR}/PageTemplate.cc)
if(VDBTET_THREE_JS AND EXISTS ${controls})
    set(page ${CMAKE_CURRENT_LIST_DIR}/web/page.html)
    file(GLOB parts CONFIGURE_DEPENDS ${CMAKE_CURRENT_LIST_DIR}/web/*.css
        ${CMAKE_CURRENT_LIST_DIR}/web/*.js ${CMAKE_CURRENT_LIST_DIR}/web/*.txt)
    list(APPEND parts ${VDBTET_THREE_JS}/three.min.js ${controls})
    list(JOIN parts "," joined)
    add_custom_command(OUTPUT ${template}
        COMMAND ${CMAKE_COMMAND} -DOUT=${template} -DPAGE=${page} -DPARTS=${joined}
            -P ${CMAKE_CURRENT_LIST_DIR}/EmbedPage.cmake
        DEPENDS ${CMAKE_CURRENT_LIST_DIR}/EmbedPage.cmake ${page} ${parts}
        VERBATIM)
else()
    message(WARNING "three.js was not found (VDBTET_THREE_JS), so vdb_tet will write no reports in HTML; "
        "see libjs-three in tools/install_deps.sh")
    file(GENERATE OUTPUT ${template}
        CONTENT "#include \"report/PageTemplate.h\"\nconst char* const kPageTemplate = \"\";\n")
endif()
target_sources(vdbtet_tool PRIVATE report/PageData.cc report/Picture.cc report/ReportPage.cc ${template})
