// SPDX-License-Identifier: MIT
// Turning on the spot: the feet step around, one after the other, and never slide.
#pragma once
#include "puppetri/motion/context.h"
#include "puppetri/motion/movement.h"

namespace puppetri::motion {

struct TurnSpec {
    double heading_rad = 0;   // of the world, to face in the end (math/rotation.h)
    double duration_s = 0.5;  // replaced by the context's prescribed duration
    LimbSet limbs = kAllLimbs;
};

// Turns to the heading, the shorter way round, and ends standing with the feet side by side around
// the same point on the floor. Angles above 90 degrees take two pairs of steps, above 180 cannot
// occur. Angles below 3 degrees move no foot. Events "foot_off" and "foot_strike".
MovementPtr make_turn(const MotionContext& context, const TurnSpec& spec);

// How long a turn by this angle takes at ease.
double turn_duration_s(double angle_rad);

// The heading from the figure's place to a point.
double heading_to(const Controls& controls, Vec3 target_world);

}  // namespace puppetri::motion
