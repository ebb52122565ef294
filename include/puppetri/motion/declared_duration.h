// SPDX-License-Identifier: MIT
// How long a movement can take when its place says `takes auto`: what it declares before any stage
// exists. Proofs take this interval for every duration that only a preparation knows; the stage
// checks each preparation against it, so that what was assumed is what is performed.
#pragma once
#include "puppetri/base/time.h"
#include "puppetri/motion/bound_call.h"

namespace puppetri::motion {

// Both ends included; whole milliseconds. A movement that always takes the same time has
// shortest == longest.
struct DurationRange {
    SimTime shortest = {}, longest = {};
    constexpr bool has(SimTime duration) const {
        return shortest <= duration && duration <= longest;
    }
    constexpr bool operator==(const DurationRange&) const = default;
};

// The interval for this very call: narrower than its signature's row where the arguments decide
// (`idle(lasting: 2 s)`, `walk(steps: 3)`). An argument that stands in the token widens it to all
// that the argument may be. Places with a duration of their own do not ask.
// Needs   a call that fits its signature, of an actor, a limb or a prop.
// Cost    O(parameters), no allocation.
DurationRange declared_duration(const BoundCall& call);

}  // namespace puppetri::motion
