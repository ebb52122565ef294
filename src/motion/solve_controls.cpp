// SPDX-License-Identifier: MIT
// Pelvis, trunk, legs, arms, fingers, in this order; each joint is clamped as it is set, so that
// what hangs below it is solved from where it really is.
#include "puppetri/motion/solve_controls.h"

#include "limb_planes.h"
#include "puppetri/math/rotation.h"
#include "puppetri/motion/limb_ik.h"
#include "puppetri/motion/pelvis_placement.h"
#include "puppetri/motion/two_bone_ik.h"
#include "trunk.h"

namespace puppetri::motion {
namespace {

using figure::Figure;
using figure::JointIndex;
using figure::Pose;

// Raising the heel by an angle lets the shank lean by about a third of it: six rounds leave a
// thousandth.
constexpr int kHeelRounds = 6;

// The part of the full reach from which on a limb straightens more and more slowly.
constexpr double kSoftLeg = 0.998, kSoftArm = 0.995;

// Each joint is clamped as it is set; here only the hinge's range shapes the reach.
LimbShape without_ball_limits(LimbShape shape) {
    shape.start_limit = shape.end_limit = {};
    return shape;
}

LimbPose softly(const LimbIk& ik, double soft, const Transform& goal, Vec3 swivel_zero,
                CirclePoint swivel) {
    const Vec3 start = ik.shape().start, way = goal.translation - start;
    const double wanted = length(way), eased = eased_reach_m(wanted, ik.farthest_m(), soft);
    return ik
        .solve_free({.kind = LimbGoalKind::kPose,
                     .position_parent = wanted > 0 ? start + way * (eased / wanted) : start,
                     .rotation_parent = goal.rotation,
                     .swivel_zero_parent = swivel_zero,
                     .line_on_root = normalized(ik.shape().upper)},
                    swivel)
        .pose;
}

class Solver {
 public:
    Solver(const Figure& figure, const Controls& controls, Pose& out)
        : f_(figure), c_(controls), out_(out) {}

    SolveOutcome solve(PelvisRule rule) {
        const Vec3 p =
            rule == PelvisRule::kInReach ? pelvis_in_reach(f_, c_) : c_.pelvis.position_world;
        outcome_.pelvis_moved_m = length(p - c_.pelvis.position_world);
        world_from_pelvis_ = {c_.pelvis.rotation_world, p};
        const Transform world_from_root{about_y(heading_of(c_.pelvis.rotation_world)),
                                        {p.x, 0, p.z}};
        out_.parent_from_joint[f_.root.value] = world_from_root;
        out_.parent_from_joint[f_.hips.value] = inverse(world_from_root) * world_from_pelvis_;
        TrunkRotations trunk = trunk_rotations(c_.body);
        trunk.spine = set(f_.spine, trunk.spine);
        trunk.chest = set(f_.chest, trunk.chest);
        trunk.upper_chest = set(f_.upper_chest, trunk.upper_chest);
        set(f_.neck, trunk.neck);
        set(f_.head, trunk.head);
        world_from_chest_ = world_from_pelvis_ * pelvis_from_upper_chest(f_, trunk);
        for (const int side : {figure::kLeft, figure::kRight}) {
            solve_leg(side);
            solve_arm(side);
            set_fingers(side);
        }
        return outcome_;
    }

 private:
    Quat set(JointIndex joint, Quat rotation) {
        const Quat inside = figure::clamp_to_limit(f_.limits[joint.value], rotation);
        if (!(inside == rotation)) {
            outcome_.clamped_rad = std::fmax(outcome_.clamped_rad, angle_between(inside, rotation));
        }
        out_.parent_from_joint[joint.value].rotation = inside;
        return inside;
    }

    // An ankle that would have to bend farther than it can raises the heel: the foot
    // turns about the joint of its toes, which stay where they are (and before that, down about its
    // heel). So no toes go into the floor under hips that are too low.
    void solve_leg(int side) {
        const figure::Leg& leg = f_.legs[side];
        const LegControl& control = c_.legs[side];
        const Transform pelvis_from_world = inverse(world_from_pelvis_);
        const Vec3 ahead_world =
            knee_ahead_world(control.foot_rotation_world, c_.pelvis.rotation_world);
        const Vec3 pole = knee_direction(c_.pelvis.rotation_world, ahead_world);
        Transform foot{control.foot_rotation_world, control.ankle_world};
        // Where the joint of the toes is once the sole is down: a foot on its heel comes down
        // first.
        const Vec3 heel_world = foot * leg.heel_foot;
        const double pitch_up = rotate(control.foot_rotation_world, {0, 0, 1}).y;
        const Vec3 toes_world = pitch_up > 0 ? heel_world + rotate(about_y(heading_of(ahead_world)),
                                                                   leg.toes_foot - leg.heel_foot)
                                             : foot * leg.toes_foot;
        const LimbIk ik(without_ball_limits(
            limb_shape(f_, side == figure::kLeft ? Limb::kLeftLeg : Limb::kRightLeg)));
        const CirclePoint swivel =
            circle_point(side == figure::kLeft ? -control.swivel_rad : control.swivel_rad);
        Quat hip, knee;
        double turned_rad = 0;
        for (int round = 0;; ++round) {
            const Transform goal = pelvis_from_world * foot;
            const LimbPose limb = softly(ik, kSoftLeg, goal, pole, swivel);
            hip = set(leg.hip, limb.start);
            knee = set(leg.knee, limb.hinge);
            const Quat wanted = conjugate(hip * knee) * goal.rotation;
            const Quat ankle = figure::clamp_to_limit(f_.limits[leg.ankle.value], wanted);
            out_.parent_from_joint[leg.ankle.value].rotation = ankle;
            if (ankle == wanted || round == kHeelRounds) {
                break;
            }
            const Quat turned = normalized(world_from_pelvis_.rotation * hip * knee * ankle);
            if (rotate(turned, {0, 0, 1}).y >= rotate(foot.rotation, {0, 0, 1}).y && round == 0) {
                outcome_.clamped_rad =
                    std::fmax(outcome_.clamped_rad, angle_between(ankle, wanted));
                break;  // that would lower the heel, which a leg may be too short for
            }
            foot.rotation = turned;
            foot.translation = rotate(turned, {0, 0, 1}).y > 0
                                   ? heel_world - rotate(turned, leg.heel_foot)
                                   : toes_world - rotate(turned, leg.toes_foot);
            turned_rad = angle_between(foot.rotation, control.foot_rotation_world);
        }
        outcome_.clamped_rad = std::fmax(outcome_.clamped_rad, turned_rad);
        const Quat toes = about_x(-control.toe_bend_rad);
        set(leg.toes,
            turned_rad == 0 ? toes : conjugate(foot.rotation) * control.foot_rotation_world * toes);
        const Vec3 ankle_pelvis = pelvis_from_world * control.ankle_world;
        outcome_.leg_residual_m[side] =
            length(ankle_pelvis - leg.hip_pelvis -
                   rotate(hip, Vec3{0, -leg.thigh_m, 0} + rotate(knee, {0, -leg.shank_m, 0})));
    }

    void solve_arm(int side) {
        const figure::Arm& arm = f_.arms[side];
        const ArmControl& control = c_.arms[side];
        const double s = side == figure::kLeft ? 1 : -1;
        Transform chest_from_hand = control.chest_from_hand;
        if (control.world_weight > 0) {
            const Transform fixed = inverse(world_from_chest_) * control.world_from_hand;
            const double w = std::fmin(control.world_weight, 1);
            chest_from_hand = {slerp(chest_from_hand.rotation, fixed.rotation, w),
                               lerp(chest_from_hand.translation, fixed.translation, w)};
        }
        const Quat clavicle = set(
            arm.clavicle, clavicle_rotation(f_, side, chest_from_hand.translation, c_.body.breath));
        const Transform goal = inverse(Transform{clavicle, arm.clavicle_chest}) * chest_from_hand;
        const Vec3 direction = normalized(goal.translation - arm.shoulder_clavicle, {0, -1, 0});
        const Vec3 axis{s, 0, 0};
        const LimbIk ik(without_ball_limits(
            limb_shape(f_, side == figure::kLeft ? Limb::kLeftArm : Limb::kRightArm)));
        const LimbPose limb = softly(ik, kSoftArm, goal, elbow_direction(s, direction),
                                     circle_point(s * control.swivel_rad));
        const Quat shoulder = set(arm.shoulder, limb.start);
        const Quat elbow = set(arm.elbow, limb.hinge);
        const Quat hand = set(arm.hand, conjugate(shoulder * elbow) * goal.rotation);
        set(arm.shoulder_twist,
            from_axis_angle(axis, -to_swing_twist(shoulder, axis).twist_rad / 2));
        set(arm.elbow_twist, from_axis_angle(axis, to_swing_twist(hand, axis).twist_rad / 2));
        outcome_.arm_residual_m[side] =
            length(goal.translation - arm.shoulder_clavicle -
                   rotate(shoulder, axis * arm.upper_m + rotate(elbow, axis * arm.fore_m)));
    }

    // Weighted sums of quaternions near the identity; the poses lie within a right angle of it.
    void set_fingers(int side) {
        const ArmControl& arm = c_.arms[side];
        const figure::HandPoses& poses = f_.hands[side];
        for (int i = 0; i < figure::kFingerJointCount; ++i) {
            const Quat &a = poses.relaxed[i], &b = poses.spread[i], &c = poses.grip[i];
            const double u = arm.relaxed, v = arm.spread, w = arm.grip;
            out_.parent_from_joint[f_.arms[side].fingers[i].value].rotation =
                normalized(Quat{a.x * u + b.x * v + c.x * w, a.y * u + b.y * v + c.y * w,
                                a.z * u + b.z * v + c.z * w, a.w * u + b.w * v + c.w * w});
        }
    }

    const Figure& f_;
    const Controls& c_;
    Pose& out_;
    Transform world_from_pelvis_, world_from_chest_;
    SolveOutcome outcome_;
};

}  // namespace

SolveOutcome solve_controls(const Figure& figure, const Controls& controls, Pose& out,
                            PelvisRule rule) {
    const std::size_t count = figure.skeleton.joints.size();
    if (!figure.humanoid()) {
        out.parent_from_joint.resize(count);
        for (std::size_t i = 0; i < count; ++i) {
            out.parent_from_joint[i] = figure.skeleton.joints[i].parent_from_joint_rest;
        }
        out.parent_from_joint[figure.root.value] = {controls.pelvis.rotation_world,
                                                    controls.pelvis.position_world};
        return {};
    }
    if (out.parent_from_joint.size() != count) {
        out = figure::rest_pose(figure.skeleton);
    }
    for (std::size_t i = 0; i < count; ++i) {
        out.parent_from_joint[i].translation =
            figure.skeleton.joints[i].parent_from_joint_rest.translation;
    }
    return Solver(figure, controls, out).solve(rule);
}

}  // namespace puppetri::motion
