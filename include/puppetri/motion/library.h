// SPDX-License-Identifier: MIT
// The library of movements: every name that `does` may call, with a typed signature from which
// errors, completion and the reference manual come; prepare.h turns a bound call into a Movement.
// To add a movement: write its make_NAME in src/motion, add its row to src/motion/library_table.cpp
// and its line to src/motion/prepare.cpp.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "puppetri/motion/bound_call.h"
#include "puppetri/motion/controls.h"

namespace puppetri::motion {

enum class ParameterType : std::uint8_t {
    kActor,
    kProp,
    kSet,
    kInt,
    kReal,
    kLength,
    kTime,
    kAngle,
    kBool,
    kSide,
    kPoint,
    kMovement
};

// "actor", "prop", ... as the language and its messages name it.
std::string_view name_of(ParameterType type);

// The types that a parameter takes, as bits; `face` takes an actor, a prop, a set, a point or an
// angle. Never two of int, real, length, time and angle, so that a number has one meaning.
struct TypeSet {
    std::uint16_t bits = 0;
    constexpr bool has(ParameterType type) const { return (bits >> static_cast<int>(type)) & 1; }
    constexpr TypeSet with(ParameterType type) const {
        return {static_cast<std::uint16_t>(bits | (1 << static_cast<int>(type)))};
    }
};

struct Parameter {
    std::string_view name = {};  // arguments may be given by position in this order, or by name
    TypeSet types = {};
    // As the scene would write it ("0.6 m", "left", "no"). Empty: the argument must be given,
    // unless it is `optional`: then the movement chooses (arms: its own).
    std::string_view default_text = {};
    double default_value = 0;  // the same in metres, seconds, radians; a side is 0 left, 1 right
    bool optional = false;
    std::string_view doc = {};
};

struct MovementSignature {
    std::string_view name = {};
    SubjectKind subject = SubjectKind::kActor;
    LimbSet on_limbs = {};  // kLimb: the limbs that can be the subject
    std::span<const Parameter> parameters = {};
    LimbSet limbs = {};  // what it drives; kLimb: beyond the subject itself
    // The parameter that leaves both arms to another movement; empty: none.
    std::string_view arms_parameter = {};
    // May stand as a movement argument, since it drives the arms alone (carry, hold, swing, ...).
    bool as_argument = false;
    // Every `takes auto` lies between these, whatever the arguments: an assumption of proofs, kept
    // by prepare. declared_duration.h has the interval of one call.
    SimTime shortest = {}, longest = {};
    std::string_view doc = {};  // one line
};

// All movements, ordered by name, then subject.
std::span<const MovementSignature> movement_library();

// The movement of that name for that kind of subject, or null. One name may exist for several kinds
// of subject.
const MovementSignature* find_movement(std::string_view name, SubjectKind subject);

// The names of limbs in the language: "left_leg"; none for another name.
std::optional<Limb> limb_named(std::string_view name);
std::string_view name_of(Limb limb);

}  // namespace puppetri::motion
