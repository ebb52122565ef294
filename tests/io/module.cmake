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
target_sources(test_io PRIVATE "${CMAKE_CURRENT_SOURCE_DIR}/tests/support/measure.cpp"
    "${CMAKE_CURRENT_SOURCE_DIR}/tests/support/example_motion.cpp")
