// SPDX-License-Identifier: MIT
// Plans of the pelvis: how far ahead (with little acceleration) and how high (so that the legs that
// stand are neither stretched nor bent too much).
#pragma once
#include <vector>

#include "puppetri/math/quintic.h"

namespace puppetri::motion {

// From one position and velocity to another in duration_s. Among all ways the one whose largest
// acceleration is small and which changes it gently: minimizes the sum of a^6 over evenly spaced
// knots, between them the acceleration is linear. (Least squares of a alone gives the cubic Hermite
// curve, whose peak is a third higher.) Cost    a few microseconds.
Curve1 plan_travel(Motion1 from, Motion1 to, double duration_s);

// How far one gets who moves at `speed` (negative: the other way), may accelerate by acceleration >
// 0 either way, and has to rest after duration_s.
double longest_way_to_rest(double speed, double acceleration, double duration_s);

// What a height has to keep to at one instant.
struct HeightBand {
    double t_s = 0;
    double lowest = 0, highest = 0;
    double limit = 1e9;   // above it a foot would slip
    double wanted = 0.5;  // where in the band, 0 lowest, 1 highest
};
struct HeightPlan {
    Motion1 from;  // at 0
    double duration_s = 0;
    bool end_is_free = false;       // otherwise `to` is met
    Motion1 to;                     // velocity and acceleration at the end count in any case
    std::vector<HeightBand> bands;  // may reach past the end: the curve goes on there as it is
};
// Who is found lower than `lowest_now`, the lower end of the band where it stands, comes up within
// the plan's duration instead of at once: the bands begin where it is. Nothing for less than 5 mm.
void rise_slowly(HeightPlan& plan, double lowest_now);
// A smooth curve through the bands, as far as there is one: otherwise the sum of squares by which
// it leaves them is least, leaving upwards (a leg too short) counting much more than downwards.
Curve1 plan_height(const HeightPlan& plan);

}  // namespace puppetri::motion
