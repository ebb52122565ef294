// SPDX-License-Identifier: MIT
// Random numbers by counting: the k-th value of a stream is a function of the stream's key and k,
// nothing else. Each element of a model owns streams of its own, keyed by seed, path and purpose,
// so that adding a queue changes nobody else's customers, and a snapshot needs only the count.
#pragma once
#include <bit>
#include <cstdint>
#include <string_view>

#include "puppetri/base/hash.h"

namespace puppetri {

// The k-th value of the stream with this key; all 64 bits are usable.
// Source  SplitMix64 (Steele, Lea, Flood, "Fast splittable pseudorandom number generators", OOPSLA
// 2014, figure 16) as
//         a function of its counter. Changed: the key enters once more between the two
//         multiplications; without that, all streams would be stretches of one sequence, and two
//         keys that differ by a multiple of the step would repeat each other.
constexpr std::uint64_t random_bits(std::uint64_t key, std::uint64_t k) {
    std::uint64_t x = key + (k + 1) * 0x9E3779B97F4A7C15u;
    x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9u;
    x ^= std::rotl(key, 32);
    x = (x ^ (x >> 27)) * 0x94D049BB133111EBu;
    return x ^ (x >> 31);
}

// The 52 upper bits as a number strictly between 0 and 1: (n + 1/2) / 2^52, symmetric about 1/2, so
// that the logarithms of u and of 1 - u are finite.
constexpr double uniform_from_bits(std::uint64_t bits) {
    return (static_cast<double>(bits >> 12) + 0.5) * 0x1p-52;
}

// The key of the stream that the element with this full path uses for this purpose ("ticket",
// "duration", "delay").
constexpr std::uint64_t stream_key(std::uint64_t seed, std::string_view element_path,
                                   std::string_view purpose) {
    return Hash64(seed).add_text(element_path).add_text(purpose).value();
}

// A stream: a key and the number of draws so far. A value; copying it forks the future.
struct RandomStream {
    std::uint64_t key = 0;
    std::uint64_t count = 0;
    // All bits set: the antithetic stream, whose uniform() is 1 - u where the other's is u.
    std::uint64_t flip = 0;

    constexpr std::uint64_t bits() { return random_bits(key, count++) ^ flip; }
    // In (0, 1), never 0 or 1. One draw.
    constexpr double uniform() { return uniform_from_bits(bits()); }
    // In [0, n), each equally likely, without bias. Needs n >= 1. One draw, rarely more.
    std::uint64_t below(std::uint64_t n);
    // In [low, high], both included, each equally likely. Needs low <= high.
    std::int64_t between(std::int64_t low, std::int64_t high);

    bool operator==(const RandomStream&) const = default;
};

}  // namespace puppetri
