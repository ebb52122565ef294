# Replications on all cores.
find_package(Threads REQUIRED)
target_link_libraries(puppetri_sim PRIVATE Threads::Threads)
# Quantiles of Student's distribution; headers only.
find_package(Boost 1.81 REQUIRED)
target_link_libraries(puppetri_sim PRIVATE $<BUILD_INTERFACE:Boost::headers>)
# Traffic equations of queueing networks.
find_package(Eigen3 REQUIRED NO_MODULE)
target_link_libraries(puppetri_sim PRIVATE $<BUILD_INTERFACE:Eigen3::Eigen>)
