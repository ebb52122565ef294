# What `puppetri export` refuses, and what it leaves behind: cmake -DPUPPETRI=... -DSCENE=... -DWORK=... -P export.cmake
function(expect code)
    execute_process(COMMAND "${PUPPETRI}" ${ARGN} RESULT_VARIABLE found OUTPUT_QUIET ERROR_VARIABLE text)
    if(NOT found EQUAL code)
        message(FATAL_ERROR "expected exit code ${code}, got ${found}: puppetri ${ARGN}\n${text}")
    endif()
endfunction()

file(REMOVE_RECURSE "${WORK}")
expect(2 export "${SCENE}" -o "${WORK}/a.fbx")
expect(2 export "${SCENE}" -o "${WORK}/a")
expect(2 export "${SCENE}" -o "${WORK}/a.glb" --frames 5-4)
expect(2 export "${SCENE}" -o "${WORK}/a.glb" --frames 0-999999)
expect(2 export "${SCENE}" -o "${WORK}/a.glb" --fps 10)
expect(2 export "${SCENE}" -o "${WORK}/a.glb" --names maya)
expect(2 export "${SCENE}" -o "${WORK}/a.bvh" --clips per-movement)
expect(2 export "${SCENE}.missing" -o "${WORK}/a.glb")
expect(2 export "${SCENE}")
if(EXISTS "${WORK}/a.glb" OR EXISTS "${WORK}/a.bvh")
    message(FATAL_ERROR "a refused export left a file")
endif()

# One command, all formats, folders made on the way.
expect(0 export "${SCENE}" -o "${WORK}/new/folder/take.glb" -o "${WORK}/new/folder/take.bvh")
file(GLOB files RELATIVE "${WORK}/new/folder" "${WORK}/new/folder/*" "${WORK}/new/folder/.*")
list(SORT files)
list(REMOVE_ITEM files . ..)
if(NOT files STREQUAL "take.events.json;take.glb;take_ana.bvh;take_rui.bvh")
    message(FATAL_ERROR "unexpected files: ${files}")
endif()

# The same scene gives the same bytes.
expect(0 export "${SCENE}" -o "${WORK}/again.glb")
execute_process(COMMAND "${CMAKE_COMMAND}" -E compare_files "${WORK}/again.glb" "${WORK}/new/folder/take.glb"
    RESULT_VARIABLE differ)
if(differ)
    message(FATAL_ERROR "two exports of one scene differ")
endif()

# A full disk: a limit of file size stands for it. The old file stays.
file(WRITE "${WORK}/small.glb" "old")
execute_process(COMMAND sh -c "ulimit -f 64; exec \"$0\" export \"$1\" -o \"$2\"" "${PUPPETRI}" "${SCENE}"
    "${WORK}/small.glb" RESULT_VARIABLE found ERROR_VARIABLE text OUTPUT_QUIET)
file(READ "${WORK}/small.glb" kept)
if(NOT found EQUAL 1 OR NOT kept STREQUAL "old" OR NOT text MATCHES "disk-full")
    message(FATAL_ERROR "a full disk: exit code ${found}, left \"${kept}\"\n${text}")
endif()
