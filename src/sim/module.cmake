# Replications on all cores.
find_package(Threads REQUIRED)
target_link_libraries(puppetri_sim PRIVATE Threads::Threads)
# Traffic equations of queueing networks.
find_package(Eigen3 REQUIRED NO_MODULE)
target_link_libraries(puppetri_sim PRIVATE Eigen3::Eigen)
