# Runs an example and compares what it prints with expected.txt beside it:
# cmake -DPUPPETRI=... -DSCENE=examples/NN_name/NAME.pup -DROOT=... -P expected.cmake
execute_process(COMMAND "${PUPPETRI}" run "${SCENE}" WORKING_DIRECTORY "${ROOT}" RESULT_VARIABLE code
    OUTPUT_VARIABLE printed ERROR_VARIABLE said)
get_filename_component(folder "${ROOT}/${SCENE}" DIRECTORY)
file(READ "${folder}/expected.txt" expected)
if(NOT code EQUAL 0 OR NOT "${printed}${said}" STREQUAL expected)
    message(FATAL_ERROR "exit code ${code}; expected\n${expected}\nprinted\n${printed}${said}")
endif()
