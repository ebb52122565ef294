// SPDX-License-Identifier: MIT
// Analytic inverse kinematics of a limb with seven degrees of freedom: a ball joint, a hinge, a
// ball joint. The goal fixes six; the seventh is the swivel of the elbow about the line from
// shoulder to wrist.
#pragma once
#include "puppetri/motion/two_bone_ik.h"

namespace puppetri::motion {

// Spaces  start, goal and reference direction in the space of the limb's parent (the clavicle's for
//         an arm). At the zero pose the limb lies straight along `axis` (unit) with all rotations
//         the identity and bends about `hinge` (unit, orthogonal to axis) with positive angles.
// Gives   rotations relative to their parents. The hinge angle is >= 0. The circle of the middle
//         joint starts at the projection of `swivel_zero`; swivel turns about the axis from start
//         to goal.
// Cost    O(1), no allocation.
// Source  Tolani, Goswami and Badler, "Real-time inverse kinematics techniques for anthropomorphic
//         limbs", Graphical Models 62 (2000) 353-388, sections 2 and 3.
struct LimbIk {
    Vec3 start;
    Transform goal;  // of the end joint
    Vec3 axis, hinge;
    Vec3 swivel_zero;
    double swivel_rad = 0;
    double upper_m = 0, lower_m = 0;
    double soft = 0.995;
};
struct LimbResult {
    Quat start_rotation, middle_rotation, end_rotation;
    double residual_m = 0;
};
LimbResult solve_limb(const LimbIk& ik);

}  // namespace puppetri::motion
