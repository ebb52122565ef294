// SPDX-License-Identifier: MIT
// Arms that go to a goal of inverse kinematics: reaching, pointing, aiming. The goal is solved
// once, in chest space, when the movement is prepared; the way there is inertial.
#include "arm_state.h"
#include "puppetri/base/elementary.h"
#include "puppetri/motion/arm_goal.h"
#include "puppetri/motion/arms.h"
#include "puppetri/motion/solve_controls.h"

namespace puppetri::motion {
namespace {

class ArmTo final : public Movement {
 public:
    ArmTo(const MotionContext& chest_context, Side side, const ArmControl& own, double duration_s)
        : i_(index_of(side)), own_(own) {
        limbs = limb_set(arm_of(side));
        duration = duration_of(chest_context, duration_s);
        offset_ =
            InertialArm(chest_context.figure, static_cast<Side>(i_), chest_context.now.arms[i_],
                        chest_context.rate.arms[i_], own_, {}, duration.seconds());
    }
    void sample(double t_s, Controls& out) const override {
        out.arms[i_] = own_;
        offset_.apply(t_s, out.arms[i_]);
    }

 private:
    int i_;
    ArmControl own_;
    InertialArm offset_;
};

double sign(Side side) { return side == Side::kLeft ? 1 : -1; }

Quat chest_from_forearm(const figure::Figure& figure, Side side, const figure::Pose& pose) {
    const figure::Arm& arm = figure.arms[index_of(side)];
    Quat q;
    for (const figure::JointIndex joint : {arm.clavicle, arm.shoulder, arm.elbow}) {
        q = q * pose.parent_from_joint[joint.value].rotation;
    }
    return q;
}

// Where an arm goes at all, roughly: within that angle about a direction ahead and outward. What
// lies behind it is taken to the rim of that cone.
constexpr double kGoes_rad = radians(105);

// Without a wish for the hand: along the line from the shoulder. `aside_rad`: how far off the line
// to the target that is.
ArmControl along_the_line(const figure::Figure& figure, const Controls& now, Side side,
                          Vec3 target_chest, double elbow_rad, double& aside_rad) {
    const figure::Arm& arm = figure.arms[index_of(side)];
    const Vec3 shoulder = shoulder_chest(figure, side), way = target_chest - shoulder;
    const Vec3 centre = normalized(Vec3{0.5 * sign(side), -0.2, 0.85});
    const Vec3 wish = normalized(way, {0, 0, 1});
    const Quat away = shortest_arc(centre, wish, {0, 1, 0});
    const double angle = angle_between(away, {});
    aside_rad = std::fmax(0, angle - kGoes_rad);
    const Vec3 ahead =
        aside_rad > 0
            ? rotate(from_rotation_vector(to_rotation_vector(away) * (kGoes_rad / angle)), centre)
            : wish;
    const double palm_m = std::fabs(arm.hand_from_palm.translation.x);
    const double most = 0.97 * (arm.upper_m + arm.fore_m);
    const double reach = clamp(length(way) - palm_m, 0.3 * most, most);
    Controls c = now;
    ArmControl& control = c.arms[index_of(side)];
    control = {};
    Transform& hand = control.chest_from_hand;
    hand = {shortest_arc({sign(side), 0, 0}, ahead, {0, 1, 0}), shoulder + ahead * reach};
    control.swivel_rad = elbow_rad;
    // Rolled so that the forearm need not twist to its end.
    figure::Pose pose;
    solve_controls(figure, c, pose);
    const Vec3 axis{sign(side), 0, 0};
    const double twist =
        to_swing_twist(conjugate(chest_from_forearm(figure, side, pose)) * hand.rotation, axis)
            .twist_rad;
    constexpr double kMost_rad = radians(50);
    const double easy = clamp(twist, -kMost_rad, kMost_rad);
    hand.rotation = normalized(hand.rotation * from_axis_angle(axis, easy - twist));
    return control;
}

// The goal of a palm at a point that faces something, or of fingers that point to it, or both.
LimbGoal hand_goal(const figure::Arm& arm, Side side, Vec3 target, const Vec3* palm_to,
                   const Vec3* fingers_to) {
    const Vec3 fingers{sign(side), 0, 0}, palm = rotate(arm.hand_from_palm.rotation, {0, 1, 0});
    LimbGoal goal{.kind = LimbGoalKind::kDirection,
                  .position_parent = target,
                  .tip_end = arm.hand_from_palm.translation};
    const auto direction = [&](const Vec3* to) { return normalized(*to - target, {0, 0, 1}); };
    if (palm_to == nullptr || fingers_to == nullptr) {
        goal.axis_end = palm_to != nullptr ? palm : fingers;
        goal.direction_parent = direction(palm_to != nullptr ? palm_to : fingers_to);
        return goal;
    }
    const Vec3 n = direction(palm_to), wish = direction(fingers_to),
               across = wish - n * dot(wish, n);
    const Vec3 any = std::fabs(n.y) < 0.9 ? Vec3{0, 1, 0} : Vec3{0, 0, 1};
    const Vec3 f = normalized(across, normalized(any - n * dot(any, n)));
    goal.kind = LimbGoalKind::kPose;
    goal.rotation_parent =
        from_basis(f, n, cross(f, n)) * conjugate(from_basis(fingers, palm, cross(fingers, palm)));
    return goal;
}

}  // namespace

ArmMovement make_reach(const MotionContext& given, const ReachSpec& spec) {
    const MotionContext context = arms_in_chest_space(given);
    const Transform chest_from_world = inverse(world_from_chest(context.figure, context.now));
    const Vec3 target = chest_from_world * spec.target_world;
    ArmMovement result;
    ArmControl own;
    if (spec.palm_to_world || spec.fingers_to_world) {
        Vec3 palm, fingers;
        if (spec.palm_to_world) {
            palm = chest_from_world * *spec.palm_to_world;
        }
        if (spec.fingers_to_world) {
            fingers = chest_from_world * *spec.fingers_to_world;
        }
        const ArmAnswer answer =
            solve_arm(context.figure, context.now,
                      {.side = spec.side,
                       .goal_chest = hand_goal(context.figure.arms[index_of(spec.side)], spec.side,
                                               target, spec.palm_to_world ? &palm : nullptr,
                                               spec.fingers_to_world ? &fingers : nullptr),
                       .elbow_rad = spec.elbow_rad});
        own = answer.control;
        result.residual_m = answer.residual_m;
        result.residual_rad = answer.residual_rad;
    } else {
        own = along_the_line(context.figure, context.now, spec.side, target,
                             spec.elbow_rad.value_or(0), result.residual_rad);
    }
    own.relaxed = 0.4;
    own.spread = 0.6;
    own.grip = 0;
    result.movement = std::make_shared<ArmTo>(context, spec.side, own, spec.duration_s);
    return result;
}

ArmMovement make_point(const MotionContext& given, const PointSpec& spec) {
    const MotionContext context = arms_in_chest_space(given);
    const Transform chest_from_world = inverse(world_from_chest(context.figure, context.now));
    // The hand goes on straight along the forearm, whatever way the palm is turned now.
    const ArmAnswer answer =
        solve_arm(context.figure, context.now,
                  {.side = spec.side,
                   .goal_chest = {.kind = LimbGoalKind::kAim,
                                  .position_parent = chest_from_world * spec.target_world,
                                  .axis_end = {sign(spec.side), 0, 0},
                                  .hinge_rad = spec.flexion_rad,
                                  .hinge_given = false},
                   .elbow_rad = spec.elbow_rad});
    ArmControl own = answer.control;
    own.relaxed = 0;
    own.spread = 1 - spec.grip;
    own.grip = spec.grip;
    return {std::make_shared<ArmTo>(context, spec.side, own, spec.duration_s), answer.residual_m,
            answer.residual_rad};
}

}  // namespace puppetri::motion
