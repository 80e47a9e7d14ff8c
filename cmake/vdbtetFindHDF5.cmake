# Defines vdbtet::hdf5, the C library of HDF5 1.10.3 or later: from the config package that HDF5 installs, else by its
# files, where Debian has them, too. CMake's own FindHDF5 wants the C language, which a consumer may not have enabled.
# Leaves the target undefined where there is no HDF5.

# A function, since config packages set variables in the scope of their caller.
function(vdbtet_find_hdf5)
    if(TARGET vdbtet::hdf5)
        return()
    endif()
    find_package(HDF5 CONFIG QUIET)
    foreach(target hdf5::hdf5-shared hdf5-shared hdf5::hdf5-static hdf5-static)
        if(TARGET ${target} AND HDF5_VERSION VERSION_GREATER_EQUAL 1.10.3)
            add_library(vdbtet::hdf5 INTERFACE IMPORTED)
            target_link_libraries(vdbtet::hdf5 INTERFACE ${target})
            return()
        endif()
    endforeach()

    find_path(VDBTET_HDF5_INCLUDE_DIR hdf5.h PATH_SUFFIXES hdf5/serial)
    find_library(VDBTET_HDF5_LIBRARY NAMES hdf5 hdf5_serial PATH_SUFFIXES hdf5/serial)
    mark_as_advanced(VDBTET_HDF5_INCLUDE_DIR VDBTET_HDF5_LIBRARY)
    if(VDBTET_HDF5_INCLUDE_DIR AND VDBTET_HDF5_LIBRARY)
        add_library(vdbtet::hdf5 UNKNOWN IMPORTED)
        set_target_properties(vdbtet::hdf5 PROPERTIES
            IMPORTED_LOCATION ${VDBTET_HDF5_LIBRARY}
            INTERFACE_INCLUDE_DIRECTORIES ${VDBTET_HDF5_INCLUDE_DIR})
    endif()
endfunction()
