# What a notation means is told by what its net does: scenes are loaded and played.
target_link_libraries(test_notation PRIVATE puppetri_scene)
