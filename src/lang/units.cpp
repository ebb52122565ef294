// SPDX-License-Identifier: MIT
// The table of units and the reading of products, quotients and powers of them.
#include "puppetri/lang/units.h"

#include <array>
#include <vector>

namespace puppetri::lang {
namespace {

struct Entry {
    std::string_view name;
    Unit unit;
};

constexpr Dimension kFrequency{.time = -1};
constexpr Dimension kEnergy{.length = 2, .time = -2, .mass = 1};
constexpr Dimension kPower{.length = 2, .time = -3, .mass = 1};

// Source  BIPM, The International System of Units, 9th edition, tables 2, 4, 8; the inch is 25.4 mm
// exactly (1959).
constexpr std::array kUnits = {
    Entry{"s", {dimension::kTime, {1, 1}, 0}},
    Entry{"ms", {dimension::kTime, {1, 1000}, 0}},
    Entry{"us", {dimension::kTime, {1, 1'000'000}, 0}},
    Entry{"min", {dimension::kTime, {60, 1}, 0}},
    Entry{"h", {dimension::kTime, {3600, 1}, 0}},
    Entry{"frames", {dimension::kFrame, {1, 1}, 0}},
    Entry{"frame", {dimension::kFrame, {1, 1}, 0}},
    Entry{"m", {dimension::kLength, {1, 1}, 0}},
    Entry{"cm", {dimension::kLength, {1, 100}, 0}},
    Entry{"mm", {dimension::kLength, {1, 1000}, 0}},
    Entry{"km", {dimension::kLength, {1000, 1}, 0}},
    Entry{"inch", {dimension::kLength, {127, 5000}, 0}},
    Entry{"ft", {dimension::kLength, {381, 1250}, 0}},
    Entry{"deg", {dimension::kAngle, {1, 180}, 1}},
    Entry{"rad", {dimension::kAngle, {1, 1}, 0}},
    Entry{"turn", {dimension::kAngle, {2, 1}, 1}},
    Entry{"turns", {dimension::kAngle, {2, 1}, 1}},
    Entry{"kg", {dimension::kMass, {1, 1}, 0}},
    Entry{"g", {dimension::kMass, {1, 1000}, 0}},
    Entry{"N", {dimension::kForce, {1, 1}, 0}},
    Entry{"J", {kEnergy, {1, 1}, 0}},
    Entry{"W", {kPower, {1, 1}, 0}},
    Entry{"Hz", {kFrequency, {1, 1}, 0}},
    Entry{"percent", {dimension::kNone, {1, 100}, 0}},
};

const Unit* find_simple(std::string_view name) {
    for (const Entry& entry : kUnits) {
        if (entry.name == name) {
            return &entry.unit;
        }
    }
    return nullptr;
}

// a * b^exponent, none where the scale does not fit.
std::optional<Unit> combine(const Unit& a, const Unit& b, int exponent) {
    const std::optional<Rational> factor = power(b.scale, exponent);
    if (!factor) {
        return std::nullopt;
    }
    const std::optional<Rational> scale = multiply(a.scale, *factor);
    if (!scale) {
        return std::nullopt;
    }
    const auto sum = [exponent](std::int8_t x, std::int8_t y, bool& fits) {
        const int z = x + y * exponent;
        fits = fits && z >= -99 && z <= 99;
        return static_cast<std::int8_t>(fits ? z : 0);
    };
    bool fits = true;
    Unit out;
    const Dimension& p = a.dimension;
    const Dimension& q = b.dimension;
    out.dimension = {.length = sum(p.length, q.length, fits),
                     .time = sum(p.time, q.time, fits),
                     .mass = sum(p.mass, q.mass, fits),
                     .angle = sum(p.angle, q.angle, fits),
                     .frame = sum(p.frame, q.frame, fits)};
    out.scale = *scale;
    out.pi_power = a.pi_power + b.pi_power * exponent;
    return fits && out.pi_power >= -99 && out.pi_power <= 99 ? std::optional(out) : std::nullopt;
}

}  // namespace

std::optional<Unit> find_unit(std::string_view written) {
    Unit out;
    int sign = 1;
    while (true) {
        const std::size_t stop = written.find_first_of("*/^");
        const Unit* simple = find_simple(written.substr(0, stop));
        if (simple == nullptr) {
            return std::nullopt;
        }
        int exponent = 1;
        std::string_view rest = stop == std::string_view::npos ? "" : written.substr(stop);
        if (!rest.empty() && rest[0] == '^') {
            rest.remove_prefix(1);
            const bool negative = !rest.empty() && rest[0] == '-';
            if (negative) {
                rest.remove_prefix(1);
            }
            if (rest.empty() || rest[0] < '1' || rest[0] > '9') {
                return std::nullopt;
            }
            exponent = (rest[0] - '0') * (negative ? -1 : 1);
            rest.remove_prefix(1);
        }
        const std::optional<Unit> combined = combine(out, *simple, sign * exponent);
        if (!combined) {
            return std::nullopt;
        }
        out = *combined;
        if (rest.empty()) {
            return out;
        }
        if (rest[0] != '*' && rest[0] != '/') {
            return std::nullopt;
        }
        sign = rest[0] == '*' ? 1 : -1;
        written = rest.substr(1);
    }
}

std::span<const std::string> unit_names() {
    static const std::vector<std::string> names = [] {
        std::vector<std::string> out;
        for (const Entry& entry : kUnits) {
            out.emplace_back(entry.name);
        }
        return out;
    }();
    return names;
}

double Quantity::value() const {
    constexpr double kPi = 3.14159265358979323846;
    double out = to_double(number);
    for (int i = 0; i < pi_power; ++i) {
        out *= kPi;
    }
    for (int i = 0; i > pi_power; --i) {
        out /= kPi;
    }
    return out;
}

std::optional<Quantity> to_quantity(Rational number, std::string_view unit) {
    if (unit.empty()) {
        return Quantity{number, 0, {}};
    }
    const std::optional<Unit> found = find_unit(unit);
    if (!found) {
        return std::nullopt;
    }
    const std::optional<Rational> scaled = multiply(number, found->scale);
    if (!scaled) {
        return std::nullopt;
    }
    return Quantity{*scaled, found->pi_power, found->dimension};
}

namespace {

struct Named {
    Dimension dimension;
    std::string_view name, example;
};
constexpr std::array kNamed = {
    Named{dimension::kNone, "a number without unit", ""},
    Named{dimension::kLength, "a length", "m"},
    Named{dimension::kTime, "a time", "s"},
    Named{dimension::kMass, "a mass", "kg"},
    Named{dimension::kAngle, "an angle", "deg"},
    Named{dimension::kFrame, "a number of frames", "frames"},
    Named{dimension::kSpeed, "a speed", "m/s"},
    Named{dimension::kAcceleration, "an acceleration", "m/s^2"},
    Named{dimension::kForce, "a force", "N"},
    Named{kEnergy, "an energy", "J"},
    Named{kPower, "a power", "W"},
    Named{kFrequency, "a frequency", "Hz"},
    Named{{.time = -1, .angle = 1}, "an angular velocity", "deg/s"},
};

}  // namespace

std::string to_text(Dimension dimension) {
    for (const Named& named : kNamed) {
        if (named.dimension == dimension) {
            return std::string(named.name);
        }
    }
    std::string out;
    const auto add = [&out](std::string_view unit, int exponent) {
        if (exponent == 0) {
            return;
        }
        out += out.empty() ? "" : "*";
        out += unit;
        if (exponent != 1) {
            out += "^" + std::to_string(exponent);
        }
    };
    add("m", dimension.length);
    add("kg", dimension.mass);
    add("s", dimension.time);
    add("rad", dimension.angle);
    add("frames", dimension.frame);
    return "a quantity in " + out;
}

std::string_view example_unit(Dimension dimension) {
    for (const Named& named : kNamed) {
        if (named.dimension == dimension) {
            return named.example;
        }
    }
    return "";
}

}  // namespace puppetri::lang
