// SPDX-License-Identifier: MIT
// The cast: who and what is on the stage before anything moves. Plain values, made by the scene or
// by hand.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "puppetri/base/diagnostic.h"
#include "puppetri/figure/character.h"
#include "puppetri/math/transform.h"
#include "puppetri/motion/bound_call.h"
#include "puppetri/stage/performance.h"

namespace puppetri::stage {

using motion::SetIndex;

// A character has a body of its own (Actor::character); humanoid ones do all that mannequins do.
enum class BodyKind : std::uint8_t { kMannequin, kStick, kCharacter };

struct Actor {
    std::string name = {};  // "ana"; unique among actors, props and sets
    BodyKind body = BodyKind::kMannequin;
    double height_m = 1.75;    // sole to crown, in [0.5, 3]
    Vec3 position_world = {};  // of the root, on the floor
    double heading_rad = 0;    // 0 faces +Z, pi/2 faces +X
    std::string palette = "teal";
    std::shared_ptr<const figure::Character> character = {};  // of kCharacter; never null there

    // Whether the movements of humanoids are for it (it has controls: motion/controls.h).
    bool humanoid() const {
        return body != BodyKind::kCharacter || (character && character->humanoid.has_value());
    }
};

struct Prop {
    std::string name = {};
    PropShape shape = PropShape::kSphere;
    Vec3 size_m{0.22, 0.22,
                0.22};  // across, up, along; diameters of spheres and cylinders in x and z
    double mass_kg = 0.4;
    ActorIndex held_by = {};   // in both hands at the start; none: lies at position_world
    Vec3 position_world = {};  // of its centre
    double heading_rad = 0;    // 0: its own +Z is the world's, pi/2: +X
    std::string palette = "red";
};

enum class SetKind : std::uint8_t { kFloor, kRoad };

// Something to stand on, at height 0. A road has a direction: `face(road)` turns there.
struct Set {
    std::string name = {};
    SetKind kind = SetKind::kFloor;
    double length_m = 20, width_m = 6;
    Vec3 position_world = {};  // of its middle
    double direction_rad = 0;  // as a heading: 0 runs along +Z
};

struct Cast {
    std::vector<Actor> actors = {};
    std::vector<Prop> props = {};
    std::vector<Set> sets = {};
};

// All that is wrong with it: sizes out of range, a name used twice, a holder that is not in the
// cast.
Diagnostics check(const Cast& cast);

}  // namespace puppetri::stage
