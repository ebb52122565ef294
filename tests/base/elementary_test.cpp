// SPDX-License-Identifier: MIT
// The elementary functions against the C library's long double ones, and their bits against pinned
// hashes.
#include "puppetri/base/elementary.h"

#include <doctest/doctest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "puppetri/base/hash.h"
#include "puppetri/base/random.h"

namespace {

using puppetri::Hash64;
using puppetri::RandomStream;

constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// The distance in units in the last place of the exact value.
double error_in_ulp(double got, long double exact) {
    const double nearest = static_cast<double>(exact);
    if (!std::isfinite(nearest) || nearest == 0) {
        return got == nearest ? 0 : kInf;
    }
    int exponent = 0;
    std::frexp(nearest, &exponent);
    const long double unit = std::ldexp(1.0L, std::max(exponent - 53, -1074));
    return static_cast<double>(std::fabs(static_cast<long double>(got) - exact) / unit);
}

template <class F, class G, class Draw>
double worst_error(F ours, G exact, Draw draw, int count = 200000) {
    RandomStream stream{.key = 0x5EED, .count = 0};
    double worst = 0;
    for (int i = 0; i < count; ++i) {
        const double x = draw(stream);
        const double e = error_in_ulp(ours(x), exact(static_cast<long double>(x)));
        worst = e <= worst ? worst : e;  // a NaN stays
    }
    return worst;
}

auto between(double low, double high) {
    return [=](RandomStream& s) { return low + (high - low) * s.uniform(); };
}
// All powers of two alike; exact operations only, so that the inputs are the same everywhere.
auto magnitudes(double low, double high) {
    return [=](RandomStream& s) {
        const double x = std::ldexp(1 + s.uniform(),
                                    static_cast<int>(s.between(std::ilogb(low), std::ilogb(high))));
        return x < low ? low : x > high ? high : x;
    };
}
auto either_sign(double low, double high) {
    return [=](RandomStream& s) {
        const double x = magnitudes(low, high)(s);
        return s.below(2) == 0 ? x : -x;
    };
}

bool same_bits(double a, double b) { return std::memcmp(&a, &b, sizeof a) == 0; }

}  // namespace

TEST_CASE("exp is within 1 ulp, also where the result is subnormal [oracle]") {
    const auto ours = [](double x) { return puppetri::exp(x); };
    const auto exact = [](long double x) { return std::exp(x); };
    CHECK(worst_error(ours, exact, between(-740, 709.7)) < 1);
    CHECK(worst_error(ours, exact, between(-1, 1)) < 0.6);
    CHECK(worst_error(ours, exact, either_sign(1e-20, 1)) < 0.6);
    CHECK(puppetri::exp(0) == 1);
    CHECK(puppetri::exp(710) == kInf);
    CHECK(puppetri::exp(-746) == 0);
    CHECK(puppetri::exp(kInf) == kInf);
    CHECK(puppetri::exp(-kInf) == 0);
    CHECK(std::isnan(puppetri::exp(kNan)));
}

TEST_CASE("log is within 1 ulp, also near 1 and for subnormals [oracle]") {
    const auto ours = [](double x) { return puppetri::log(x); };
    const auto exact = [](long double x) { return std::log(x); };
    CHECK(worst_error(ours, exact, magnitudes(5e-324, 1.7e308)) < 1);
    CHECK(worst_error(ours, exact, between(0, 1)) < 1);
    CHECK(worst_error(ours, exact, between(0.95, 1.05)) < 1);
    CHECK(worst_error(ours, exact, between(0.999999, 1.000001)) < 0.6);
    CHECK(puppetri::log(1) == 0);
    CHECK(puppetri::log(0) == -kInf);
    CHECK(puppetri::log(kInf) == kInf);
    CHECK(std::isnan(puppetri::log(-1)));
    CHECK(std::isnan(puppetri::log(kNan)));
}

TEST_CASE("log1p keeps small arguments [oracle]") {
    const auto ours = [](double x) { return puppetri::log1p(x); };
    const auto exact = [](long double x) { return std::log1p(x); };
    CHECK(worst_error(ours, exact, either_sign(1e-300, 0.9)) < 1.5);
    CHECK(worst_error(ours, exact, magnitudes(1e-5, 1e300)) < 1.5);
    CHECK(same_bits(puppetri::log1p(-0.0), -0.0));
    CHECK(puppetri::log1p(-1) == -kInf);
    CHECK(std::isnan(puppetri::log1p(-2)));
}

TEST_CASE("pow is within 1 ulp over its whole range [oracle]") {
    RandomStream stream{.key = 11, .count = 0};
    double worst = 0;
    for (int i = 0; i < 200000; ++i) {
        const double x = magnitudes(1e-5, 1e5)(stream);
        const double y = between(-60, 60)(stream);
        const double e =
            error_in_ulp(puppetri::pow(x, y), std::pow(static_cast<long double>(x), y));
        worst = std::max(worst, e);
    }
    for (int i = 0; i < 100000; ++i) {  // near 1 to great powers
        const double x = 1 + either_sign(1e-12, 1e-3)(stream);
        const double y = either_sign(1, 1e5)(stream);
        const double e =
            error_in_ulp(puppetri::pow(x, y), std::pow(static_cast<long double>(x), y));
        worst = std::max(worst, e);
    }
    CHECK(worst < 1);
}

TEST_CASE("pow gives whole powers of whole numbers exactly [unit]") {
    for (int base = -12; base <= 12; ++base) {
        double product = 1;
        for (int n = 0; n <= 14; ++n) {
            CHECK(puppetri::pow(base, n) == product);
            product *= base;
        }
    }
    CHECK(puppetri::pow(2, -1074) == 5e-324);
    CHECK(puppetri::pow(2, 1023) == 0x1p1023);
    CHECK(puppetri::pow(0.5, 0.5) == std::sqrt(0.5));
}

TEST_CASE("pow has the special values of Annex F [unit]") {
    for (const double x : {0.0, -0.0, 1.0, -3.0, kInf, -kInf, kNan}) {
        CHECK(puppetri::pow(x, 0) == 1);
    }
    CHECK(puppetri::pow(1, kNan) == 1);
    CHECK(std::isnan(puppetri::pow(-8, 1.0 / 3)));
    for (const double x : {0.0, -0.0, 0.5, -0.5, 2.0, -2.0, kInf, -kInf, 1.0, -1.0}) {
        for (const double y :
             {1.0, 2.0, 3.0, -1.0, -2.0, -3.0, 1e20, -1e20, 0x1p53, 0.5, -0.5, kInf, -kInf}) {
            const double got = puppetri::pow(x, y);
            const double wanted = std::pow(x, y);
            CAPTURE(x);
            CAPTURE(y);
            CHECK((same_bits(got, wanted) || (std::isnan(got) && std::isnan(wanted))));
        }
    }
    CHECK(puppetri::pow(10, 309) == kInf);
    CHECK(puppetri::pow(-10, 309) == -kInf);
    CHECK(puppetri::pow(10, -400) == 0);
}

TEST_CASE("sine and cosine are within 1 ulp, for small, usual and huge angles [oracle]") {
    const auto s = [](double x) { return puppetri::sin(x); };
    const auto s_exact = [](long double x) { return std::sin(x); };
    const auto c = [](double x) { return puppetri::cos(x); };
    const auto c_exact = [](long double x) { return std::cos(x); };
    CHECK(worst_error(s, s_exact, either_sign(1e-300, 0.8)) < 1);
    CHECK(worst_error(s, s_exact, between(-20, 20)) < 1);
    CHECK(worst_error(s, s_exact, either_sign(1, 1e6)) < 1);
    CHECK(worst_error(s, s_exact, either_sign(1e6, 1e300)) < 1);
    CHECK(worst_error(c, c_exact, either_sign(1e-300, 0.8)) < 1);
    CHECK(worst_error(c, c_exact, between(-20, 20)) < 1);
    CHECK(worst_error(c, c_exact, either_sign(1, 1e6)) < 1);
    CHECK(worst_error(c, c_exact, either_sign(1e6, 1e300)) < 1);
    CHECK(same_bits(puppetri::sin(-0.0), -0.0));
    CHECK(puppetri::cos(0) == 1);
    CHECK(std::isnan(puppetri::sin(kInf)));
    CHECK(std::isnan(puppetri::cos(-kInf)));
    // 6381956970095103 * 2^797 lies nearest of all doubles to a multiple of pi/2 (Muller et al.,
    // Handbook of Floating-Point Arithmetic, section 10.2): its cosine is 4.687165924254624e-19.
    CHECK(puppetri::cos(std::ldexp(6381956970095103.0, 797)) ==
          doctest::Approx(-4.68716592425462761112e-19).epsilon(1e-15));
}

TEST_CASE("tangent is within 1.5 ulp [oracle]") {
    const auto ours = [](double x) { return puppetri::tan(x); };
    const auto exact = [](long double x) { return std::tan(x); };
    CHECK(worst_error(ours, exact, either_sign(1e-300, 0.8)) < 1.5);
    CHECK(worst_error(ours, exact, between(-20, 20)) < 1.5);
    CHECK(worst_error(ours, exact, either_sign(1e6, 1e300)) < 1.5);
}

TEST_CASE("asin, acos and atan are within 1.5 ulp [oracle]") {
    const auto atan = [](double x) { return puppetri::atan(x); };
    const auto atan_exact = [](long double x) { return std::atan(x); };
    const auto asin = [](double x) { return puppetri::asin(x); };
    const auto asin_exact = [](long double x) { return std::asin(x); };
    const auto acos = [](double x) { return puppetri::acos(x); };
    const auto acos_exact = [](long double x) { return std::acos(x); };
    CHECK(worst_error(atan, atan_exact, either_sign(1e-300, 1e300)) < 1.5);
    CHECK(worst_error(atan, atan_exact, between(-4, 4)) < 1.5);
    CHECK(worst_error(asin, asin_exact, between(-1, 1)) < 1.5);
    CHECK(worst_error(asin, asin_exact, either_sign(1e-300, 1)) < 1.5);
    CHECK(worst_error(acos, acos_exact, between(-1, 1)) < 1.5);
    CHECK(worst_error(acos, acos_exact, between(0.99, 1)) < 1.5);
    CHECK(worst_error(acos, acos_exact, between(-1, -0.99)) < 1.5);
    CHECK(std::isnan(puppetri::asin(1.0000001)));
    CHECK(std::isnan(puppetri::acos(-1.0000001)));
    CHECK(puppetri::acos(1) == 0);
    CHECK(puppetri::atan(kInf) == std::atan(kInf));
    CHECK(same_bits(puppetri::atan(-0.0), -0.0));
}

TEST_CASE(
    "atan2 is within 1.5 ulp in every quarter and has the special values of Annex F [oracle]") {
    RandomStream stream{.key = 3, .count = 0};
    double worst = 0;
    for (int i = 0; i < 300000; ++i) {
        const double y = i % 2 == 0 ? between(-2, 2)(stream) : either_sign(1e-300, 1e300)(stream);
        const double x = i % 2 == 0 ? between(-2, 2)(stream) : either_sign(1e-300, 1e300)(stream);
        const long double exact =
            std::atan2(static_cast<long double>(y), static_cast<long double>(x));
        worst = std::max(worst, error_in_ulp(puppetri::atan2(y, x), exact));
    }
    CHECK(worst < 1.5);
    const double values[] = {0.0, -0.0, 1.0, -1.0, 5e-324, -5e-324, 1.7e308, -1.7e308, kInf, -kInf};
    for (const double y : values) {
        for (const double x : values) {
            CAPTURE(y);
            CAPTURE(x);
            const double wanted = std::atan2(y, x);
            const double got = puppetri::atan2(y, x);
            CHECK(std::signbit(got) == std::signbit(wanted));
            CHECK(error_in_ulp(got, wanted) <= 1);
        }
    }
    CHECK(std::isnan(puppetri::atan2(kNan, 1)));
    CHECK(std::isnan(puppetri::atan2(1, kNan)));
}

TEST_CASE("every elementary function has the same bits everywhere [golden]") {
    RandomStream stream{.key = 77, .count = 0};
    Hash64 hash;
    for (int i = 0; i < 20000; ++i) {
        const double a = either_sign(1e-10, 1e10)(stream);
        const double b = between(-1, 1)(stream);
        hash.add_f64(puppetri::exp(700 * b)).add_f64(puppetri::log(std::fabs(a)));
        hash.add_f64(puppetri::log1p(std::fabs(b))).add_f64(puppetri::pow(std::fabs(a), 10 * b));
        hash.add_f64(puppetri::sin(a)).add_f64(puppetri::cos(a)).add_f64(puppetri::tan(a));
        hash.add_f64(puppetri::asin(b)).add_f64(puppetri::acos(b)).add_f64(puppetri::atan(a));
        hash.add_f64(puppetri::atan2(a, b));
    }
    CHECK(hash.value() == 14977569680240890618u);
}
