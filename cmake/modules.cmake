# Makes one static library per row of layers.txt, linking exactly that row, and one test program per module.
# A module is its folder: src/<module>/*.cpp, headers in include/puppetri/<module>/, tests in tests/<module>/*_test.cpp.

function(puppetri_flags target)
    target_compile_features(${target} PUBLIC cxx_std_20)
    # Designated initializers leave members at their defaults on purpose.
    target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wshadow -Wno-missing-field-initializers
        -ffp-contract=off
        $<$<BOOL:${PUPPETRI_WERROR}>:-Werror>)
endfunction()

# Modules whose third-party parsers may throw; everything else is built without exceptions and RTTI.
set(PUPPETRI_MAY_THROW lang io render)

# What those who embed Puppetri ask for by name, each part of the next.
set(PUPPETRI_MODULES_net base math net run)
set(PUPPETRI_MODULES_stage ${PUPPETRI_MODULES_net} figure motion stage)

file(STRINGS "${CMAKE_CURRENT_SOURCE_DIR}/layers.txt" rows REGEX "^[a-z]+:")
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${CMAKE_CURRENT_SOURCE_DIR}/layers.txt")
set(PUPPETRI_MODULES "")
foreach(row IN LISTS rows)
    string(REGEX MATCH "^[a-z]+" module "${row}")
    if(NOT PUPPETRI_COMPONENT STREQUAL full AND NOT module IN_LIST PUPPETRI_MODULES_${PUPPETRI_COMPONENT})
        continue()
    endif()
    string(REGEX REPLACE "^[a-z]+: *" "" deps "${row}")
    string(REPLACE " " ";" deps "${deps}")
    list(APPEND PUPPETRI_MODULES ${module})
    file(GLOB sources CONFIGURE_DEPENDS "${CMAKE_CURRENT_SOURCE_DIR}/src/${module}/*.cpp")
    if(sources)
        add_library(puppetri_${module} STATIC ${sources})
        set(scope PUBLIC)
        puppetri_flags(puppetri_${module})
        if(NOT module IN_LIST PUPPETRI_MAY_THROW)
            target_compile_options(puppetri_${module} PRIVATE -fno-exceptions -fno-rtti)
        endif()
    else()
        add_library(puppetri_${module} INTERFACE)
        set(scope INTERFACE)
    endif()
    target_include_directories(puppetri_${module} ${scope}
        $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/include> $<INSTALL_INTERFACE:include>)
    foreach(dep IN LISTS deps)
        target_link_libraries(puppetri_${module} ${scope} puppetri_${dep})
    endforeach()
    if(EXISTS "${CMAKE_CURRENT_SOURCE_DIR}/src/${module}/module.cmake")
        include("${CMAKE_CURRENT_SOURCE_DIR}/src/${module}/module.cmake") # third-party libraries of this module
    endif()
endforeach()

# doctest's own code is the slowest file of all tests: compiled once for all test programs.
function(puppetri_test_main)
    add_library(puppetri_test_main STATIC "${CMAKE_CURRENT_SOURCE_DIR}/tests/main.cpp")
    puppetri_flags(puppetri_test_main)
endfunction()

function(puppetri_tests module)
    file(GLOB sources CONFIGURE_DEPENDS "${CMAKE_CURRENT_SOURCE_DIR}/tests/${module}/*_test.cpp")
    if(NOT sources)
        return()
    endif()
    add_executable(test_${module} ${sources})
    target_link_libraries(test_${module} PRIVATE puppetri_test_main puppetri_${module})
    target_include_directories(test_${module} PRIVATE "${CMAKE_CURRENT_SOURCE_DIR}/tests")
    puppetri_flags(test_${module})
    target_compile_definitions(test_${module} PRIVATE PUP_SOURCE_DIR="${CMAKE_CURRENT_SOURCE_DIR}")
    add_test(NAME ${module} COMMAND test_${module} WORKING_DIRECTORY "${CMAKE_CURRENT_BINARY_DIR}")
    if(EXISTS "${CMAKE_CURRENT_SOURCE_DIR}/tests/${module}/module.cmake")
        include("${CMAKE_CURRENT_SOURCE_DIR}/tests/${module}/module.cmake") # more tests or libraries of this module
    endif()
endfunction()
