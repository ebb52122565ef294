// SPDX-License-Identifier: MIT
// Rational arithmetic through 128-bit intermediates: a sum of two products of 64-bit numbers always
// fits.
#include "puppetri/base/rational.h"

#include <cmath>
#include <limits>

#include "puppetri/base/bit_cast.h"
#include "puppetri/base/require.h"

namespace puppetri {
namespace {

__extension__ using Wide = __int128;
__extension__ using WideUnsigned = unsigned __int128;

constexpr std::int64_t kLargest = std::numeric_limits<std::int64_t>::max();
constexpr std::int64_t kSmallest = std::numeric_limits<std::int64_t>::min();

bool fits(Wide x) { return x >= kSmallest && x <= kLargest; }

WideUnsigned size_of(Wide x) {
    return x < 0 ? -static_cast<WideUnsigned>(x) : static_cast<WideUnsigned>(x);
}

WideUnsigned greatest_common_divisor(WideUnsigned a, WideUnsigned b) {
    while (b != 0) {
        const WideUnsigned rest = a % b;
        a = b;
        b = rest;
    }
    return a;
}

// denominator > 0
std::optional<Rational> reduced(Wide numerator, Wide denominator) {
    const Wide divisor =
        static_cast<Wide>(greatest_common_divisor(size_of(numerator), size_of(denominator)));
    numerator /= divisor;
    denominator /= divisor;
    if (!fits(numerator) || !fits(denominator)) {
        return std::nullopt;
    }
    return Rational{.numerator = static_cast<std::int64_t>(numerator),
                    .denominator = static_cast<std::int64_t>(denominator)};
}

std::optional<Rational> reduced_any_sign(Wide numerator, Wide denominator) {
    if (denominator == 0) {
        return std::nullopt;
    }
    return denominator < 0 ? reduced(-numerator, -denominator) : reduced(numerator, denominator);
}

// numerator / denominator to the nearest whole number, ties to even; denominator > 0.
struct Rounded {
    Wide value;
    bool exact;
};
Rounded divide_to_nearest_even(Wide numerator, Wide denominator) {
    Wide quotient = numerator / denominator;
    Wide rest = numerator % denominator;
    if (rest < 0) {
        rest += denominator;
        --quotient;
    }
    const Wide twice = 2 * rest;
    if (twice > denominator || (twice == denominator && quotient % 2 != 0)) {
        ++quotient;
    }
    return {.value = quotient, .exact = rest == 0};
}

}  // namespace

std::optional<Rational> make_rational(std::int64_t numerator, std::int64_t denominator) {
    return reduced_any_sign(numerator, denominator);
}

std::optional<Rational> add(Rational a, Rational b) {
    return reduced(Wide{a.numerator} * b.denominator + Wide{b.numerator} * a.denominator,
                   Wide{a.denominator} * b.denominator);
}

std::optional<Rational> subtract(Rational a, Rational b) {
    return reduced(Wide{a.numerator} * b.denominator - Wide{b.numerator} * a.denominator,
                   Wide{a.denominator} * b.denominator);
}

std::optional<Rational> multiply(Rational a, Rational b) {
    return reduced(Wide{a.numerator} * b.numerator, Wide{a.denominator} * b.denominator);
}

std::optional<Rational> divide(Rational a, Rational b) {
    return reduced_any_sign(Wide{a.numerator} * b.denominator, Wide{a.denominator} * b.numerator);
}

std::optional<Rational> negate(Rational a) { return reduced(-Wide{a.numerator}, a.denominator); }

// By squaring; squares are taken only while they are still needed, so that nothing overflows before
// the result does.
std::optional<Rational> power(Rational a, int exponent) {
    std::int64_t left = exponent;
    if (left < 0) {
        const std::optional<Rational> inverse =
            divide(Rational{.numerator = 1, .denominator = 1}, a);
        if (!inverse) {
            return std::nullopt;
        }
        a = *inverse;
        left = -left;
    }
    Rational result = {.numerator = 1, .denominator = 1};
    while (left != 0) {
        if (left % 2 != 0) {
            const std::optional<Rational> next = multiply(result, a);
            if (!next) {
                return std::nullopt;
            }
            result = *next;
        }
        left /= 2;
        if (left != 0) {
            const std::optional<Rational> square = multiply(a, a);
            if (!square) {
                return std::nullopt;
            }
            a = *square;
        }
    }
    return result;
}

std::strong_ordering compare(Rational a, Rational b) {
    const Wide left = Wide{a.numerator} * b.denominator;
    const Wide right = Wide{b.numerator} * a.denominator;
    return left < right   ? std::strong_ordering::less
           : left > right ? std::strong_ordering::greater
                          : std::strong_ordering::equal;
}

double to_double(Rational a) {
    return static_cast<double>(a.numerator) / static_cast<double>(a.denominator);
}

std::optional<Rational> to_rational(double x) {
    const std::uint64_t bits = puppetri::bit_cast<std::uint64_t>(x);
    int exponent = static_cast<int>((bits >> 52) & 0x7FF);
    std::int64_t mantissa = static_cast<std::int64_t>(bits & 0xFFFFFFFFFFFFFu);
    if (exponent == 0x7FF) {
        return std::nullopt;
    }
    mantissa |= exponent == 0 ? 0 : std::int64_t{1} << 52;
    exponent = (exponent == 0 ? 1 : exponent) - 1075;
    if (mantissa == 0) {
        return Rational{};
    }
    while (mantissa % 2 == 0) {
        mantissa /= 2;
        ++exponent;
    }
    if (exponent < -62 || exponent > 62) {
        return std::nullopt;
    }
    const Wide numerator = Wide{mantissa} << (exponent > 0 ? exponent : 0);
    const Wide denominator = Wide{1} << (exponent < 0 ? -exponent : 0);
    return reduced(x < 0 ? -numerator : numerator, denominator);
}

std::optional<Ticks> to_ticks(Rational seconds) {
    const Rounded ticks =
        divide_to_nearest_even(Wide{seconds.numerator} * kTicksPerSecond, seconds.denominator);
    if (!fits(ticks.value) || ticks.value == kLargest) {  // the largest number means never
        return std::nullopt;
    }
    return Ticks{.time = {static_cast<std::int64_t>(ticks.value)}, .exact = ticks.exact};
}

// The product with the tick rate rounds once; from 2^53 ticks on (147 days) it has no fraction
// left.
SimTime nearest_tick(double seconds) {
    const double product = seconds * static_cast<double>(kTicksPerSecond);
    if (!(product > -9.2e18 && product < 9.2e18)) {
        return SimTime::never();
    }
    return {static_cast<std::int64_t>(std::nearbyint(product))};
}

std::optional<Ticks> to_ticks(double seconds) {
    const SimTime time = nearest_tick(seconds);
    if (time == SimTime::never()) {
        return std::nullopt;
    }
    const std::optional<Rational> given = to_rational(seconds);
    return Ticks{.time = time, .exact = given && compare(*given, to_seconds(time)) == 0};
}

Rational to_seconds(SimTime time) {
    const std::optional<Rational> seconds = make_rational(time.ticks, kTicksPerSecond);
    PUP_REQUIRE(seconds.has_value());
    return *seconds;
}

}  // namespace puppetri
