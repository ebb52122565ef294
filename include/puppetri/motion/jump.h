// SPDX-License-Identifier: MIT
// A jump on the spot with both feet.
#pragma once
#include "puppetri/motion/context.h"
#include "puppetri/motion/movement.h"

namespace puppetri::motion {

struct JumpSpec {
    double height_m = 0.2;  // of the flight of the hips, 0.02 to 0.6
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
