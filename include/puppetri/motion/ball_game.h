// SPDX-License-Identifier: MIT
// Throwing and catching with both hands. The thrower swings the ball underarm: back and down with
// bent knees, forward and up about the shoulders as legs and trunk stretch. At the release the ball
// has exactly the velocity that its flight needs, so that the flight begins where and as the hands
// let go. The catcher waits with open hands around the point where the ball will come, has them on
// the ball at the instant it arrives, and gives way.
//
// All drive the whole figure: the legs stay planted (make_idle) or turn (make_turn), pelvis and
// trunk add to those, and the hands are computed last, from where the chest then is.
#pragma once
#include "puppetri/motion/context.h"
#include "puppetri/motion/flight.h"
#include "puppetri/motion/grip.h"
#include "puppetri/motion/movement.h"

namespace puppetri::motion {

struct ThrowSpec {
    Grip grip = {};
    Vec3 target_world = {};    // the ball's centre at the catch
    double duration_s = 0.85;  // until the release, which ends the movement
    bool held = true;          // both hands are on the ball; otherwise they throw air
    double flight_s = 0;       // of the flight; 0: sqrt(2 d / g)
};
// Gives   event "release" at its end. After it the arms swing on and come to hang, the trunk
// straightens.
MovementPtr make_throw(const MotionContext& context, const ThrowSpec& spec);

// By how much the feet point past the target, to its left positive; a throw goes at most
// kMostAside_rad aside.
double aside_rad(const figure::Figure& figure, const Controls& controls, Vec3 target_world);
inline constexpr double kMostAside_rad = 0.45;

struct ReadySpec {
    Grip grip = {};
    double heading_rad = 0;   // from where the ball will come
    double duration_s = 0.6;  // a prescribed duration in the context replaces it
};
struct Ready {
    MovementPtr movement = {};
    Vec3 catches_at_world = {};
};
// Turns, bends the knees, opens the hands.
Ready make_ready(const MotionContext& context, const ReadySpec& spec);

struct ReceiveSpec {
    MovementPtr base = {};  // goes on in legs, pelvis and trunk; drives all limbs
    double base_age_s = 0;  // at the context's start
    Flight flight = {};
};
// The hands come together around the point where the flight ends, and move with the ball when it
// gets there.
MovementPtr make_receive(const MotionContext& context, const ReceiveSpec& spec);

struct CatchSpec {
    Grip grip = {};
    double duration_s = 0.7;
    bool held = true;  // both hands are on the ball; otherwise they close on air
};
// Gives   event "catch" at its start. Hands, knees and trunk give way, then bring the ball to the
// belly.
MovementPtr make_catch(const MotionContext& context, const CatchSpec& spec);

// Where a figure with these controls catches a ball: before its chest.
Vec3 catching_point(const figure::Figure& figure, const Controls& controls);

}  // namespace puppetri::motion
