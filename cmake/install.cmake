# The targets puppetri::net, puppetri::stage and puppetri::full, for who adds this folder as a subdirectory and for who
# installs it and calls find_package(puppetri COMPONENTS net).
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

foreach(component net stage full)
    if(component STREQUAL full)
        set(modules ${PUPPETRI_MODULES})
    else()
        set(modules ${PUPPETRI_MODULES_${component}})
    endif()
    add_library(puppetri_component_${component} INTERFACE)
    add_library(puppetri::${component} ALIAS puppetri_component_${component})
    set_target_properties(puppetri_component_${component} PROPERTIES EXPORT_NAME ${component})
    foreach(module IN LISTS modules)
        target_link_libraries(puppetri_component_${component} INTERFACE puppetri_${module})
    endforeach()
    install(TARGETS puppetri_component_${component} EXPORT puppetri)
    if(component STREQUAL PUPPETRI_COMPONENT)
        break()
    endif()
endforeach()

foreach(module IN LISTS PUPPETRI_MODULES)
    set_target_properties(puppetri_${module} PROPERTIES EXPORT_NAME module_${module})
    install(TARGETS puppetri_${module} EXPORT puppetri)
    if(EXISTS "${CMAKE_CURRENT_SOURCE_DIR}/include/puppetri/${module}")
        install(DIRECTORY include/puppetri/${module} DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/puppetri")
    endif()
endforeach()

set(where "${CMAKE_INSTALL_LIBDIR}/cmake/puppetri")
install(EXPORT puppetri NAMESPACE puppetri:: FILE puppetriTargets.cmake DESTINATION "${where}")
configure_package_config_file(cmake/puppetriConfig.cmake.in "${CMAKE_CURRENT_BINARY_DIR}/puppetriConfig.cmake"
    INSTALL_DESTINATION "${where}")
write_basic_package_version_file("${CMAKE_CURRENT_BINARY_DIR}/puppetriConfigVersion.cmake"
    COMPATIBILITY SameMinorVersion)
install(FILES "${CMAKE_CURRENT_BINARY_DIR}/puppetriConfig.cmake" "${CMAKE_CURRENT_BINARY_DIR}/puppetriConfigVersion.cmake"
    DESTINATION "${where}")
install(FILES LICENSE DESTINATION "${CMAKE_INSTALL_DOCDIR}")
