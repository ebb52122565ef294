# Reading pictures back.
if(PNG_FOUND)
    target_link_libraries(test_render PRIVATE PNG::PNG)
    target_compile_definitions(test_render PRIVATE PUPPETRI_WITH_PNG=1)
endif()
