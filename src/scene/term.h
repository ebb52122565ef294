// SPDX-License-Identifier: MIT
// Terms: what an expression or a path of a scene file stands for. A constant (an exact number with
// its dimension, a word, a point), a thing of the scene (an actor, a place, an instance of a net),
// or something that only the running net knows (an expression over data and counts, a formula over
// places). Everything that a file says goes through here.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "puppetri/base/expr.h"
#include "puppetri/lang/units.h"
#include "puppetri/motion/bound_call.h"
#include "puppetri/net/formula.h"
#include "puppetri/stage/sensors.h"

namespace puppetri::scene {

// exact * pi^pi_power, as long as it is known exactly; `value` always. In SI units and radians,
// frames turned into seconds.
struct Number {
    Rational exact;
    int pi_power = 0;
    bool is_exact = true;
    double value = 0;
    lang::Dimension dimension;

    static Number whole(std::int64_t n) {
        return {.exact = {n, 1}, .value = static_cast<double>(n)};
    }
    bool plain() const { return dimension == lang::dimension::kNone; }
    // An integer without unit.
    bool is_integer() const { return is_exact && pi_power == 0 && plain() && exact.whole(); }
};

struct Nothing {};  // something was wrong and has been told; it agrees with everything
struct Text {
    std::string text;
};
// A name that is no thing of the scene: `left`, `air`. Whoever takes words gives it meaning.
struct Word {
    std::string text;
};
struct PointTerm {
    std::array<double, 3> at{};
    lang::Dimension dimension;
};
struct ActorTerm {
    motion::ActorIndex actor;
};
struct LimbTerm {
    motion::ActorIndex actor;
    motion::Limb limb;
};
struct PropTerm {
    motion::PropIndex prop;
};
struct SetTerm {
    motion::SetIndex set;
};
struct HolderOfTerm {  // `ball.holder`
    motion::PropIndex prop;
};
struct HolderTerm {  // `ana.hands`
    std::string text;
};
struct InstanceTerm {
    std::uint32_t instance = 0;
};
struct PlaceTerm {
    net::PlaceIndex place;
};
struct TransitionTerm {
    net::TransitionIndex transition;
};
struct EventTerm {
    net::EventIndex event;
};
struct DatumTerm {
    net::DatumIndex datum;
};
struct ChannelTerm {
    std::uint32_t channel = 0;
};
struct EnumTerm {  // a value of an enumeration
    std::uint32_t enumeration = 0;
    std::int64_t ordinal = 0;
};
struct EnumerationTerm {  // an enumeration itself
    std::uint32_t enumeration = 0;
};
// What a sensor asks the figures, before it is compared with a value: `height(ana.head)`.
struct QuantityTerm {
    stage::Sensor sensor;
    lang::Dimension dimension;
    std::string text;  // as written
};
struct MovementTerm {  // a movement as value; the subject is left open
    motion::BoundCall call;
};

using Term = std::variant<Nothing, Number, bool, Text, Word, PointTerm, ActorTerm, LimbTerm,
                          PropTerm, SetTerm, HolderOfTerm, HolderTerm, InstanceTerm, PlaceTerm,
                          TransitionTerm, EventTerm, DatumTerm, ChannelTerm, EnumTerm,
                          EnumerationTerm, MovementTerm, QuantityTerm, Expr, net::Formula>;

inline bool is_nothing(const Term& term) { return std::holds_alternative<Nothing>(term); }

// What messages call it: "a time", "an actor", "a place".
std::string describe(const Term& term);

// Exact as long as it fits, else in doubles. Dimensions are checked by the caller for add, subtract
// and compare.
Number add(const Number& a, const Number& b);
Number subtract(const Number& a, const Number& b);
Number multiply(const Number& a, const Number& b);
Number divide(const Number& a, const Number& b);  // needs b.value != 0
Number power(const Number& a, int exponent);      // needs a.value != 0 or exponent >= 0
Number negate(const Number& a);
Number from_double(double value, lang::Dimension dimension = {});
int compare(const Number& a, const Number& b);  // -1, 0, 1

}  // namespace puppetri::scene
