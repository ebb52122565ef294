# What a notation means is told by what its net does: scenes are loaded and played, solved and measured; how many states
# they have, by graphs.
target_link_libraries(test_notation PRIVATE puppetri_scene puppetri_sim puppetri_proof)
