// SPDX-License-Identifier: MIT
// The geometry of the grip. Left and right are mirror images in the plane x = 0 of ball space.
#include "puppetri/motion/grip.h"

#include "puppetri/base/elementary.h"
#include "puppetri/math/rotation.h"
#include "puppetri/motion/gaze.h"
#include "puppetri/motion/two_bone_ik.h"

namespace puppetri::motion {
namespace {

// How far the palms are below the ball's equator: enough to carry and to scoop, not so much that
// the hands meet.
constexpr double kUnder_rad = 0.5;
constexpr double kElbowOut_rad = -0.2;

double sign(Side side) { return side == Side::kLeft ? 1 : -1; }

// Unit vector from the centre to the palm.
Vec3 outward(Side side, bool flat) {
    return flat ? Vec3{sign(side), 0, 0} : Vec3{sign(side) * cos(kUnder_rad), -sin(kUnder_rad), 0};
}

// The hand's rotation in ball space: fingers along +Z, the palm's normal towards the centre.
Quat hand_rotation(Side side, bool flat) {
    const Vec3 fingers{0, 0, 1};
    const Vec3 back_of_hand = outward(side, flat);  // +Y of the hand, whose palm faces -Y
    const Vec3 x = fingers * sign(side);  // fingers point to +X of a left hand, -X of a right one
    return from_basis(x, back_of_hand, cross(x, back_of_hand));
}

}  // namespace

Grip box_grip(Vec3 size_m, double heading_rad) {
    // Quarter turns from the box to the hands.
    const double quarters = std::nearbyint(heading_rad / (kPi / 2));
    const bool across = std::fabs(std::remainder(quarters, 2)) > 0.5;
    return {(across ? size_m.z : size_m.x) / 2, (across ? size_m.x : size_m.z) / 2, true,
            quarters * (kPi / 2)};
}

Transform ball_from_hand(const figure::Figure& figure, Side side, const Grip& grip, double gap_m) {
    const Quat rotation = hand_rotation(side, grip.flat);
    const Vec3 palm_hand = figure.arms[index_of(side)].hand_from_palm.translation;
    return {rotation,
            outward(side, grip.flat) * (grip.half_m + gap_m) - rotate(rotation, palm_hand)};
}

Transform ball_between(const figure::Figure& figure, const Transform& left_hand,
                       const Transform& right_hand, const Grip& grip) {
    const Transform left = left_hand * inverse(ball_from_hand(figure, Side::kLeft, grip));
    const Transform right = right_hand * inverse(ball_from_hand(figure, Side::kRight, grip));
    return {left.rotation, (left.translation + right.translation) * 0.5};
}

HeldBall held_ball(const MotionContext& context, const Grip& grip) {
    const Transform chest_from_world = inverse(world_from_chest(context.figure, context.now));
    const Transform left =
        chest_from_world * world_from_hand(context.figure, context.now, Side::kLeft);
    const Transform right =
        chest_from_world * world_from_hand(context.figure, context.now, Side::kRight);
    HeldBall held{ball_between(context.figure, left, right, grip), {}, {}};
    const auto& left_rate = context.rate.arms[index_of(Side::kLeft)];
    const auto& right_rate = context.rate.arms[index_of(Side::kRight)];
    held.angular_chest = (left_rate.hand_angular_chest + right_rate.hand_angular_chest) * 0.5;
    const Vec3 c = held.chest_from_ball.translation;
    held.velocity_chest =
        (left_rate.hand_velocity_chest + cross(held.angular_chest, c - left.translation) +
         right_rate.hand_velocity_chest + cross(held.angular_chest, c - right.translation)) *
        0.5;
    return held;
}

bool hands_hold(const MotionContext& context, const Grip& grip) {
    constexpr double kOff_m = 5e-6;  // more would be seen as a jump
    Controls laid = context.now;
    lay_hands(context.figure, held_ball(context, grip).chest_from_ball, grip, 0, laid);
    const Transform chest_from_world = inverse(world_from_chest(context.figure, context.now));
    for (const Side side : {Side::kLeft, Side::kRight}) {
        const Vec3 hand =
            chest_from_world * world_from_hand(context.figure, context.now, side).translation;
        if (length(hand - laid.arms[index_of(side)].chest_from_hand.translation) > kOff_m) {
            return false;
        }
    }
    return true;
}

void lay_hands(const figure::Figure& figure, const Transform& chest_from_ball, const Grip& grip,
               double gap_m, Controls& out) {
    for (const Side side : {Side::kLeft, Side::kRight}) {
        ArmControl& arm = out.arms[index_of(side)];
        arm = {};
        arm.chest_from_hand = chest_from_ball * ball_from_hand(figure, side, grip, gap_m);
        arm.chest_from_hand.rotation = normalized(arm.chest_from_hand.rotation);
        arm.swivel_rad = kElbowOut_rad;
        arm.relaxed = 0;
        arm.spread = 1;
    }
}

double easy_pitch(const figure::Figure& figure, Vec3 ball_chest, const Grip& grip) {
    const figure::Arm& arm = figure.arms[index_of(Side::kLeft)];
    const Vec3 shoulder = shoulder_chest(figure, Side::kLeft);
    double pitch = 0;
    for (int i = 0; i < 8; ++i) {  // the wrist's place depends on the pitch, a little
        const Transform hand =
            Transform{about_x(pitch), ball_chest} * ball_from_hand(figure, Side::kLeft, grip);
        const TwoBoneResult bent = solve_two_bone({.start = shoulder,
                                                   .target = hand.translation,
                                                   .pole = {kElbowOut_rad, -1, -0.3},
                                                   .upper_m = arm.upper_m,
                                                   .lower_m = arm.fore_m});
        const Vec3 forearm = bent.end - bent.middle;
        pitch = atan2(-forearm.y, forearm.z);
    }
    return pitch;
}

}  // namespace puppetri::motion
