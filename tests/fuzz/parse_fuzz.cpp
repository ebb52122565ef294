// SPDX-License-Identifier: MIT
// libFuzzer on the parser and the formatter. Build with clang: cmake -DPUPPETRI_FUZZ=ON
// -DCMAKE_CXX_COMPILER=clang++, then
//   build/fuzz_parse -dict=tests/fuzz/pup.dict -max_total_time=300 FOLDER tests/corpus
#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include "lang/survive.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string law =
        puppetri::lang::testing::broken_law({reinterpret_cast<const char*>(data), size});
    if (!law.empty()) {
        std::fprintf(stderr, "broken law: %s\n", law.c_str());
        std::abort();
    }
    return 0;
}
