# Fails unless README contains the program in MAIN, word for word.
file(READ ${README} readme)
file(READ ${MAIN} main)
string(FIND "${readme}" "${main}" position)
if(position EQUAL -1)
    message(FATAL_ERROR "${README} does not contain ${MAIN}")
endif()
