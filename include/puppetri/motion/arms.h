// SPDX-License-Identifier: MIT
// Movements of the arms alone: what can be left to `arms:` of another movement. Hands move in chest
// space, so that they follow whatever the trunk does; all start from the state of the context in
// position and velocity.
#pragma once
#include "puppetri/motion/context.h"
#include "puppetri/motion/movement.h"

namespace puppetri::motion {

struct CarrySpec {
    double radius_m = 0.11;
    double duration_s = 1;  // what `takes auto` gets
    bool held =
        true;  // the hands have the ball now: they bring it along, as one rigid body with it
    bool stay = false;  // keep it where it is now (hold) instead of before the belly (carry)
};

// Carries a ball with both hands before the belly, elbows bent, alive with a slow sway of a few
// millimetres.
MovementPtr make_carry(const MotionContext& context, const CarrySpec& spec);

// The ball of a carrying figure in chest space, at rest.
Transform carried_ball_chest(const figure::Figure& figure, double radius_m);

// Both arms come to hang. Made for fast hands: each arm swings on about its shoulder and dies out,
// as after a throw.
MovementPtr make_relax(const MotionContext& context, double duration_s);

struct ReachSpec {
    Side side = Side::kRight;
    Vec3 target_world = {};  // for the palm; where the arm is too short it points there
    double duration_s = 0.6;
};
// One hand reaches; the other arm keeps its pose.
MovementPtr make_reach(const MotionContext& context, const ReachSpec& spec);

struct ArmSwingSpec {
    Side side = Side::kLeft;
    double angle_rad = 0.38;  // from hanging; positive is forward
    double duration_s = 0.8;
};
// Swings one arm, nearly straight, to that angle: the single-limb movement of a walk.
MovementPtr make_arm_swing(const MotionContext& context, const ArmSwingSpec& spec);

}  // namespace puppetri::motion
