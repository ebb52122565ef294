# `solver stiff by sundials`. Without SUNDIALS the module builds, and says what is missing where a scene asks for it.
set(PUPPETRI_SUNDIALS AUTO CACHE STRING "equations by SUNDIALS: AUTO (if it is there), ON or OFF")
set_property(CACHE PUPPETRI_SUNDIALS PROPERTY STRINGS AUTO ON OFF)
if(PUPPETRI_SUNDIALS STREQUAL AUTO OR PUPPETRI_SUNDIALS)
    # Only these parts: the package as a whole asks for MPI, PETSc and hypre.
    find_path(PUPPETRI_CVODE_INCLUDE cvode/cvode.h)
    set(cvode_libraries "")
    foreach(part cvode nvecserial sunmatrixdense sunmatrixband sunlinsoldense sunlinsolband)
        find_library(PUPPETRI_CVODE_${part} sundials_${part})
        list(APPEND cvode_libraries "${PUPPETRI_CVODE_${part}}")
    endforeach()
    if(NOT EMSCRIPTEN AND PUPPETRI_CVODE_INCLUDE AND NOT "${cvode_libraries}" MATCHES NOTFOUND)
        target_link_libraries(puppetri_scene PRIVATE ${cvode_libraries})
        set_source_files_properties("${CMAKE_CURRENT_SOURCE_DIR}/src/scene/sundials.cpp" PROPERTIES
            COMPILE_DEFINITIONS PUPPETRI_WITH_SUNDIALS=1 INCLUDE_DIRECTORIES "${PUPPETRI_CVODE_INCLUDE}")
    elseif(NOT PUPPETRI_SUNDIALS STREQUAL AUTO)
        message(FATAL_ERROR "PUPPETRI_SUNDIALS is ON, and SUNDIALS is not there (Debian: apt-get install libsundials-dev)")
    endif()
endif()
