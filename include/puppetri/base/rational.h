// SPDX-License-Identifier: MIT
// Exact rational numbers on 64-bit integers: quantities of the scene language until they become
// ticks. Arithmetic never rounds and never wraps: a result that does not fit is reported, not bent.
#pragma once
#include <compare>
#include <cstdint>
#include <optional>

#include "puppetri/base/time.h"

namespace puppetri {

// numerator / denominator in lowest terms, denominator > 0. Make one with make_rational; a whole
// number is Rational{n}.
struct Rational {
    std::int64_t numerator = 0;
    std::int64_t denominator = 1;

    constexpr bool whole() const { return denominator == 1; }
    bool operator==(const Rational&) const = default;
};

// Fails   (nullopt) when the denominator is 0 or the reduced fraction does not fit in 64-bit
// integers.
std::optional<Rational> make_rational(std::int64_t numerator, std::int64_t denominator);

// Fail (nullopt) when the exact result does not fit; divide also when b is 0; power also for 0 to a
// negative exponent.
std::optional<Rational> add(Rational a, Rational b);
std::optional<Rational> subtract(Rational a, Rational b);
std::optional<Rational> multiply(Rational a, Rational b);
std::optional<Rational> divide(Rational a, Rational b);
std::optional<Rational> power(Rational a, int exponent);
std::optional<Rational> negate(Rational a);

// Exact, for all values.
std::strong_ordering compare(Rational a, Rational b);

// The nearest double (ties to even): within 1 unit in the last place where a part exceeds 2^53,
// correct otherwise.
double to_double(Rational a);

// The exact value of a finite double, where it fits.
std::optional<Rational> to_rational(double x);

// A number of ticks and whether it is exactly what was asked for.
struct Ticks {
    SimTime time;
    bool exact = true;
};

// Seconds to ticks, rounded to nearest, ties to even.
// Fails   (nullopt) when the time does not fit in 64 bits of ticks (about 414 years).
std::optional<Ticks> to_ticks(Rational seconds);
// The same for a measured or drawn number of seconds. Fails also for NaN and infinities.
std::optional<Ticks> to_ticks(double seconds);

// The same without the flag, for what is drawn or measured at every step. never() where to_ticks
// would fail.
SimTime nearest_tick(double seconds);

// Ticks to seconds, exactly. The sign of any time but never() is kept.
Rational to_seconds(SimTime time);

}  // namespace puppetri
