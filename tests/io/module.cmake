# The readers that check what the writers wrote: others' code and Eigen, none of ours.
find_package(TinyGLTF REQUIRED)
find_package(Eigen3 REQUIRED)
add_library(puppetri_test_readers STATIC
    "${CMAKE_CURRENT_SOURCE_DIR}/tests/support/bvh_reader.cpp"
    "${CMAKE_CURRENT_SOURCE_DIR}/tests/support/gltf_reader.cpp")
target_include_directories(puppetri_test_readers PUBLIC "${CMAKE_CURRENT_SOURCE_DIR}/tests")
target_link_libraries(puppetri_test_readers PUBLIC Eigen3::Eigen PRIVATE TinyGLTF::TinyGLTF)
target_compile_features(puppetri_test_readers PUBLIC cxx_std_20)
target_link_libraries(test_io PRIVATE puppetri_test_readers)

# Other people's programs read what the writers wrote: the Khronos validator and three.js, from npm, under node.
add_executable(write_samples "${CMAKE_CURRENT_SOURCE_DIR}/tests/io/write_samples.cpp")
target_link_libraries(write_samples PRIVATE puppetri_io)
target_include_directories(write_samples PRIVATE "${CMAKE_CURRENT_SOURCE_DIR}/tests")
puppetri_flags(write_samples)
set(js "${CMAKE_CURRENT_BINARY_DIR}/js")
file(MAKE_DIRECTORY "${js}/samples")
add_test(NAME js_packages COMMAND "${CMAKE_CURRENT_SOURCE_DIR}/tests/js/install.sh" "${js}")
add_test(NAME js_samples COMMAND write_samples "${js}/samples")
set_tests_properties(js_packages js_samples PROPERTIES FIXTURES_SETUP js SKIP_RETURN_CODE 77)
find_program(NODE NAMES node nodejs)
if(NODE)
    foreach(reader validate load)
        add_test(NAME gltf_${reader} COMMAND "${NODE}" "${js}/${reader}.mjs" "${js}/samples")
        set_tests_properties(gltf_${reader} PROPERTIES FIXTURES_REQUIRED js SKIP_RETURN_CODE 77)
    endforeach()
endif()
