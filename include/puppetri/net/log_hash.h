// SPDX-License-Identifier: MIT
// The hash of a firing log: over the tick and the path of every firing, in order. Whoever fires the
// same transitions at the same ticks has the same hash, whatever program did it: players, replays,
// and the hand-written loops of the benchmarks.
#pragma once
#include <bit>
#include <cstdint>

#include "puppetri/base/hash.h"

namespace puppetri::net {

// The hash after one more firing; it starts at 0. path_hash is hash_text of the transition's full
// path.
constexpr std::uint64_t log_hash_step(std::uint64_t hash, std::int64_t at_ticks,
                                      std::uint64_t path_hash) {
    constexpr std::uint64_t kA = 0x9E3779B185EBCA87u;
    constexpr std::uint64_t kB = 0xC2B2AE3D27D4EB4Fu;
    hash ^= static_cast<std::uint64_t>(at_ticks) * kB;
    return (std::rotl(hash * kA, 29) ^ path_hash) * kB;
}

// What is shown of it.
constexpr std::uint64_t log_hash_value(std::uint64_t hash, std::uint64_t firings) {
    return mix64(hash ^ firings);
}

}  // namespace puppetri::net
