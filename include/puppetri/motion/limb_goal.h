// SPDX-License-Identifier: MIT
// What a limb is asked for. Points and directions are in the space of the first joint's parent (an
// arm: the clavicle; a leg: the pelvis) or, with the suffix _end, fixed in the hand: in the space
// of the limb's end joint.
#pragma once
#include <cstdint>

#include "puppetri/math/transform.h"

namespace puppetri::motion {

enum class LimbGoalKind : std::uint8_t {
    kPosition,   // the tip at a point; the end joint keeps `end_rotation`
    kPose,       // and the hand with a rotation
    kDirection,  // and an axis of the hand along a direction: a partial rotation, its roll free
    kAim,        // the ray from the tip along an axis of the hand passes through a point
    kPoint       // an axis of the hand is parallel to a direction: pointing at what is far away
};

struct LimbGoal {
    LimbGoalKind kind = LimbGoalKind::kPosition;
    Vec3 position_parent = {};
    Quat rotation_parent = {};       // kPose
    Vec3 direction_parent{0, 0, 1};  // kDirection, kPoint; need not be unit
    Vec3 axis_end{1, 0, 0};          // kDirection, kAim, kPoint; need not be unit
    Vec3 tip_end = {};               // what goes to the position; kAim: where the ray begins
    Quat end_rotation = {};          // kPosition, kAim, kPoint: of the end joint, kept
    // kAim: the hinge's angle; not `hinge_given`: as near to it as the ray can be made to hit.
    // kPoint: the hinge's angle.
    double hinge_rad = 0;
    bool hinge_given = true;
    // Swivel 0 has the limb's pole in this direction: for a hinge across the bones that is where
    // the elbow points. Along the limb's line it means nothing, and another direction is taken.
    Vec3 swivel_zero_parent{0, -1, 0};
    // The direction of the limb's line for a target on the first joint itself.
    Vec3 line_on_root{0, -1, 0};
};

}  // namespace puppetri::motion
