# Replications on all cores.
find_package(Threads REQUIRED)
target_link_libraries(puppetri_sim PRIVATE Threads::Threads)
