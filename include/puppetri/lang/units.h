// SPDX-License-Identifier: MIT
// Units of the language, exact: a quantity is a rational number, a power of pi and a dimension. `12
// frames` has a dimension of its own until a frame rate turns it into a time; numbers without unit
// have none.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "puppetri/base/rational.h"
#include "puppetri/base/result.h"

namespace puppetri::lang {

// Exponents of the base units: metre, second, kilogram, radian, frame.
struct Dimension {
    std::int8_t length = 0, time = 0, mass = 0, angle = 0, frame = 0;
    bool operator==(const Dimension&) const = default;
};

namespace dimension {
inline constexpr Dimension kNone{};
inline constexpr Dimension kLength{.length = 1};
inline constexpr Dimension kTime{.time = 1};
inline constexpr Dimension kMass{.mass = 1};
inline constexpr Dimension kAngle{.angle = 1};
inline constexpr Dimension kFrame{.frame = 1};
inline constexpr Dimension kSpeed{.length = 1, .time = -1};
inline constexpr Dimension kAcceleration{.length = 1, .time = -2};
inline constexpr Dimension kForce{.length = 1, .time = -2, .mass = 1};
}  // namespace dimension

// 1 unit = scale * pi^pi_power in metres, seconds, kilograms, radians, frames.
struct Unit {
    Dimension dimension;
    Rational scale{1, 1};
    int pi_power = 0;
};

// A written unit: "s", "cm", "m/s^2", "turns/s", "N*m". Products and quotients of the simple units,
// powers -9 to 9. Fails   (nullopt) for a name that no unit has.
std::optional<Unit> find_unit(std::string_view written);

// The simple units by name, for messages and completion: "s", "ms", "min", ... in a fixed order.
std::span<const std::string> unit_names();

// A number with its unit resolved: value = number * pi^pi_power in SI units and radians.
struct Quantity {
    Rational number;
    int pi_power = 0;
    Dimension dimension;
    double value() const;
    bool operator==(const Quantity&) const = default;
};

// Fails   (nullopt) when the exact value does not fit a Rational; needs a unit that find_unit
// knows, or an empty one.
std::optional<Quantity> to_quantity(Rational number, std::string_view unit);

// What people call it: "a time", "a length", "a speed", "a number without unit", "m^2 kg/s".
std::string to_text(Dimension dimension);

// A unit to propose where this dimension is wanted: "s" for a time. Empty for numbers without unit.
std::string_view example_unit(Dimension dimension);

}  // namespace puppetri::lang
