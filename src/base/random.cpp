// SPDX-License-Identifier: MIT
// Unbiased integers from a stream.
#include "puppetri/base/random.h"

#include "puppetri/base/require.h"

namespace puppetri {
namespace {

struct Product128 {
    std::uint64_t high;
    std::uint64_t low;
};

// The whole product, by halves, so that 32-bit targets need no 128-bit type.
Product128 multiply(std::uint64_t a, std::uint64_t b) {
    const std::uint64_t a_low = a & 0xFFFFFFFFu;
    const std::uint64_t a_high = a >> 32;
    const std::uint64_t b_low = b & 0xFFFFFFFFu;
    const std::uint64_t b_high = b >> 32;
    const std::uint64_t low = a_low * b_low;
    const std::uint64_t middle = a_high * b_low + (low >> 32);
    const std::uint64_t other = a_low * b_high + (middle & 0xFFFFFFFFu);
    return {.high = a_high * b_high + (middle >> 32) + (other >> 32),
            .low = (other << 32) | (low & 0xFFFFFFFFu)};
}

}  // namespace

// Source  D. Lemire, "Fast random integer generation in an interval", ACM TOMACS 29 (2019),
// algorithm 5.
std::uint64_t RandomStream::below(std::uint64_t n) {
    PUP_REQUIRE(n >= 1);
    Product128 product = multiply(bits(), n);
    if (product.low < n) {
        const std::uint64_t threshold = (0 - n) % n;
        while (product.low < threshold) {
            product = multiply(bits(), n);
        }
    }
    return product.high;
}

std::int64_t RandomStream::between(std::int64_t low, std::int64_t high) {
    PUP_REQUIRE(low <= high);
    const std::uint64_t width =
        static_cast<std::uint64_t>(high) - static_cast<std::uint64_t>(low) + 1;
    const std::uint64_t offset = width == 0 ? bits() : below(width);  // 0: all 2^64 values
    return static_cast<std::int64_t>(static_cast<std::uint64_t>(low) + offset);
}

}  // namespace puppetri
