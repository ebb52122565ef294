// SPDX-License-Identifier: MIT
// One hand takes a thing that lies somewhere, and lays it down again: a fork, a cup, a box. From
// the grasp on the thing is one rigid body with that hand, whatever arm and trunk do; the other
// hand is free.
#pragma once
#include "puppetri/motion/context.h"
#include "puppetri/motion/movement.h"

namespace puppetri::motion {

struct OneHandMove {
    MovementPtr movement;  // that arm alone
    SimTime touches;       // after its start: when the hand closes on the thing, or lets it go
    // What the arm leaves of the way and of the turn there.
    double residual_m = 0, residual_rad = 0;
};

// How a hand holds a thing of that size when it is given into it: below the palm, its own +Z along
// the fingers. The hand's joint from the thing's centre.
Transform thing_in_hand(const figure::Figure& figure, Side side, Vec3 size_m);

struct TakeInHandSpec {
    Side side = Side::kRight;
    Transform world_from_thing;  // its centre; +Y up
    Vec3 size_m{0.1, 0.1, 0.1};
    double duration_s = 1.2;
};
// The palm comes down on the thing, along its longer side if it has one, closes, lifts it, and
// brings it before the body. Event "grasp".
OneHandMove make_take_in_hand(const MotionContext& context, const TakeInHandSpec& spec);

struct LayDownSpec {
    Side side = Side::kRight;
    Transform hand_from_thing;   // how the hand holds it
    Transform world_from_thing;  // where its centre shall be
    double duration_s = 1.2;
};
// Brings it there, opens, and draws the empty hand back. Event "release".
OneHandMove make_lay_down(const MotionContext& context, const LayDownSpec& spec);

}  // namespace puppetri::motion
