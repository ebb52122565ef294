// SPDX-License-Identifier: MIT
// Whole numbers as bytes, small ones short: seven bits a byte, least significant first, the eighth
// tells that more follow; of signed numbers the sign first, so that -1 is short as well. Source
// Protocol Buffers' encoding (LEB128, zigzag).
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace puppetri {

inline void put_varint(std::vector<std::uint8_t>& out, std::uint64_t x) {
    for (; x >= 0x80; x >>= 7) {
        out.push_back(static_cast<std::uint8_t>(x | 0x80));
    }
    out.push_back(static_cast<std::uint8_t>(x));
}

// Moves `at` behind the number. For bytes that put_varint wrote: nothing is checked.
inline std::uint64_t get_varint(std::span<const std::uint8_t> bytes, std::size_t& at) {
    std::uint64_t x = 0;
    for (int shift = 0;; shift += 7) {
        const std::uint8_t b = bytes[at++];
        x |= std::uint64_t{b & 0x7Fu} << shift;
        if (b < 0x80) {
            return x;
        }
    }
}

constexpr std::uint64_t zigzag(std::int64_t x) {
    return (static_cast<std::uint64_t>(x) << 1) ^ static_cast<std::uint64_t>(x >> 63);
}
constexpr std::int64_t unzigzag(std::uint64_t x) {
    return static_cast<std::int64_t>((x >> 1) ^ (0 - (x & 1)));
}

}  // namespace puppetri
