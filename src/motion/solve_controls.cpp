// SPDX-License-Identifier: MIT
// Pelvis, trunk, legs, arms, fingers, in this order; each joint is clamped as it is set, so that
// what hangs below it is solved from where it really is.
#include "puppetri/motion/solve_controls.h"

#include "puppetri/math/rotation.h"
#include "puppetri/motion/limb_ik.h"
#include "trunk.h"

namespace puppetri::motion {
namespace {

using figure::Figure;
using figure::JointIndex;
using figure::Pose;

// Where the elbow hangs: at an arm that points along kArmBase (down, a little ahead and outward) it
// lies behind and outward. For other directions of the arm that is carried along by the shortest
// turn; the direction opposite to the base, where this is undefined, is behind the head, where no
// hand gets.
Vec3 elbow_direction(double s, Vec3 arm_direction) {
    const Vec3 base = normalized(Vec3{0.30 * s, -0.88, 0.36});
    const Vec3 behind{0.35 * s, 0, -0.94};
    return rotate(shortest_arc(base, arm_direction, {0, 0, 1}), behind - base * dot(base, behind));
}

class Solver {
 public:
    Solver(const Figure& figure, const Controls& controls, Pose& out)
        : f_(figure), c_(controls), out_(out) {}

    SolveOutcome solve() {
        const Vec3 p = c_.pelvis.position_world;
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

    void solve_leg(int side) {
        const figure::Leg& leg = f_.legs[side];
        const LegControl& control = c_.legs[side];
        const Transform pelvis_from_world = inverse(world_from_pelvis_);
        const Transform goal =
            pelvis_from_world * Transform{control.foot_rotation_world, control.ankle_world};
        // The knee points where the foot does, a little held back by the pelvis.
        Vec3 toes_world = rotate(control.foot_rotation_world, {0, 0, 1});
        toes_world = normalized(Vec3{toes_world.x, 0, toes_world.z},
                                rotate(c_.pelvis.rotation_world, {0, 0, 1}));
        const Vec3 pole = rotate(pelvis_from_world.rotation, toes_world) * 0.6 + Vec3{0, 0, 0.4};
        const LimbResult limb = solve_limb(
            {.start = leg.hip_pelvis,
             .goal = goal,
             .axis = {0, -1, 0},
             .hinge = {1, 0, 0},
             .swivel_zero = pole,
             .swivel_rad = side == figure::kLeft ? -control.swivel_rad : control.swivel_rad,
             .upper_m = leg.thigh_m,
             .lower_m = leg.shank_m,
             .soft = 0.998});
        const Quat hip = set(leg.hip, limb.start_rotation);
        const Quat knee = set(leg.knee, limb.middle_rotation);
        set(leg.ankle, conjugate(hip * knee) * goal.rotation);
        set(leg.toes, about_x(-control.toe_bend_rad));
        outcome_.leg_residual_m[side] =
            length(goal.translation - leg.hip_pelvis -
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
        const LimbResult limb = solve_limb({.start = arm.shoulder_clavicle,
                                            .goal = goal,
                                            .axis = axis,
                                            .hinge = {0, -s, 0},
                                            .swivel_zero = elbow_direction(s, direction),
                                            .swivel_rad = s * control.swivel_rad,
                                            .upper_m = arm.upper_m,
                                            .lower_m = arm.fore_m});
        const Quat shoulder = set(arm.shoulder, limb.start_rotation);
        const Quat elbow = set(arm.elbow, limb.middle_rotation);
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

SolveOutcome solve_controls(const Figure& figure, const Controls& controls, Pose& out) {
    const std::size_t count = figure.skeleton.joints.size();
    if (out.parent_from_joint.size() != count) {
        out = figure::rest_pose(figure.skeleton);
    }
    for (std::size_t i = 0; i < count; ++i) {
        out.parent_from_joint[i].translation =
            figure.skeleton.joints[i].parent_from_joint_rest.translation;
    }
    return Solver(figure, controls, out).solve();
}

}  // namespace puppetri::motion
