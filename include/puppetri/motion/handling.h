// SPDX-License-Identifier: MIT
// Taking a ball that rests: off the floor, or out of somebody else's hands. Both hands come to it,
// hold it from one instant on, and bring it before the belly.
#pragma once
#include "puppetri/motion/context.h"
#include "puppetri/motion/grip.h"
#include "puppetri/motion/movement.h"

namespace puppetri::motion {

struct PickUpSpec {
    Grip grip = {};
    Vec3 ball_world = {};  // its centre
    double duration_s = 2.4;
};
struct PickUp {
    MovementPtr movement;   // all limbs; event "grasp"
    SimTime grasps_after;   // from then on the hands hold it
    bool reaches = true;    // false: the ball is too far off, the hands close on air
    bool too_flat = false;  // a box so near to the floor that palms beside it would go into it
};
// Bends knees and trunk as far as the ball is low, takes it, and comes up with it; the feet stay.
PickUp make_pick_up(const MotionContext& context, const PickUpSpec& spec);

// Where two who stand before each other hand over a ball: between them, at the height of the belly.
struct HandOver {
    Vec3 meeting_world = {};
    bool near = true;  // false: too far apart, or too near, or not before each other
};
HandOver meeting_of(const figure::Figure& giver, const Controls& from, const figure::Figure& taker,
                    const Controls& to);

inline constexpr double kHandOver_s = 1.0;  // from its start until the taker has the ball

struct GiveSpec {
    Grip grip = {};
    Vec3 meeting_world = {};
    double duration_s = 1.9;
};
// Holds a ball out, lets it go when the other has it, and lowers the arms. All limbs. Event
// "hand_over" after kHandOver_s.
MovementPtr make_give(const MotionContext& context, const GiveSpec& spec);

struct TakeSpec {
    Grip grip = {};
    Vec3 ball_world = {};
    double grasps_s = kHandOver_s;  // when the hands have closed on it
    double roll_rad = 0;            // of the hands about the ball, the left one up: out of the way
                                    // of hands that hold it already
    double brings_s = 1.0;          // then it is before the belly
};
// Both arms alone, whatever trunk and legs do.
MovementPtr make_take(const MotionContext& context, const TakeSpec& spec);

}  // namespace puppetri::motion
