// SPDX-License-Identifier: MIT
// Lines of a block `equations`: what its author wrote, sorted by kind, nothing looked up. The block
// lowers to a net of its events and sensors; the scene compiles the rest, which is coupled to the
// net and no part of it (docs/notations/equations.md).
#pragma once
#include <optional>
#include <vector>

#include "puppetri/notation/notation.h"

namespace puppetri::notation {

struct EquationLines {
    // `h starts at 2 m`
    struct Variable {
        lang::Name name;
        lang::Expr starts;
        lang::Span span;
    };
    // `h.rate = v`, `h.before = 1 m`, `force = -k*x`
    struct Formula {
        lang::Name name;
        lang::Expr value;
        lang::Span span;
    };
    // `x.next = 2*x every 0.1 s`
    struct Next {
        lang::Name name;
        lang::Expr value, every;
        lang::Span span;
    };
    enum class Direction : std::uint8_t { kFalls, kRises, kPasses };
    // `event impact "it hits the floor" when h falls through 0 m`
    struct Event {
        lang::Name name;
        lang::Caption caption;
        lang::Expr quantity, threshold;
        Direction direction = Direction::kFalls;
        lang::Span span;
    };
    // `sensor high when h > 1 m`
    struct Sensor {
        lang::Name name;
        lang::Caption caption;
        lang::Expr greater, less;  // true where the first is greater than the second
        lang::Span span;
    };
    // `on hit set v := -0.9*v`
    struct Reset {
        lang::Path transition;
        lang::Name name;
        lang::Expr value;
        lang::Span span;
    };
    // `ball.position = (0 m, h, 0 m)`, `me.right_shoulder.flex = 20 deg*sin(phase)`
    struct Driven {
        lang::Path what;
        lang::Expr value;
        lang::Span span;
    };

    std::vector<Variable> variables;
    std::vector<Formula> rates, befores, locals;
    std::vector<Next> nexts;
    std::vector<Event> events;
    std::vector<Sensor> sensors;
    std::vector<Reset> resets;
    std::vector<Driven> driven;
    std::vector<lang::Path> enabled_by;  // `while flies`, `while up or down`
    bool stiff = false;                  // `solver stiff`
    bool by_sundials = false;            // `solver stiff by sundials`
    lang::Span solver_span;
    lang::Expr baked;         // `baked "reaction.courses"`
    lang::Expr tolerance;     // `tolerance 1e-6`
    lang::Expr longest_step;  // `steps at most 10 ms`
};

// The events that a sensor is set by: `high_begins`, `high_ends`.
inline constexpr std::string_view kSensorBegins = "_begins", kSensorEnds = "_ends";

// Reads the lines, telling what has no known form.
EquationLines read_equations(const lang::Block& block, const lang::File& file, Lowered& out);

}  // namespace puppetri::notation
