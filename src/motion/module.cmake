# The loops over packed poses and over limbs once more for processors with AVX2: chosen at run time, the same bits.
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64" AND CMAKE_CXX_COMPILER_ID MATCHES "GNU|Clang" AND NOT EMSCRIPTEN)
    set_source_files_properties("${CMAKE_CURRENT_SOURCE_DIR}/src/motion/packed_kernels_avx2.cpp"
        "${CMAKE_CURRENT_SOURCE_DIR}/src/motion/limb_batch_avx2.cpp" PROPERTIES COMPILE_OPTIONS "-mavx2")
    target_compile_definitions(puppetri_motion PRIVATE PUPPETRI_MOTION_AVX2=1)
endif()
