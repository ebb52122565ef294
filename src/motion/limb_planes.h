// SPDX-License-Identifier: MIT
// Where elbows and knees point when their swivel is 0; shared by solving controls and by reading
// them off a pose, so that both mean the same swivel.
#pragma once
#include "puppetri/math/rotation.h"

namespace puppetri::motion {

// Where the elbow hangs: at an arm that points along `base` (down, a little ahead and outward) it
// lies behind and outward. For other directions of the arm that is carried along by the shortest
// turn; the direction opposite to the base, where this is undefined, is behind the head, where no
// hand gets. `s` is 1 for the left arm, -1 for the right one; in the space of the clavicle.
inline Vec3 elbow_direction(double s, Vec3 arm_direction) {
    const Vec3 base = normalized(Vec3{0.30 * s, -0.88, 0.36});
    const Vec3 behind{0.35 * s, 0, -0.94};
    return rotate(shortest_arc(base, arm_direction, {0, 0, 1}), behind - base * dot(base, behind));
}

// The horizontal direction of a foot, in world space.
inline Vec3 knee_ahead_world(Quat foot_rotation_world, Quat pelvis_rotation_world) {
    const Vec3 ahead = rotate(foot_rotation_world, {0, 0, 1});
    return normalized(Vec3{ahead.x, 0, ahead.z}, rotate(pelvis_rotation_world, {0, 0, 1}));
}
// The knee points where the foot does, a little held back by the pelvis; in pelvis space.
inline Vec3 knee_direction(Quat pelvis_rotation_world, Vec3 ahead_world) {
    return rotate(conjugate(pelvis_rotation_world), ahead_world) * 0.6 + Vec3{0, 0, 0.4};
}

}  // namespace puppetri::motion
