# Random nets are compiled into this test program only.
target_sources(test_proof PRIVATE "${CMAKE_CURRENT_SOURCE_DIR}/tests/support/random_net.cpp")
# Long runs of the player, as an estimate beside what is computed.
target_link_libraries(test_proof PRIVATE puppetri_run)
