# The oracle interpreter, the random nets and the counting allocator are compiled into this test program only.
target_sources(test_run PRIVATE
    "${CMAKE_CURRENT_SOURCE_DIR}/tests/support/oracle_net.cpp"
    "${CMAKE_CURRENT_SOURCE_DIR}/tests/support/random_net.cpp"
    "${CMAKE_CURRENT_SOURCE_DIR}/tests/support/count_allocations.cpp"
    "${CMAKE_CURRENT_SOURCE_DIR}/bench/models.cpp")
