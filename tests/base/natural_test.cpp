// SPDX-License-Identifier: MIT
// Natural numbers of any size against long arithmetic done elsewhere, and against 64 bits.
#include "puppetri/base/natural.h"

#include <doctest/doctest.h>

#include "puppetri/base/random.h"

namespace puppetri {
namespace {

Natural power(std::uint32_t base, std::uint32_t exponent) {
    Natural result = 1;
    for (; exponent > 0; --exponent) {
        result *= base;
    }
    return result;
}

TEST_CASE("natural numbers add, multiply, compare and print like long arithmetic [oracle]") {
    CHECK(Natural(0).decimal() == "0");
    CHECK(Natural(1'000'000'000).decimal() == "1000000000");
    CHECK(Natural(~std::uint64_t{0}).decimal() == "18446744073709551615");
    CHECK(power(10, 40).decimal() == "1" + std::string(40, '0'));
    CHECK(power(3, 100).decimal() == "515377520732011331036461129765621272702107522001");
    Natural doubled = power(2, 64);
    CHECK(doubled.decimal() == "18446744073709551616");
    CHECK_FALSE(doubled.small().has_value());
    doubled += doubled;
    CHECK(doubled == power(2, 65));
    CHECK(power(2, 63).small() == std::uint64_t{1} << 63);
    CHECK(power(7, 30) < power(7, 31));
    CHECK(power(7, 31) > power(2, 80));
    CHECK(power(2, 90).approximate() == 1237940039285380274899124224.0);
    Natural none = power(5, 50);
    none *= 0;
    CHECK(none.zero());
}

TEST_CASE("shifts, powers of ten, quotients and differences agree with products and sums") {
    Natural shifted = 5;
    shifted <<= 77;
    CHECK(shifted == power(2, 77) + power(2, 79));
    CHECK(shifted.bit_count() == 80);
    CHECK(Natural(0).bit_count() == 0);
    CHECK(Natural(1).bit_count() == 1);
    Natural tens = 7;
    tens.multiply_power_of_ten(29);
    CHECK(tens.decimal() == "7" + std::string(29, '0'));
    CHECK_FALSE(tens.odd());
    Natural rest = power(3, 100);
    CHECK(rest.odd());
    for (int i = 0; i < 60; ++i) {
        CHECK(rest.divide(3) == 0);
    }
    CHECK(rest == power(3, 40));
    CHECK(rest.divide(1'000'000'007) == 12157665459056928801ull % 1'000'000'007);
    Natural difference = power(10, 40);
    difference -= power(10, 39);
    CHECK(difference.decimal() == "9" + std::string(39, '0'));
    difference -= difference;
    CHECK(difference.zero());
}

}  // namespace
}  // namespace puppetri
