// SPDX-License-Identifier: MIT
// Exact rationals: against long division by hand, and their overflow.
#include "puppetri/base/rational.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "puppetri/base/random.h"

using namespace puppetri;

namespace {
constexpr std::int64_t kMax = std::numeric_limits<std::int64_t>::max();
constexpr std::int64_t kMin = std::numeric_limits<std::int64_t>::min();

Rational q(std::int64_t n, std::int64_t d) { return make_rational(n, d).value(); }
}  // namespace

TEST_CASE("a rational is in lowest terms with the sign above [unit]") {
    CHECK(q(6, -4) == Rational{.numerator = -3, .denominator = 2});
    CHECK(q(0, -7) == Rational{.numerator = 0, .denominator = 1});
    CHECK(q(kMin, kMin) == Rational{.numerator = 1, .denominator = 1});
    CHECK(q(kMin, 2).numerator == kMin / 2);
    CHECK(!make_rational(1, 0));
    CHECK(!make_rational(1, kMin));
    CHECK(!make_rational(kMin, -1));
}

TEST_CASE("small rationals obey the laws of a field [law]") {
    RandomStream stream{.key = 1, .count = 0};
    const auto draw = [&] {
        const std::int64_t n = stream.between(-60, 60);
        return q(n, stream.between(1, 60));
    };
    for (int i = 0; i < 2000; ++i) {
        const Rational a = draw();
        const Rational b = draw();
        const Rational c = draw();
        CHECK(add(a, b) == add(b, a));
        CHECK(add(add(a, b).value(), c) == add(a, add(b, c).value()));
        CHECK(multiply(a, add(b, c).value()) ==
              add(multiply(a, b).value(), multiply(a, c).value()));
        CHECK(subtract(add(a, b).value(), b) == a);
        if (b.numerator != 0) {
            CHECK(multiply(divide(a, b).value(), b) == a);
        } else {
            CHECK(!divide(a, b));
        }
        CHECK((compare(a, b) < 0) == (subtract(a, b)->numerator < 0));
    }
}

TEST_CASE(
    "a result that fits is found although its parts do not, one that does not fit is reported "
    "[unit]") {
    CHECK(add(q(kMax, 2), q(kMax, 2)) == q(kMax, 1));
    CHECK(multiply(q(kMax, 3), q(3, kMax)) == q(1, 1));
    CHECK(!add(q(kMax, 1), q(1, 1)));
    CHECK(!multiply(q(kMax, 1), q(2, 1)));
    CHECK(!add(q(1, kMax), q(1, kMax - 1)));
    CHECK(!negate(Rational{.numerator = kMin}));
    CHECK(compare(q(kMax, kMax - 1), q(kMax - 1, kMax - 2)) < 0);
}

TEST_CASE("powers are exact, also negative ones [unit]") {
    CHECK(power(q(2, 3), 5) == q(32, 243));
    CHECK(power(q(-2, 3), -3) == q(-27, 8));
    CHECK(power(q(0, 1), 0) == q(1, 1));
    CHECK(!power(q(0, 1), -1));
    CHECK(power(q(2, 1), 62) == q(std::int64_t{1} << 62, 1));
    CHECK(!power(q(2, 1), 63));
    CHECK(power(q(-2, 1), 63) == q(kMin, 1));
    CHECK(power(q(-1, 1), std::numeric_limits<int>::min()) == q(1, 1));
}

TEST_CASE("seconds become ticks to nearest, ties to even, and say whether exactly [unit]") {
    CHECK(to_ticks(q(1, 24))->time.ticks == kTicksPerSecond / 24);
    CHECK(to_ticks(q(1001, 30000))->exact);
    CHECK(to_ticks(q(1001, 24000))->exact);
    CHECK(!to_ticks(q(1, 7 * kTicksPerSecond))->exact);
    const std::int64_t twice = 2 * kTicksPerSecond;
    for (std::int64_t half = -7; half <= 7; half += 2) {
        const Ticks t = to_ticks(q(half, twice)).value();
        CHECK(!t.exact);
        CHECK(t.time.ticks % 2 == 0);
        CHECK(std::abs(2 * t.time.ticks - half) == 1);
    }
    CHECK(to_ticks(q(-1, 3))->time.ticks == -kTicksPerSecond / 3);
    CHECK(!to_ticks(q(kMax, 1)));
    CHECK(!to_ticks(q(kMin, 1)));
    CHECK(to_ticks(q(13000000000, 1)).has_value());  // 412 years
}

TEST_CASE("doubles become ticks in the same way [unit]") {
    CHECK(to_ticks(0.5)->time.ticks == kTicksPerSecond / 2);
    CHECK(to_ticks(0.5)->exact);
    CHECK(!to_ticks(0.1)->exact);  // the double is not a tenth
    CHECK(nearest_tick(0.1).ticks == kTicksPerSecond / 10);
    CHECK(nearest_tick(1.5 / kTicksPerSecond).ticks == 2);
    CHECK(nearest_tick(2.5 / kTicksPerSecond).ticks == 2);
    CHECK(!to_ticks(std::nan("")));
    CHECK(!to_ticks(1e300));
    CHECK(!to_ticks(-std::numeric_limits<double>::infinity()));
}

TEST_CASE("ticks return to exact seconds, doubles to exact rationals [unit]") {
    CHECK(to_seconds({kTicksPerSecond / 24}) == q(1, 24));
    CHECK(to_seconds({-kTicksPerSecond * 3 / 2}) == q(-3, 2));
    CHECK(to_rational(0.375) == q(3, 8));
    CHECK(to_rational(-6) == q(-6, 1));
    CHECK(to_rational(0x1p62) == q(std::int64_t{1} << 62, 1));
    CHECK(!to_rational(0x1p63));
    CHECK(!to_rational(1e-300));
    CHECK(!to_rational(std::nan("")));
    CHECK(to_double(q(1, 3)) == 1.0 / 3);
}
