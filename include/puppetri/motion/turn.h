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
    double no_step_rad = 0.0523598776;  // smaller angles (3 degrees) move no foot
};

// Turns to the heading, the shorter way round, and ends standing with the feet side by side. One
// pair of steps turns by up to 125 degrees; where there is time each pair turns by at most 100. The
// feet end around a point some centimetres aside (so that they do not step on each other); turning
// back cancels it.
// Events  "foot_off" and "foot_strike".
// Gives   feet in the air (or rolling) are put down first.
MovementPtr make_turn(const MotionContext& context, const TurnSpec& spec);

// How long a turn by this angle takes at ease.
double turn_duration_s(double angle_rad);

// The heading from the figure's place to a point.
double heading_to(const Controls& controls, Vec3 target_world);

}  // namespace puppetri::motion
