# The measuring instrument, shared with other modules' tests.
target_sources(test_scene PRIVATE "${CMAKE_CURRENT_SOURCE_DIR}/tests/support/measure.cpp"
    "${CMAKE_CURRENT_SOURCE_DIR}/tests/support/count_allocations.cpp")
# Measures of equations are read by the meter.
target_link_libraries(test_scene PRIVATE puppetri_sim)
