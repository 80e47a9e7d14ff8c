# Defines OpenVDB::openvdb, from the config package that OpenVDB has since 14, else from the find module that it
# installs below <prefix>/lib/cmake/OpenVDB. Leaves the target undefined where there is no OpenVDB.

# A function, since the find module sets BUILD_SHARED_LIBS and more in the scope of its caller.
function(vdbtet_find_openvdb)
    if(TARGET OpenVDB::openvdb)
        return()
    endif()
    find_package(OpenVDB CONFIG QUIET)
    if(NOT TARGET OpenVDB::openvdb)
        find_path(VDBTET_OPENVDB_MODULE_DIR FindOpenVDB.cmake
            PATHS ${OpenVDB_ROOT} $ENV{OpenVDB_ROOT} ${CMAKE_PREFIX_PATH} $ENV{CMAKE_PREFIX_PATH}
                  ${CMAKE_SYSTEM_PREFIX_PATH}
            PATH_SUFFIXES lib/${CMAKE_LIBRARY_ARCHITECTURE}/cmake/OpenVDB lib/cmake/OpenVDB lib64/cmake/OpenVDB
            NO_DEFAULT_PATH)
        mark_as_advanced(VDBTET_OPENVDB_MODULE_DIR)
        if(NOT VDBTET_OPENVDB_MODULE_DIR)
            return()
        endif()
        list(APPEND CMAKE_MODULE_PATH ${VDBTET_OPENVDB_MODULE_DIR})
        # The module is chatty, and Debian's Imath complains that its Python binding is missing.
        set(CMAKE_MESSAGE_LOG_LEVEL WARNING)
        find_package(OpenVDB MODULE QUIET)
    endif()
    if(OpenVDB_VERSION VERSION_LESS 10)
        message(FATAL_ERROR "vdbtet needs OpenVDB 10 or later; found ${OpenVDB_VERSION}")
    endif()
endfunction()
