// SPDX-License-Identifier: MIT
// exp, log, log1p and pow by tables and short series.
#include <cstdint>
#include <limits>

#include "elementary_tables.h"
#include "puppetri/base/bit_cast.h"
#include "puppetri/base/elementary.h"

namespace puppetri {
namespace {

using namespace elementary;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kLargestExponent = 0x1.62e42fefa39efp+9;    // ln of the largest double
constexpr double kSmallestExponent = -0x1.74910d52d3052p+9;  // below, exp is 0

// 2^k for -1022 <= k <= 1023.
double power_of_two(std::int64_t k) {
    return puppetri::bit_cast<double>(static_cast<std::uint64_t>(k + 1023) << 52);
}

// exp(x + tail), |tail| much below |x|, kSmallestExponent <= x <= kLargestExponent.
//
// With n = nearest integer of 64 x / ln 2, n = 64 k + j:  exp(x) = 2^k 2^(j/64) exp(r), r = x - n
// ln 2 / 64, |r| <= ln 2 / 128, where Taylor's polynomial of degree 6 leaves 2^-65. Source  P.
// Tang, "Table-driven implementation of the exponential function", ACM TOMS 15 (1989). Changed: 64
//         entries and Taylor's coefficients.
inline double exp_core(double x, double tail) {
    constexpr double kShift = 0x1.8p52;  // adding it leaves the nearest integer in the low bits
    const double shifted = x * k64ByLn2 + kShift;
    const double n = shifted - kShift;
    const std::int32_t index = static_cast<std::int32_t>(n);
    const double r = (x - n * kLn2By64High) - n * kLn2By64Low + tail;
    const double r2 = r * r;
    const double p =
        r + r2 * ((0.5 + r * (1.0 / 6)) + r2 * ((1.0 / 24 + r * (1.0 / 120)) + r2 * (1.0 / 720)));
    const double* entry = kExp2[index & 63];
    const double y = entry[0] + (entry[1] + entry[0] * p);
    const std::int32_t k = (index - (index & 63)) / 64;
    if (k >= -1021 && k <= 1022) {
        return y * power_of_two(k);
    }
    const std::int32_t half = k / 2;
    return y * power_of_two(half) * power_of_two(k - half);
}

// A positive finite x as 2^k m, sqrt(1/2) <= m < sqrt(2), and F = j / 128 next to m.
struct Parts {
    double k;
    std::int32_t j;
    double centre;
    double m;
};
inline Parts split(double x) {
    std::int64_t shift = 0;
    if (x < 0x1p-1022) {
        x *= 0x1p54;
        shift = 54;
    }
    constexpr std::uint64_t kRootHalf = 0x3FE6A09E667F3BCDu;
    const std::uint64_t bits = puppetri::bit_cast<std::uint64_t>(x);
    const std::int64_t k = static_cast<std::int64_t>(bits - kRootHalf) >> 52;
    const double m = puppetri::bit_cast<double>(bits - (static_cast<std::uint64_t>(k) << 52));
    const std::int32_t j = static_cast<std::int32_t>(m * 128 + 0.5);
    return {.k = static_cast<double>(k - shift), .j = j, .centre = j * 0x1p-7, .m = m};
}

// ln(1 + f) for |f| <= 1/50:  with u = 2f/(2 + f),  ln(1 + f) = u + u^3/12 + u^5/80 + ...  and  u =
// f - f u / 2, whose first term is exact.
inline double log_near_one(double f) {
    const double u = (f + f) / (2 + f);
    const double v = u * u;
    const double series =
        u * v * ((1.0 / 12 + v * (1.0 / 80)) + v * v * (1.0 / 448 + v * (1.0 / 2304)));
    return f - (0.5 * f * u - series);
}

struct DoubleDouble {
    double high;
    double low;
};

// The exact product, by halves of 26 bits, without fused operations.
// Source  T. Dekker, "A floating-point technique for extending the available precision", Numer.
// Math. 18 (1971).
inline DoubleDouble exact_product(double a, double b) {
    constexpr double kSplitter = 0x1p27 + 1;
    const double ca = kSplitter * a;
    const double a_high = ca - (ca - a);
    const double a_low = a - a_high;
    const double cb = kSplitter * b;
    const double b_high = cb - (cb - b);
    const double b_low = b - b_high;
    const double product = a * b;
    const double error =
        ((a_high * b_high - product) + a_high * b_low + a_low * b_high) + a_low * b_low;
    return {.high = product, .low = error};
}

// ln x to about 2^-70 of its size, for pow. As log below, but u with its own remainder.
DoubleDouble log_core(double x) {
    const Parts parts = split(x);
    const double f = parts.m - parts.centre;
    const double d = parts.centre + parts.m;
    const double d_low = parts.m - (d - parts.centre);
    const double u = (f + f) / d;
    const DoubleDouble ud = exact_product(u, d);
    const double u_low = (((f + f) - ud.high) - ud.low - u * d_low) / d;
    const double v = u * u;
    const double series = u * v * (1.0 / 12 + v * (1.0 / 80 + v * (1.0 / 448 + v * (1.0 / 2304))));
    const double* entry = kLog[parts.j - 90];
    const double base = parts.k * kLn2High + entry[0];
    const double low = parts.k * kLn2Low + entry[1] + (u_low + series);
    const double sum = base + u;
    const double u_part = sum - base;
    const double error = (base - (sum - u_part)) + (u - u_part);  // Knuth's two-sum
    const double high = sum + (error + low);
    return {.high = high, .low = (sum - high) + (error + low)};
}

bool is_odd_integer(double y) {
    const double size = y < 0 ? -y : y;
    if (size >= 0x1p53 || size < 1) {
        return false;
    }
    const std::int64_t whole = static_cast<std::int64_t>(size);
    return static_cast<double>(whole) == size && (whole & 1) != 0;
}

bool is_integer(double y) {
    const double size = y < 0 ? -y : y;
    return size >= 0x1p53 || static_cast<double>(static_cast<std::int64_t>(size)) == size;
}

}  // namespace

double exp(double x) {
    if (!(x >= kSmallestExponent && x <= kLargestExponent)) {
        return x > 0 ? kInfinity : x < 0 ? 0 : x;
    }
    return exp_core(x, 0);
}

// ln x = k ln 2 + ln F + ln(m / F); with f = m - F, exact, and u = 2f/(2F + f):  ln(m / F) = u +
// u^3/12 + u^5/80 + ..., |u| < 2^-7. k ln 2 + ln F is exact in the high parts of the table. Source
// P. Tang, "Table-driven implementation of the logarithm function", ACM TOMS 16 (1990),
// procedure 1.
double log(double x) {
    if (!(x > 0 && x < kInfinity)) {
        return x == 0 ? -kInfinity : x > 0 ? x : kNan;
    }
    const Parts parts = split(x);
    if (parts.k == 0 && parts.j >= 126 && parts.j <= 130) {
        return log_near_one(parts.m - 1);
    }
    const double f = parts.m - parts.centre;
    const double u = (f + f) / (parts.centre + parts.m);
    const double v = u * u;
    const double* entry = kLog[parts.j - 90];
    const double low = parts.k * kLn2Low + entry[1];
    return (parts.k * kLn2High + entry[0]) + (u + (u * v * (1.0 / 12 + v * (1.0 / 80)) + low));
}

// ln(1 + x) = ln(y) + c / y, where y = 1 + x rounded and c is what the rounding left out.
double log1p(double x) {
    if (x >= -0x1p-6 && x <= 0x1p-6) {
        return x == 0 ? x : log_near_one(x);
    }
    const double y = 1 + x;
    if (!(y > 0 && y < kInfinity)) {
        return log(y);
    }
    const double c = x < 1 ? x - (y - 1) : 1 - (y - x);
    return log(y) + c / y;
}

// x^y = exp(y ln x), the product carried to about 2^-68 of its size, so that the result's error is
// that of one rounding and a little; where the exact result is a double, it is that double.
double pow(double x, double y) {
    if (y == 0 || x == 1) {
        return 1;
    }
    if (x != x || y != y) {
        return kNan;
    }
    const bool negative = x < 0 || (x == 0 && 1 / x < 0);
    const double sign = negative && is_odd_integer(y) ? -1 : 1;
    const double size = negative ? -x : x;
    if (size == 0 || size == kInfinity) {
        return sign * ((size == 0) == (y < 0) ? kInfinity : 0);
    }
    if (y == kInfinity || y == -kInfinity) {
        return size == 1 ? 1 : (size > 1) == (y > 0) ? kInfinity : 0;
    }
    if (negative && !is_integer(y)) {
        return kNan;
    }
    if (size == 1) {
        return sign;
    }
    // |ln size| >= 2^-53: beyond 2^66 the result has left the range of doubles in any case.
    const double bounded = y > 0x1p66 ? 0x1p66 : y < -0x1p66 ? -0x1p66 : y;
    const DoubleDouble logarithm = log_core(size);
    const double estimate = bounded * logarithm.high;
    if (estimate > 710) {
        return sign * kInfinity;
    }
    if (estimate < -746) {
        return sign * 0.0;
    }
    const DoubleDouble product = exact_product(bounded, logarithm.high);
    return sign * exp_core(product.high, product.low + bounded * logarithm.low);
}

}  // namespace puppetri
