# The readers that check what the writers wrote: others' code and Eigen, none of ours.
find_package(TinyGLTF REQUIRED)
find_package(Eigen3 REQUIRED)
add_library(puppetri_test_readers STATIC
    "${CMAKE_CURRENT_SOURCE_DIR}/tests/support/bvh_reader.cpp"
    "${CMAKE_CURRENT_SOURCE_DIR}/tests/support/gltf_reader.cpp")
target_include_directories(puppetri_test_readers PUBLIC "${CMAKE_CURRENT_SOURCE_DIR}/tests")
target_link_libraries(puppetri_test_readers PUBLIC Eigen3::Eigen PRIVATE TinyGLTF::TinyGLTF)
target_compile_features(puppetri_test_readers PUBLIC cxx_std_20)
target_link_libraries(test_io PRIVATE puppetri_test_readers)
target_sources(test_io PRIVATE "${CMAKE_CURRENT_SOURCE_DIR}/tests/support/measure.cpp"
    "${CMAKE_CURRENT_SOURCE_DIR}/tests/support/example_motion.cpp"
    "${CMAKE_CURRENT_SOURCE_DIR}/tests/support/motion_table.cpp")

# Readers and writers of nets with what they need and nothing else: quick to build with sanitizers.
file(GLOB net_format_sources CONFIGURE_DEPENDS "${CMAKE_CURRENT_SOURCE_DIR}/src/base/*.cpp"
    "${CMAKE_CURRENT_SOURCE_DIR}/src/net/*.cpp" "${CMAKE_CURRENT_SOURCE_DIR}/src/lang/*.cpp")
foreach(unit net_file xml_text pnml_document pnml pipe tina tina_lexer tina_priorities test_arcs symmetric_sorts
        symmetric_terms symmetric_unfold contest_queries net_features loops write_net xml_escaped pnml_writer pipe_writer tina_writer
        lola_writer graphviz_writer scene_writer)
    list(APPEND net_format_sources "${CMAKE_CURRENT_SOURCE_DIR}/src/io/${unit}.cpp")
endforeach()

# Readers of motion with what they need and nothing else.
file(GLOB motion_format_sources CONFIGURE_DEPENDS "${CMAKE_CURRENT_SOURCE_DIR}/src/base/*.cpp"
    "${CMAKE_CURRENT_SOURCE_DIR}/src/math/*.cpp")
foreach(unit figure/skeleton figure/dof motion/clip motion/clip_root io/bvh_reader io/keys_reader io/keys_writer
        io/gltf_document io/gltf_reader io/gltf_reader_scene io/gltf_container io/gltf_clips io/clip_tidy io/rest_pose
        scene/file_source)
    list(APPEND motion_format_sources "${CMAKE_CURRENT_SOURCE_DIR}/src/${unit}.cpp")
endforeach()

# The reader of figures likewise.
file(GLOB figure_format_sources CONFIGURE_DEPENDS "${CMAKE_CURRENT_SOURCE_DIR}/src/base/*.cpp"
    "${CMAKE_CURRENT_SOURCE_DIR}/src/math/*.cpp" "${CMAKE_CURRENT_SOURCE_DIR}/src/figure/*.cpp")
foreach(unit io/gltf_container io/gltf_document io/gltf_reader io/gltf_reader_scene io/character_reader
        io/character_mesh io/character_bones io/bone_names scene/file_source)
    list(APPEND figure_format_sources "${CMAKE_CURRENT_SOURCE_DIR}/src/${unit}.cpp")
endforeach()

# The hostile tests alone, for `.ci/run`: everything under the sanitizers would take long to build.
if(PUPPETRI_SANITIZE)
    add_executable(test_hostile_nets tests/io/net_hostile_test.cpp ${net_format_sources})
    target_include_directories(test_hostile_nets PRIVATE include tests)
    target_include_directories(test_hostile_nets SYSTEM PRIVATE "${PEGTL_INCLUDE_DIR}")
    target_link_libraries(test_hostile_nets PRIVATE puppetri_test_main pugixml::pugixml)
    puppetri_flags(test_hostile_nets)
    target_compile_definitions(test_hostile_nets PRIVATE PUP_SOURCE_DIR="${CMAKE_CURRENT_SOURCE_DIR}")
    add_test(NAME hostile_nets COMMAND test_hostile_nets)

    add_executable(test_hostile_motion tests/io/motion_hostile_test.cpp ${motion_format_sources})
    target_include_directories(test_hostile_motion PRIVATE include tests)
    target_link_libraries(test_hostile_motion PRIVATE puppetri_test_main nlohmann_json::nlohmann_json)
    puppetri_flags(test_hostile_motion)
    target_compile_definitions(test_hostile_motion PRIVATE PUP_SOURCE_DIR="${CMAKE_CURRENT_SOURCE_DIR}")
    add_test(NAME hostile_motion COMMAND test_hostile_motion)

    add_executable(test_hostile_figures tests/io/gltf_hostile_test.cpp ${figure_format_sources})
    target_include_directories(test_hostile_figures PRIVATE include tests)
    target_link_libraries(test_hostile_figures PRIVATE puppetri_test_main nlohmann_json::nlohmann_json)
    puppetri_flags(test_hostile_figures)
    target_compile_definitions(test_hostile_figures PRIVATE PUP_SOURCE_DIR="${CMAKE_CURRENT_SOURCE_DIR}")
    add_test(NAME hostile_figures COMMAND test_hostile_figures)
endif()

# The fuzzers, by the option of tests/lang/module.cmake; their tests are short runs.
if(PUPPETRI_FUZZ)
    add_library(fuzzed_nets OBJECT ${net_format_sources})
    target_include_directories(fuzzed_nets PRIVATE include)
    target_include_directories(fuzzed_nets SYSTEM PRIVATE "${PEGTL_INCLUDE_DIR}")
    target_link_libraries(fuzzed_nets PUBLIC pugixml::pugixml)
    target_compile_options(fuzzed_nets PRIVATE -g -O1 -ffp-contract=off -fsanitize=fuzzer-no-link,address,undefined
        -fno-sanitize-recover=undefined)
    foreach(target pnml:coloured.pnml pipe:coloured.xml tina:timed.net queries:queries.xml)
        string(REPLACE ":" ";" target "${target}")
        list(GET target 0 name)
        list(GET target 1 file)
        add_executable(fuzz_${name} tests/fuzz/net_fuzz.cpp)
        target_include_directories(fuzz_${name} PRIVATE include tests)
        target_compile_definitions(fuzz_${name} PRIVATE PUP_FUZZED="${file}"
            PUP_SOURCE_DIR="${CMAKE_CURRENT_SOURCE_DIR}")
        target_compile_options(fuzz_${name} PRIVATE -g -O1 -fsanitize=fuzzer,address,undefined
            -fno-sanitize-recover=undefined)
        target_link_options(fuzz_${name} PRIVATE -fsanitize=fuzzer,address,undefined)
        target_link_libraries(fuzz_${name} PRIVATE fuzzed_nets)
        add_test(NAME fuzz_${name} COMMAND fuzz_${name} -runs=2000 -seed=1 -max_len=4000 -timeout=10
            "-dict=${CMAKE_CURRENT_SOURCE_DIR}/tests/fuzz/net.dict" "${CMAKE_CURRENT_SOURCE_DIR}/tests/corpus/nets")
    endforeach()

    add_library(fuzzed_motion OBJECT ${motion_format_sources})
    target_include_directories(fuzzed_motion PRIVATE include)
    target_link_libraries(fuzzed_motion PUBLIC nlohmann_json::nlohmann_json)
    target_compile_options(fuzzed_motion PRIVATE -g -O1 -ffp-contract=off -fsanitize=fuzzer-no-link,address,undefined
        -fno-sanitize-recover=undefined)
    foreach(target keys bvh glb gltf)
        add_executable(fuzz_${target} tests/fuzz/motion_fuzz.cpp)
        target_include_directories(fuzz_${target} PRIVATE include tests)
        target_compile_definitions(fuzz_${target} PRIVATE PUP_FUZZED="fuzzed.${target}"
            PUP_SOURCE_DIR="${CMAKE_CURRENT_SOURCE_DIR}")
        target_compile_options(fuzz_${target} PRIVATE -g -O1 -fsanitize=fuzzer,address,undefined
            -fno-sanitize-recover=undefined)
        target_link_options(fuzz_${target} PRIVATE -fsanitize=fuzzer,address,undefined)
        target_link_libraries(fuzz_${target} PRIVATE fuzzed_motion)
        add_test(NAME fuzz_${target} COMMAND fuzz_${target} -runs=2000 -seed=1 -max_len=4000 -timeout=10
            "-dict=${CMAKE_CURRENT_SOURCE_DIR}/tests/fuzz/motion.dict"
            "${CMAKE_CURRENT_SOURCE_DIR}/tests/corpus/motion")
    endforeach()

    add_executable(fuzz_figures tests/fuzz/gltf_fuzz.cpp ${figure_format_sources})
    target_include_directories(fuzz_figures PRIVATE include tests)
    target_compile_options(fuzz_figures PRIVATE -g -O1 -ffp-contract=off -fsanitize=fuzzer,address,undefined
        -fno-sanitize-recover=undefined)
    target_link_options(fuzz_figures PRIVATE -fsanitize=fuzzer,address,undefined)
    target_link_libraries(fuzz_figures PRIVATE nlohmann_json::nlohmann_json)
    add_test(NAME fuzz_figures COMMAND fuzz_figures -runs=2000 -seed=1 -max_len=4000 -timeout=10
        "-dict=${CMAKE_CURRENT_SOURCE_DIR}/tests/fuzz/gltf.dict")
endif()
