# Random nets are compiled into this test program only.
target_sources(test_verdict PRIVATE "${CMAKE_CURRENT_SOURCE_DIR}/tests/support/random_net.cpp")
