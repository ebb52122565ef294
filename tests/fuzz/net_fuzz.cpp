// SPDX-License-Identifier: MIT
// libFuzzer on the readers of nets and queries, one target each: fuzz_pnml, fuzz_pipe, fuzz_tina,
// fuzz_queries. Build with clang: cmake -DPUPPETRI_FUZZ=ON -DCMAKE_CXX_COMPILER=clang++, then
//   build/fuzz_pnml -max_total_time=600 FOLDER tests/corpus/nets
#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include "io/survive_nets.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string law = puppetri::io::testing::broken_file_law(
        PUP_FUZZED, {reinterpret_cast<const char*>(data), size});
    if (!law.empty()) {
        std::fprintf(stderr, "broken law: %s\n", law.c_str());
        std::abort();
    }
    return 0;
}
