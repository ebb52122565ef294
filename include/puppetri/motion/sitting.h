// SPDX-License-Identifier: MIT
// Sitting down and standing up: the pelvis goes to a seat behind the feet and comes back over them;
// the feet stay planted.
#pragma once
#include "puppetri/motion/context.h"
#include "puppetri/motion/movement.h"

namespace puppetri::motion {

struct SitSpec {
    double seat_height_m = 0.45;  // of the seat's surface above the floor; taken into what legs can
    double duration_s = 1.6;
};
// The hips on a seat of that height, behind the feet by what thighs and shanks leave; at the end
// the trunk is upright and the hands lie on the thighs. Who sits already stays. Beyond its duration
// it rests seated, however long its place lasts.
// Source  the lean of the trunk while the hips go down, about 35 degrees at its most: Kralj, Jaeger
//         and Munih, "Analysis of standing up and sitting down in humans", J. Biomech. 23 (1990).
MovementPtr make_sit(const MotionContext& context, const SitSpec& spec);

// Where the joint hips is over a seat, in the space of the feet: midway between the ankles on the
// floor, heading with the pelvis.
Vec3 seated_hips(const figure::Figure& figure, double seat_height_m);

// Whether these controls are those of one who rests on a seat: the hips low, behind the feet, and
// still.
bool sits(const MotionContext& context);

// The arm of a seated figure: the hand on its thigh.
ArmControl arm_on_thigh(const figure::Figure& figure, Side side);

struct StandUpSpec {
    double duration_s = 1.5;
};
// From a seat, or from any crouch, to standing over the feet, arms hanging.
MovementPtr make_stand_up(const MotionContext& context, const StandUpSpec& spec);

}  // namespace puppetri::motion
