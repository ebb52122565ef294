# What an example says that `puppetri prove` and `explain` print: COMMAND SCENE [RULE], compared with EXPECTED. Times
# differ from run to run and are left out. With UPDATE the file is written instead.
execute_process(COMMAND "${PUPPETRI}" ${ARGUMENTS} -o "${WORK}" WORKING_DIRECTORY "${ROOT}" OUTPUT_VARIABLE printed
    ERROR_VARIABLE errors RESULT_VARIABLE code)
string(REGEX REPLACE "(PROVED|REFUTED|UNKNOWN|SAMPLED)([^\n]*[^ \n]) +[0-9.]+ m?s\n" "\\1\\2\n" printed "${printed}")
string(REGEX REPLACE "([0-9]+ states) +[0-9.]+ m?s\n" "\\1\n" printed "${printed}")  # of questions
string(REPLACE "${WORK}" "out" printed "${printed}")
if(NOT code EQUAL EXIT)
    message(FATAL_ERROR "exit code ${code} instead of ${EXIT}: ${printed}${errors}")
endif()
if(UPDATE)
    file(WRITE "${ROOT}/${EXPECTED}" "${printed}")
    return()
endif()
file(READ "${ROOT}/${EXPECTED}" expected)
if(NOT printed STREQUAL expected)
    message(FATAL_ERROR "puppetri ${ARGUMENTS} prints\n${printed}\nbut ${EXPECTED} says\n${expected}")
endif()
