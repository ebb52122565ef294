# The fuzzer of the parser, by option and with clang only; its test is a short run.
option(PUPPETRI_FUZZ "build the libFuzzer target (clang)" OFF)
if(PUPPETRI_FUZZ)
    if(NOT CMAKE_CXX_COMPILER_ID MATCHES "Clang")
        message(FATAL_ERROR "PUPPETRI_FUZZ needs clang: -DCMAKE_CXX_COMPILER=clang++")
    endif()
    file(GLOB fuzz_sources CONFIGURE_DEPENDS "${CMAKE_CURRENT_SOURCE_DIR}/src/lang/*.cpp"
        "${CMAKE_CURRENT_SOURCE_DIR}/src/base/*.cpp")
    add_executable(fuzz_parse tests/fuzz/parse_fuzz.cpp ${fuzz_sources})
    target_include_directories(fuzz_parse PRIVATE include tests)
    target_include_directories(fuzz_parse SYSTEM PRIVATE "${PEGTL_INCLUDE_DIR}")
    target_compile_options(fuzz_parse PRIVATE -g -O1 -fsanitize=fuzzer,address,undefined -fno-sanitize-recover=undefined)
    target_link_options(fuzz_parse PRIVATE -fsanitize=fuzzer,address,undefined)
    add_test(NAME fuzz_parse COMMAND fuzz_parse -runs=2000 -seed=1 -max_len=600 -timeout=10
        "-dict=${CMAKE_CURRENT_SOURCE_DIR}/tests/fuzz/pup.dict" "${CMAKE_CURRENT_SOURCE_DIR}/tests/corpus")
endif()
