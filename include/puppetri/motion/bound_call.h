// SPDX-License-Identifier: MIT
// A call of a movement as the scene wrote it, bound to its cast: `me.half_step(side: right, arms:
// carry(ball))` with `me` an index and every expression a number in SI units. What `does` becomes;
// the library (library.h) prepares it.
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "puppetri/base/index.h"
#include "puppetri/base/time.h"
#include "puppetri/motion/controls.h"

namespace puppetri::motion {

using ActorIndex = Index<struct ActorTag>;  // into Cast::actors
using PropIndex = Index<struct PropTag>;    // into Cast::props
using SetIndex = Index<struct SetTag>;      // into Cast::sets

// The value stands in the token: attribute number `index` of the place's declaration, known when
// the token arrives. Only for parameters of type actor, prop, set, int and bool (a bool is 0 or 1,
// the others their index or value).
struct TokenAttribute {
    std::uint32_t index = 0;
    bool operator==(const TokenAttribute&) const = default;
};

// A movement as argument (`arms: carry(ball)`): number `index` of BoundCall::nested. It moves the
// same actor.
struct NestedCall {
    std::uint32_t index = 0;
    bool operator==(const NestedCall&) const = default;
};

// A double is metres, radians or a plain number, as the parameter's type says.
using ArgumentValue = std::variant<ActorIndex, PropIndex, SetIndex, std::int64_t, double, SimTime,
                                   bool, Side, Vec3, NestedCall, TokenAttribute>;

struct Argument {
    std::string
        parameter;  // full name as in the signature, also where the scene gave it by position
    ArgumentValue value = {};
};

// Who moves: an actor (`ana.step`), one limb of an actor (`ana.left_leg.transfer`), or a prop
// (`ball.fly`).
enum class SubjectKind : std::uint8_t { kActor, kLimb, kProp };

struct Subject {
    SubjectKind kind = SubjectKind::kActor;
    ActorIndex actor = {};      // kActor, kLimb
    Limb limb = Limb::kPelvis;  // kLimb
    PropIndex prop = {};        // kProp
};

class OwnMovement;  // own_movement.h

struct BoundCall {
    std::string movement = {};  // "half_step"
    Subject subject = {};
    std::vector<Argument>
        arguments;  // any order, each parameter at most once; what is missing takes its default
    std::vector<BoundCall>
        nested;  // same subject; only their movement, arguments, nested and own are read
    // The definition, of a movement that is not of the library.
    std::shared_ptr<const OwnMovement> own = {};

    // None when the call does not give it.
    const ArgumentValue* find(const char* parameter) const {
        for (const Argument& a : arguments) {
            if (a.parameter == parameter) {
                return &a.value;
            }
        }
        return nullptr;
    }
};

}  // namespace puppetri::motion
