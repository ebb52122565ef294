# Toolchain for the preset `wasm`: Debian's emscripten 3.1.6. Its node modules lie where node does not look.
set(ENV{NODE_PATH} "/usr/share/nodejs")
set(EMSCRIPTEN_ROOT_PATH "/usr/share/emscripten" CACHE PATH "where emscripten lies")
include("${EMSCRIPTEN_ROOT_PATH}/cmake/Modules/Platform/Emscripten.cmake")
