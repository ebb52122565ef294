// SPDX-License-Identifier: MIT
// Decimals, exactly, and the texts that are none.
#include "puppetri/lang/decimal.h"

#include <doctest/doctest.h>

namespace puppetri::lang {
namespace {

TEST_CASE("decimals are read exactly, with a point and an exponent") {
    CHECK(parse_decimal("12") == Rational{12});
    CHECK(parse_decimal("0.5") == make_rational(1, 2));
    CHECK(parse_decimal(".25") == make_rational(1, 4));
    CHECK(parse_decimal("3.") == Rational{3});
    CHECK(parse_decimal("2.5e-3") == make_rational(1, 400));
    CHECK(parse_decimal("1E+6") == Rational{1'000'000});
    CHECK(parse_decimal("0e99") == Rational{0});
    CHECK(parse_decimal("123456789012345678") == Rational{123456789012345678});
}

TEST_CASE("what is no decimal, or too long to be kept exactly, is refused") {
    for (const char* text : {"", ".", "-1", "+1", "1.2.3", "1e", "1e+", "e3", "1e2.5", "0x10", "1 ",
                             " 1", "nan", "1e99", "99999999999999999999", "1e-99"}) {
        CAPTURE(text);
        CHECK_FALSE(parse_decimal(text).has_value());
    }
}

}  // namespace
}  // namespace puppetri::lang
