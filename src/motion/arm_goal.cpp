// SPDX-License-Identifier: MIT
#include "puppetri/motion/arm_goal.h"

#include "limb_planes.h"
#include "puppetri/base/elementary.h"
#include "puppetri/motion/gaze.h"
#include "trunk.h"

namespace puppetri::motion {
namespace {

// The collar bone depends on where the hand is, and where a hand that aims is on the collar bone;
// it moves by a small part of what the hand does.
constexpr int kRounds = 8;

// The goal in the space of the collar bone.
LimbGoal in_clavicle(const LimbGoal& goal, const Transform& clavicle_from_chest) {
    LimbGoal g = goal;
    g.position_parent = clavicle_from_chest * goal.position_parent;
    g.rotation_parent = clavicle_from_chest.rotation * goal.rotation_parent;
    g.direction_parent = rotate(clavicle_from_chest.rotation, goal.direction_parent);
    return g;
}

}  // namespace

ArmAnswer solve_arm(const figure::Figure& figure, const Controls& now, const ArmGoal& wanted) {
    const int side = index_of(wanted.side);
    const double s = wanted.side == Side::kLeft ? 1 : -1;
    const figure::Arm& arm = figure.arms[side];
    const LimbIk ik(limb_shape(figure, arm_of(wanted.side)));
    ArmAnswer answer;
    answer.control = now.arms[side];
    answer.control.world_weight = 0;
    answer.control.chest_from_hand =
        inverse(world_from_chest(figure, now)) * world_from_hand(figure, now, wanted.side);

    const auto clavicle_for = [&](Vec3 hand_chest) {
        return Transform{clavicle_rotation(figure, side, hand_chest, now.body.breath),
                         arm.clavicle_chest};
    };
    const auto zero_of = [&](Vec3 hand_clavicle) {
        return elbow_direction(s, normalized(hand_clavicle - arm.shoulder_clavicle, {0, -1, 0}));
    };
    // Where the arm is now.
    const Transform clavicle_now = clavicle_for(answer.control.chest_from_hand.translation);
    const Transform hand_now = inverse(clavicle_now) * answer.control.chest_from_hand;
    const LimbPose pose_now = ik.solve_free({.kind = LimbGoalKind::kPose,
                                             .position_parent = hand_now.translation,
                                             .rotation_parent = hand_now.rotation,
                                             .swivel_zero_parent = zero_of(hand_now.translation)},
                                            circle_point(s * answer.control.swivel_rad))
                                  .pose;

    Transform clavicle = clavicle_for(wanted.goal_chest.kind == LimbGoalKind::kPoint
                                          ? answer.control.chest_from_hand.translation
                                          : wanted.goal_chest.position_parent);
    LimbPose pose;
    for (int round = 0; round < kRounds; ++round) {
        LimbGoal goal = in_clavicle(wanted.goal_chest, inverse(clavicle));
        goal.swivel_zero_parent = elbow_direction(
            s, goal.kind == LimbGoalKind::kPoint
                   ? normalized(goal.direction_parent)
                   : normalized(goal.position_parent - arm.shoulder_clavicle, {0, -1, 0}));
        const LimbSolution solution =
            ik.solve(goal, wanted.elbow_rad
                               ? SwivelChoice{.swivel = circle_point(s * *wanted.elbow_rad)}
                               : SwivelChoice{.rule = SwivelRule::kLeastMotion, .from = pose_now});
        pose = solution.pose;
        answer.residual_m = solution.residual_m;
        answer.residual_rad = solution.residual_rad;
        answer.control.chest_from_hand = clavicle * parent_from_end(ik.shape(), pose);
        const Transform next = clavicle_for(answer.control.chest_from_hand.translation);
        const double change = angle_between(next.rotation, clavicle.rotation);
        if (change < 1e-9 || round + 1 == kRounds) {
            break;
        }
        clavicle = next;
    }
    // The elbow, seen from the line to the wrist.
    const Vec3 hand = parent_from_end(ik.shape(), pose).translation;
    std::array<LimbFamily, kMaxLimbFamilies> families;
    ik.families({.position_parent = hand, .swivel_zero_parent = zero_of(hand)}, families);
    answer.control.swivel_rad =
        s * radians_of(ik.swivel_of_elbow(families[0], elbow_parent(ik.shape(), pose)));
    return answer;
}

}  // namespace puppetri::motion
