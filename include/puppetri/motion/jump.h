// SPDX-License-Identifier: MIT
// A jump on the spot with both feet.
#pragma once
#include "puppetri/motion/context.h"
#include "puppetri/motion/movement.h"

namespace puppetri::motion {

// People who do not train jump 30 to 40 cm from the stand, trained ones 50. Higher ones would need
// feet that push off and land faster than ankles turn.
inline constexpr double kHighestJump_m = 0.5;

struct JumpSpec {
    double height_m = 0.2;  // of the flight of the hips, 0.02 to kHighestJump_m
};

// Of the whole jump, and the part of it in the air: 2 sqrt(2 height / g).
double jump_duration_s(double height_m);
double jump_flight_s(double height_m);

// Bends the knees, jumps, and lands where it stood. While both feet are off the floor the hips fly
// as a thrown stone does. A prescribed duration changes the time for bending and rising, never the
// flight.
// Events  "foot_off" and "foot_strike" of both feet.
MovementPtr make_jump(const MotionContext& context, const JumpSpec& spec);

}  // namespace puppetri::motion
