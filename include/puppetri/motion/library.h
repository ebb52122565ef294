// SPDX-License-Identifier: MIT
// The library of movements: every name that `does` may call, with a typed signature from which
// errors, completion and the reference manual come, and `prepare`, which turns a bound call into a
// Movement. To add a movement: write its prepare_NAME in src/motion, add its row to
// src/motion/library_table.cpp and its line to prepare.cpp.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "puppetri/base/diagnostic.h"
#include "puppetri/motion/bound_call.h"
#include "puppetri/motion/movement.h"

namespace puppetri::motion {

struct MotionContext;  // context.h: the figure, its controls at the start, partners and props

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
    // As the scene would write it ("0.6 m", "left"); empty: the argument must be given, unless
    // `optional`.
    std::string_view default_text = {};
    bool optional =
        false;  // may be missing without a default: the movement then chooses (arms: its own)
    std::string_view doc = {};
};

struct MovementSignature {
    std::string_view name = {};
    SubjectKind subject = SubjectKind::kActor;
    LimbSet on_limbs = {};  // kLimb: the limbs that can be the subject ("left_leg", "right_leg")
    std::span<const Parameter> parameters = {};
    LimbSet limbs = {};  // what it drives; for kLimb: beyond the subject itself (the support leg
                         // drives the pelvis)
    std::string_view
        arms_parameter;  // the parameter that leaves both arms to another movement; empty: none
    bool as_argument =
        false;  // may stand as a movement argument: it drives arms alone (carry, hold, swing, ...)
    SimTime shortest = {},
            longest = {};       // every `takes auto` lies between (an assumption of proofs)
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

// Prepares a movement of an actor or of one of its limbs.
// Needs   the call fits its signature (scene has checked names and types); token attributes already
// replaced. Gives   a movement that starts at context.start from the pose in the context. With a
// fitted duration in the context
//         that is its duration; otherwise its own, a whole millisecond rounded up, inside
//         [shortest, longest].
// Fails   with all reasons when this figure cannot do it now: "not-held" (throwing a ball that
// another has), ...
Checked<MovementPtr> prepare(const BoundCall& call, const MotionContext& context);

}  // namespace puppetri::motion
