// SPDX-License-Identifier: MIT
// The triangle of two bones: where the middle joint is when both ends are known. For the rotations
// of a limb's joints see limb_ik.h.
#pragma once
#include "puppetri/math/transform.h"

namespace puppetri::motion {

// Spaces  all in one space. `pole` is the side to which the middle joint bends; it need not be unit
//         or orthogonal.
// Needs   both bones longer than 1e-6 m.
// Gives   bend in [0, pi], 0 straight. Targets in the ring between |upper - lower| and `soft` of
//         the full reach are met exactly. Beyond that the reach is eased, so that the joint
//         straightens without a snap: its angle stays a smooth function of the distance, and
//         residual_m tells what is missing. A pole along the line between the ends, or a target on
//         the start, falls back on any bend direction.
// Cost    O(1), no allocation.
// Source  law of cosines; the easing is d' = s + (1 - s) (1 - exp(-(d - s)/(1 - s))), all in parts
//         of the full reach, as for "soft IK" (Nicholas, Softimage, 2005).
struct TwoBoneIk {
    Vec3 start, target, pole;
    double upper_m = 0, lower_m = 0;
    double soft = 0.995;  // in (0, 1]
};
struct TwoBoneResult {
    Vec3 middle, end;
    double bend_rad = 0;    // of the middle joint
    double residual_m = 0;  // distance from end to target
};
TwoBoneResult solve_two_bone(const TwoBoneIk& ik);

// The easing alone: how far a limb that can reach `full_m` goes for a target so far away.
double eased_reach_m(double wanted_m, double full_m, double soft);

}  // namespace puppetri::motion
