// SPDX-License-Identifier: MIT
// Hash64: the fingerprint of logs and states. It eats 64-bit words, so its value depends on neither
// byte order nor compiler; texts are eaten as their length and then their bytes, so that neighbours
// cannot run together. It detects accidents and names streams; it is not made against attackers.
#pragma once
#include <bit>
#include <cstdint>
#include <string_view>

#include "puppetri/base/bit_cast.h"

namespace puppetri {

// A bijection of 64-bit words in which each input bit flips each output bit with probability about
// 1/2. Source  D. Stafford, "Better bit mixing" (2011), variant 13; the finalizer of SplitMix64
// (Steele, Lea, Flood 2014).
constexpr std::uint64_t mix64(std::uint64_t x) {
    x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9u;
    x = (x ^ (x >> 27)) * 0x94D049BB133111EBu;
    return x ^ (x >> 31);
}

// Cost    two multiplications per word.
// Source  the eight-byte step of XXH64 (Y. Collet, xxHash specification 0.1.1, "Consume remaining
// input"), closed by
//         mix64 of the state and the number of words.
class Hash64 {
 public:
    constexpr Hash64() = default;
    constexpr explicit Hash64(std::uint64_t seed) : state_(seed + kPrime5) {}

    constexpr Hash64& add_u64(std::uint64_t word) {
        state_ ^= std::rotl(word * kPrime2, 31) * kPrime1;
        state_ = std::rotl(state_, 27) * kPrime1 + kPrime4;
        ++words_;
        return *this;
    }
    constexpr Hash64& add_i64(std::int64_t word) {
        return add_u64(static_cast<std::uint64_t>(word));
    }
    // The bits of the number; -0 counts as 0 and every NaN as one, because they compare and print
    // alike.
    constexpr Hash64& add_f64(double x) {
        if (x == 0) {
            x = 0;
        }
        return add_u64(x != x ? 0x7FF8000000000000u : puppetri::bit_cast<std::uint64_t>(x));
    }
    constexpr Hash64& add_text(std::string_view text) {
        add_u64(text.size());
        std::uint64_t word = 0;
        unsigned filled = 0;
        for (const char c : text) {
            word |= std::uint64_t{static_cast<unsigned char>(c)} << (8 * filled);
            if (++filled == 8) {
                add_u64(word);
                word = 0;
                filled = 0;
            }
        }
        return filled != 0 ? add_u64(word) : *this;
    }

    // May be asked at any time; more can be added afterwards.
    constexpr std::uint64_t value() const { return mix64(state_ ^ (words_ * kPrime3)); }

 private:
    static constexpr std::uint64_t kPrime1 = 0x9E3779B185EBCA87u;
    static constexpr std::uint64_t kPrime2 = 0xC2B2AE3D27D4EB4Fu;
    static constexpr std::uint64_t kPrime3 = 0x165667B19E3779F9u;
    static constexpr std::uint64_t kPrime4 = 0x85EBCA77C2B2AE63u;
    static constexpr std::uint64_t kPrime5 = 0x27D4EB2F165667C5u;

    std::uint64_t state_ = kPrime5;
    std::uint64_t words_ = 0;
};

constexpr std::uint64_t hash_text(std::string_view text) { return Hash64().add_text(text).value(); }

}  // namespace puppetri
