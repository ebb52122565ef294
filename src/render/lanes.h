// SPDX-License-Identifier: MIT
// Eight pixels side by side. Loops over lanes without branches become vector code; PUP_CLONES has a
// function compiled for newer processors too, chosen when the program starts.
#pragma once
#include <array>
#include <cstdint>

#include "float3.h"
#include "tracer.h"

namespace puppetri::render {

using Lanes8 = std::array<float, kPack>;

struct Colours8 {
    Lanes8 r, g, b;
    Float3 at(std::size_t i) const { return {r[i], g[i], b[i]}; }
};

}  // namespace puppetri::render

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__)
#define PUP_CLONES __attribute__((target_clones("avx2", "default")))
#else
#define PUP_CLONES
#endif
