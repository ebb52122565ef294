// SPDX-License-Identifier: MIT
// Movements of the arms alone: what can be left to `arms:` of another movement. Hands move in chest
// space, so that they follow whatever the trunk does; all start from the state of the context in
// position and velocity.
#pragma once
#include <optional>

#include "puppetri/motion/context.h"
#include "puppetri/motion/grip.h"
#include "puppetri/motion/movement.h"

namespace puppetri::motion {

struct CarrySpec {
    Grip grip = {};
    double duration_s = 1;  // what `takes auto` gets
    bool held =
        true;  // the hands have the ball now: they bring it along, as one rigid body with it
    bool stay = false;  // keep it where it is now (hold) instead of before the belly (carry)
};

// Carries a ball with both hands before the belly, elbows bent, alive with a slow sway of a few
// millimetres.
MovementPtr make_carry(const MotionContext& context, const CarrySpec& spec);

// The ball of a carrying figure in chest space, at rest.
Transform carried_ball_chest(const figure::Figure& figure, const Grip& grip);

// Both arms come to hang. Made for fast hands: each arm swings on about its shoulder and dies out,
// as after a throw.
MovementPtr make_relax(const MotionContext& context, double duration_s);

struct ReachSpec {
    Side side = Side::kRight;
    Vec3 target_world = {};  // for the palm; where the arm is too short it points there
    // What the palm faces and what the fingers point to. Without either the hand goes on along the
    // arm. Both: the palm comes first, the fingers as far as they are across it.
    std::optional<Vec3> palm_to_world = {}, fingers_to_world = {};
    std::optional<double> elbow_rad = {};  // ArmControl::swivel_rad; without: what is nearest
    double duration_s = 0.6;
};
struct ArmMovement {
    MovementPtr movement;
    // What the arm leaves of the way and of the turn that were asked for.
    double residual_m = 0, residual_rad = 0;
};
// One hand reaches; the other arm keeps its pose.
ArmMovement make_reach(const MotionContext& context, const ReachSpec& spec);

struct PointSpec {
    Side side = Side::kRight;
    Vec3 target_world = {};
    // The line of the hand passes through the target with this bend of the elbow, or the nearest
    // with which it can.
    double flexion_rad = 0.12;
    std::optional<double> elbow_rad = {};
    double grip = 0;  // of the fingers, 0 straight
    double duration_s = 0.6;
};
// One hand points at something, arm almost straight, or aims at it with a bent one.
ArmMovement make_point(const MotionContext& context, const PointSpec& spec);

struct ArmSwingSpec {
    Side side = Side::kLeft;
    double angle_rad = 0.38;  // from hanging; positive is forward
    double duration_s = 0.8;
};
// Swings one arm, nearly straight, to that angle: the single-limb movement of a walk.
MovementPtr make_arm_swing(const MotionContext& context, const ArmSwingSpec& spec);

}  // namespace puppetri::motion
