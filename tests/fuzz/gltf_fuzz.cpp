// SPDX-License-Identifier: MIT
// libFuzzer on the reader of figures: fuzz_figures. Build with clang: cmake -DPUPPETRI_FUZZ=ON
// -DCMAKE_CXX_COMPILER=clang++, then build/fuzz_figures -max_total_time=600 FOLDER ../shared/motion
#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include "io/survive_gltf.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string law = puppetri::io::testing::broken_gltf_law(
        std::string(reinterpret_cast<const char*>(data), size));
    if (!law.empty()) {
        std::fprintf(stderr, "broken law: %s\n", law.c_str());
        std::abort();
    }
    return 0;
}
