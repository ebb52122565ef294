// SPDX-License-Identifier: MIT
// 128-bit integers for what two 64-bit numbers give when multiplied and added once.
#pragma once
#include <cstdint>
#include <limits>
#include <numeric>

namespace puppetri::proof {

__extension__ using Wide = __int128;

// Gives  false if the value does not fit (the lowest 64-bit number counts as not fitting, so that
// negation is always safe).
inline bool fits(Wide value, std::int64_t& out) {
    if (value > std::numeric_limits<std::int64_t>::max() ||
        value < -Wide{std::numeric_limits<std::int64_t>::max()}) {
        return false;
    }
    out = static_cast<std::int64_t>(value);
    return true;
}

// The greatest common divisor, not negative.
inline Wide common_divisor(Wide a, Wide b) {
    a = a < 0 ? -a : a;
    b = b < 0 ? -b : b;
    while (b != 0) {
        if (a <= std::numeric_limits<std::int64_t>::max() &&
            b <= std::numeric_limits<std::int64_t>::max()) {
            return std::gcd(static_cast<std::int64_t>(a), static_cast<std::int64_t>(b));
        }
        const Wide rest = a % b;
        a = b;
        b = rest;
    }
    return a;
}

}  // namespace puppetri::proof
