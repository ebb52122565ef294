// SPDX-License-Identifier: MIT
// What a limb's solvers know beforehand: the triangle of the limb as a function of its bend, and
// the limits of its ball joints as coefficients. Made by LimbIk; batches and single limbs read the
// same numbers, so that they get the same bits.
#pragma once
#include "puppetri/figure/limits.h"
#include "puppetri/math/circle.h"

namespace puppetri::motion {

// Bend d is the hinge's angle counted from where the limb reaches farthest. The end joint, seen
// from the first joint in its own space, is at line + cos d along + sin d across, at a squared
// distance between least2 (d = pi) and most2 (d = 0).
struct LimbTriangle {
    Vec3 line, along, across;
    Quat hinge_straight, hinge_turn;  // hinge = cos(d / 2) hinge_straight + sin(d / 2) hinge_turn
    Vec3 hinge_axis_start;            // unit, in the space of the first joint
    double least2 = 0, most2 = 0;
    double per_span = 0;                 // 1 / (most2 - least2)
    double nearest2 = 0, farthest2 = 0;  // within the hinge's range
    double sign = 1;                     // of the bend that reaches every distance within the range
    CirclePoint straight_from_middle;    // the angle of d = 0, counted from the middle of the range
    double cos_half_range = -1;          // below -1: every angle
};

// A ball joint's cone: the twist and where the bone points, as figure/limits.h defines them.
struct ConeTable {
    Quat centre_from_parent;
    Vec3 side, other, axis;                // unit, of the joint
    CirclePoint half_lo, half_hi;          // halves of the ends of the twist's range
    double per_side2 = 0, per_other2 = 0;  // 1 / sin^2 of half the swing
    double cos_swing = -1;                 // of the wider swing
    bool swing_limited = false, twist_limited = false, round = false;
};

struct LimbTables {
    LimbTriangle triangle;
    ConeTable start, end;
};

}  // namespace puppetri::motion
