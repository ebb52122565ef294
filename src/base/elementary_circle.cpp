// SPDX-License-Identifier: MIT
// Sine and its kin, and their inverses.
#include <cmath>
#include <cstdint>
#include <limits>

#include "elementary_tables.h"
#include "puppetri/base/bit_cast.h"
#include "puppetri/base/elementary.h"

namespace puppetri {
namespace {

using namespace elementary;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// x = quarter pi/2 + high + low, |high| <= pi/4 and a little; of the quarter the last two bits
// count.
struct Reduced {
    std::uint32_t quarter;
    double high;
    double low;
};

struct Sum {
    double high;
    double low;
};
// Source  D. Knuth, The Art of Computer Programming 2, 4.2.2, theorem B.
inline Sum exact_sum(double a, double b) {
    const double s = a + b;
    const double b_part = s - a;
    return {.high = s, .low = (a - (s - b_part)) + (b - b_part)};
}

// a b - product, exactly, where product is a b rounded.
// Source  T. Dekker, "A floating-point technique for extending the available precision", Numer.
// Math. 18 (1971).
inline double product_error(double a, double b, double product) {
    constexpr double kSplitter = 0x1p27 + 1;
    const double ca = kSplitter * a;
    const double a_high = ca - (ca - a);
    const double a_low = a - a_high;
    const double cb = kSplitter * b;
    const double b_high = cb - (cb - b);
    const double b_low = b - b_high;
    return ((a_high * b_high - product) + a_high * b_low + a_low * b_high) + a_low * b_low;
}

// pi/2 in pieces of 33 bits, so that n times a piece is exact for n < 2^20.
// Source  W. Cody, W. Waite, "Software Manual for the Elementary Functions" (1980), chapter 8.
Reduced reduce_medium(double x) {
    constexpr double kShift = 0x1.8p52;
    const double n = (x * kTwoByPi + kShift) - kShift;
    const Sum first = exact_sum(x - n * kHalfPi[0], -n * kHalfPi[1]);
    const Sum second = exact_sum(first.high, -n * kHalfPi[2]);
    const double low = first.low + (second.low - n * kHalfPi[3]);
    const double high = second.high + low;
    return {.quarter = static_cast<std::uint32_t>(static_cast<std::int32_t>(n)),
            .high = high,
            .low = (second.high - high) + low};
}

// x = M 2^e with an integer M of 53 bits: of M 2^e 2/pi only the bits from four before the point to
// 128 after matter; they come from a window of 2/pi. Source  M. Payne, R. Hanek, "Radian reduction
// for trigonometric functions", SIGNUM Newsletter 18 (1983).
Reduced reduce_large(double x) {
    const std::uint64_t bits = puppetri::bit_cast<std::uint64_t>(x);
    const std::int32_t exponent = static_cast<std::int32_t>((bits >> 52) & 0x7FF) - 1075;
    const std::uint64_t mantissa = (bits & 0xFFFFFFFFFFFFFu) | 0x10000000000000u;
    // The window starts at a word of 32 bits so that all that stands before it times M 2^e is a
    // multiple of 4.
    const std::int32_t skipped_bits = exponent - 2 > 0 ? exponent - 2 : 0;
    const std::int32_t first_word = skipped_bits / 32;
    constexpr int kWords = 8;
    std::uint32_t product[kWords + 2] = {};  // least significant first; M * window
    const std::uint32_t factor[2] = {static_cast<std::uint32_t>(mantissa),
                                     static_cast<std::uint32_t>(mantissa >> 32)};
    for (int i = 0; i < kWords; ++i) {
        const std::uint32_t word = kTwoByPiBits[first_word + kWords - 1 - i];
        std::uint64_t carry = 0;
        for (int k = 0; k < 2; ++k) {
            carry += std::uint64_t{word} * factor[k] + product[i + k];
            product[i + k] = static_cast<std::uint32_t>(carry);
            carry >>= 32;
        }
        product[i + 2] = static_cast<std::uint32_t>(carry);
    }
    // The product counts units of 2^(exponent - 32 (first_word + kWords)); bring its point to a
    // word's edge.
    const std::int32_t fraction_bits = 32 * (first_word + kWords) - exponent;
    const auto bits_from =
        [&](std::int32_t position) {  // 32 bits, the lowest at this place after 2^0
            const std::uint32_t at = static_cast<std::uint32_t>(fraction_bits + position);
            const std::uint32_t word = at / 32;
            const std::uint32_t shift = at % 32;
            const std::uint64_t low = word < kWords + 2 ? product[word] : 0;
            const std::uint64_t high = word + 1 < kWords + 2 ? product[word + 1] : 0;
            return static_cast<std::uint32_t>(((high << 32 | low) >> shift));
        };
    std::uint32_t quarter = bits_from(0) & 3u;
    std::uint32_t fraction[4] = {bits_from(-32), bits_from(-64), bits_from(-96), bits_from(-128)};
    const bool upper_half = (fraction[0] >> 31) != 0;
    if (upper_half) {  // measure from the next quarter: negate the fraction
        ++quarter;
        std::uint64_t carry = 1;
        for (int i = 3; i >= 0; --i) {
            carry += static_cast<std::uint32_t>(~fraction[i]);
            fraction[i] = static_cast<std::uint32_t>(carry);
            carry >>= 32;
        }
    }
    // A double holds 53 bits: sum four words, exactly, from the top.
    const Sum top = exact_sum(fraction[0] * 0x1p-32, fraction[1] * 0x1p-64);
    const Sum next = exact_sum(top.high, fraction[2] * 0x1p-96);
    const double turn = next.high;
    const double turn_low = next.low + top.low + fraction[3] * 0x1p-128;
    const double high = turn * kHalfPiHigh;
    const double low =
        product_error(turn, kHalfPiHigh, high) + turn * kHalfPiLow + turn_low * kHalfPiHigh;
    const double sum = high + low;
    const double rest = (high - sum) + low;
    const double sign = upper_half ? -1 : 1;
    return {.quarter = quarter, .high = sign * sum, .low = sign * rest};
}

// Needs a finite x.
Reduced reduce(double x) {
    const double size = std::fabs(x);
    if (size <= 0x1.921fb54442d18p-1) {
        return {.quarter = 0, .high = x, .low = 0};
    }
    if (size < 0x1p20) {
        return reduce_medium(x);
    }
    const Reduced r = reduce_large(size);
    return x > 0 ? r : Reduced{.quarter = 0 - r.quarter, .high = -r.high, .low = -r.low};
}

// sin(x + tail) = x + (correction), |x| <= pi/4; the correction is below x^3/6.
inline double sin_correction(double x, double tail) {
    const double z = x * x;
    const double p =
        kSin[0] +
        z * (kSin[1] + z * (kSin[2] + z * (kSin[3] + z * (kSin[4] + z * (kSin[5] + z * kSin[6])))));
    return x * z * p + (tail - 0.5 * z * tail);
}

// cos(x + tail) = (1 - x^2/2 rounded) + (correction).
inline Sum cos_parts(double x, double tail) {
    const double z = x * x;
    const double half = 0.5 * z;
    const double w = 1 - half;
    const double p =
        kCos[0] + z * (kCos[1] + z * (kCos[2] + z * (kCos[3] + z * (kCos[4] + z * kCos[5]))));
    return {.high = w, .low = ((1 - w) - half) + (z * z * p - x * tail)};
}

inline double sin_reduced(const Reduced& r) { return r.high + sin_correction(r.high, r.low); }
inline double cos_reduced(const Reduced& r) {
    const Sum c = cos_parts(r.high, r.low);
    return c.high + c.low;
}

bool finite(double x) { return x - x == 0; }

// The angle of the point (b, a), a >= 0, b >= 0, not both 0, both finite and within 2^+-900, added
// to `base`. With c = j/16 next to a/b, atan(a/b) = atan(c) + atan(t), t = (a - c b)/(b + c a), |t|
// <= 1/31; for a > b the roles change and the result is taken from pi/2. Taylor's series of atan t
// to t^11 leaves 2^-62. Source  S. Gal, B. Bachelis, "An accurate elementary mathematical library
// for the IEEE floating point standard", ACM
//         TOMS 17 (1991), in its plain form with evenly spaced table points.
Sum angle_in_quarter(double a, double b) {
    const bool steep = a > b;
    const double small = steep ? b : a;
    const double large = steep ? a : b;
    const double ratio = small / large;
    const std::int32_t j = static_cast<std::int32_t>(ratio * 16 + 0.5);
    const double c = j * 0x1p-4;
    const double t = j == 0 ? ratio : (small - c * large) / (large + c * small);
    const double z = t * t;
    const double odd =
        t * z * (-1.0 / 3 + z * (1.0 / 5 + z * (-1.0 / 7 + z * (1.0 / 9 - z * (1.0 / 11)))));
    const double* entry = kAtan[j];
    if (!steep) {
        const double sum = entry[0] + t;
        return {.high = sum, .low = (t - (sum - entry[0])) + (odd + entry[1])};
    }
    const double start = kHalfPiHigh - entry[0];
    const double start_low = (kHalfPiHigh - start) - entry[0];
    const double sum = start - t;
    return {.high = sum, .low = ((start - sum) - t) + (start_low - odd + (kHalfPiLow - entry[1]))};
}

// The root of z + z_low is root + (this), where root is the root of z rounded.
double root_remainder(double z, double z_low, double root) {
    const double square = root * root;
    return ((z - square) - product_error(root, root, square) + z_low) / (root + root);
}

}  // namespace

double sin(double x) {
    if (!finite(x)) {
        return kNan;
    }
    if (std::fabs(x) < 0x1p-27) {
        return x;
    }
    const Reduced r = reduce(x);
    const double value = (r.quarter & 1u) != 0 ? cos_reduced(r) : sin_reduced(r);
    return (r.quarter & 2u) != 0 ? -value : value;
}

double cos(double x) {
    if (!finite(x)) {
        return kNan;
    }
    const Reduced r = reduce(x);
    const double value = (r.quarter & 1u) != 0 ? sin_reduced(r) : cos_reduced(r);
    return ((r.quarter + 1) & 2u) != 0 ? -value : value;
}

// The quotient of sine and cosine, each as a sum of two, with one step of division's remainder.
double tan(double x) {
    if (!finite(x)) {
        return kNan;
    }
    if (std::fabs(x) < 0x1p-27) {
        return x;
    }
    const Reduced r = reduce(x);
    Sum s = {.high = r.high, .low = sin_correction(r.high, r.low)};
    Sum c = cos_parts(r.high, r.low);
    if ((r.quarter & 1u) != 0) {
        const Sum previous = s;
        s = c;
        c = {.high = -previous.high, .low = -previous.low};
    }
    const double quotient = (s.high + s.low) / (c.high + c.low);
    const double product = quotient * c.high;
    const double remainder =
        (s.high - product) - product_error(quotient, c.high, product) + (s.low - quotient * c.low);
    return quotient + remainder / c.high;
}

double atan2(double y, double x) {
    if (x != x || y != y) {
        return kNan;
    }
    const bool below = std::copysign(1.0, y) < 0;
    const bool behind = std::copysign(1.0, x) < 0;
    double a = std::fabs(y);
    double b = std::fabs(x);
    if (a == kInfinity || b == kInfinity) {
        a = a == kInfinity ? 1 : 0;
        b = b == kInfinity ? 1 : 0;
    }
    Sum angle = {.high = 0, .low = 0};
    if (a == 0) {  // along the axis
    } else if (b == 0) {
        angle = {.high = kHalfPiHigh, .low = kHalfPiLow};
    } else if (!behind && a < b * 0x1p-500) {
        angle = {.high = a / b, .low = 0};
    } else {
        // Away from the ends of the range; what is lost of the smaller one is below the result's
        // last place.
        const double scale = a > 0x1p500 || b > 0x1p500 ? 0x1p-512 : a < 0x1p-500 ? 0x1p512 : 1;
        angle = angle_in_quarter(a * scale, b * scale);
    }
    double value = angle.high + angle.low;
    if (behind) {
        value = 2 * kHalfPiHigh - angle.high;
        const double lost = (2 * kHalfPiHigh - value) - angle.high;
        value += lost + (2 * kHalfPiLow - angle.low);
    }
    return below ? -value : value;
}

double atan(double x) {
    if (x == 0) {
        return x;
    }
    return atan2(x, 1);
}

// asin x = atan2(x, c), c = sqrt(1 - x^2). An error dc of c turns the angle by -x dc.
double asin(double x) {
    if (!(x >= -1 && x <= 1)) {
        return kNan;
    }
    const double size = std::fabs(x);
    if (size < 0x1p-27) {
        return x;
    }
    if (size == 1) {
        return std::copysign(kHalfPiHigh, x);
    }
    const double square = size * size;
    const Sum rest = exact_sum(1, -square);
    const double c = std::sqrt(rest.high);
    const double dc = root_remainder(rest.high, rest.low - product_error(size, size, square), c);
    const Sum angle = angle_in_quarter(size, c);
    return std::copysign(angle.high + (angle.low - size * dc), x);
}

// acos x = 2 atan2(s, c), s = sqrt(1 - x), c = sqrt(1 + x). Errors ds and dc turn the half angle by
// (c ds - s dc) / 2.
double acos(double x) {
    if (!(x >= -1 && x <= 1)) {
        return kNan;
    }
    if (x == 1) {
        return 0;
    }
    if (x == -1) {
        return 2 * kHalfPiHigh;
    }
    const Sum minus = exact_sum(1, -x);
    const Sum plus = exact_sum(1, x);
    const double s = std::sqrt(minus.high);
    const double c = std::sqrt(plus.high);
    const double ds = root_remainder(minus.high, minus.low, s);
    const double dc = root_remainder(plus.high, plus.low, c);
    const Sum half = angle_in_quarter(s, c);
    return 2 * (half.high + (half.low + 0.5 * (c * ds - s * dc)));
}

}  // namespace puppetri
