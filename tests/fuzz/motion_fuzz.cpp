// SPDX-License-Identifier: MIT
// Fuzzes one reader of motion, chosen by PUP_FUZZED: the laws of io/survive_motion.h.
#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include "io/survive_motion.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string law = puppetri::io::testing::broken_motion_law(
        PUP_FUZZED, {reinterpret_cast<const char*>(data), size});
    if (!law.empty()) {
        std::fprintf(stderr, "broken: %s\n", law.c_str());
        std::abort();
    }
    return 0;
}
