// SPDX-License-Identifier: MIT
// Embracing somebody who stands close before one.
#pragma once
#include "puppetri/motion/context.h"
#include "puppetri/motion/movement.h"

namespace puppetri::motion {

inline constexpr double kHug_s = 3.2;

struct HugSpec {
    const figure::Figure& other;  // for the call only
    const Controls& other_now;
    double duration_s = kHug_s;
};
// Both arms open, go around the other's chest, rest on its back, and open again; the hands lie flat
// on it and never pass through it. The left arm goes below, the right one above, so that two who
// embrace each other do not meet with their arms. All limbs; the feet stay.
struct Hug {
    MovementPtr movement;
    bool near = true;  // false: farther or nearer than arms go around, or not before it
};
Hug make_hug(const MotionContext& context, const HugSpec& spec);

// How far apart two stand who embrace each other, between their hips, for figures of that height.
double hug_distance_m(double height_m);

}  // namespace puppetri::motion
