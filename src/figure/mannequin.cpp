// SPDX-License-Identifier: MIT
// The mannequin's table of segments. All numbers are fractions of the height; the sources stand in
// the header. Where the printed figure gives surface landmarks (breadth of hips 0.191, of shoulders
// 0.259) the joint centres lie inside them: half 0.050 and 0.105 apart from the midline (Bell,
// Brand and Pedersen 1989; de Leva 1996).
#include "puppetri/figure/mannequin.h"

#include "puppetri/base/require.h"
#include "puppetri/figure/humanoid.h"
#include "puppetri/math/rotation.h"

namespace puppetri::figure {
namespace {

constexpr double kAnkle = 0.039, kShank = 0.246, kThigh = 0.245;  // heights 0.039, 0.285, 0.530
constexpr double kHipSide = 0.050, kHipsAboveHips = 0.015;
constexpr double kFootLength = 0.152, kHeelBehindAnkle = 0.035, kToes = 0.0425, kToesHeight = 0.012;
constexpr double kSpine = 0.590, kChest = 0.650, kUpperChest = 0.715, kNeck = 0.825, kHead = 0.875;
constexpr double kClavicleSide = 0.012, kClavicleHeight = 0.802, kShoulderSide = 0.105,
                 kShoulderHeight = 0.810;
constexpr double kUpperArm = 0.186, kForearm = 0.146, kHand = 0.108, kEyes = 0.936;
constexpr double kStanceHalfWidth = 0.036, kBreast = 0.635;

// Fractions of the hand's length (Buchholz et al. 1992, table 1), thumb to little finger, from the
// palm out.
constexpr std::array<std::array<double, 3>, 5> kPhalanges{{{0.251, 0.196, 0.158},
                                                           {0.245, 0.143, 0.097},
                                                           {0.266, 0.170, 0.108},
                                                           {0.244, 0.165, 0.107},
                                                           {0.204, 0.117, 0.093}}};
// Where the fingers leave the hand: along it and across (to the thumb), fractions of the hand's
// length.
constexpr std::array<std::array<double, 2>, 5> kFingerRoots{
    {{0.17, 0.20}, {0.50, 0.17}, {0.51, 0.055}, {0.49, -0.06}, {0.46, -0.165}}};

// Left and right are mirror images: s is +1 for the left.
HumanoidMeasures::Arm arm_of(double s, double h) {
    HumanoidMeasures::Arm arm;
    arm.clavicle = {s * kClavicleSide * h, (kClavicleHeight - kUpperChest) * h, 0};
    arm.shoulder = {s * (kShoulderSide - kClavicleSide) * h,
                    (kShoulderHeight - kClavicleHeight) * h, 0};
    arm.upper_m = kUpperArm * h;
    arm.fore_m = kForearm * h;
    arm.hand_m = kHand * h;
    arm.hand_from_palm = {about_z(kPi), Vec3{s * 0.44, -0.11, 0} * arm.hand_m};
    for (std::size_t finger = 0; finger < 5; ++finger) {
        const Vec3 direction =
            finger == 0 ? normalized(Vec3{s * 0.66, -0.22, 0.72}) : Vec3{s, 0, 0};
        Vec3 offset =
            Vec3{s * kFingerRoots[finger][0], finger == 0 ? -0.06 : 0, kFingerRoots[finger][1]} *
            arm.hand_m;
        for (std::size_t k = 0; k < 3; ++k) {
            arm.fingers[finger * 3 + k] = offset;
            offset = direction * (kPhalanges[finger][k] * arm.hand_m);
        }
        arm.finger_tips[finger] = offset;
    }
    return arm;
}

HumanoidMeasures::Leg leg_of(double s, double h) {
    const double ball_z = kFootLength - kHeelBehindAnkle - kToes;
    return {.hip = Vec3{s * kHipSide, -kHipsAboveHips, 0} * h,
            .thigh_m = kThigh * h,
            .shank_m = kShank * h,
            .toes = Vec3{0, kToesHeight - kAnkle, ball_z} * h,
            .heel_foot = Vec3{0, -kAnkle, -kHeelBehindAnkle} * h,
            .ball_foot = Vec3{0, -kAnkle, ball_z} * h,
            .toe_tip_foot = Vec3{0, -kAnkle, kFootLength - kHeelBehindAnkle} * h};
}

}  // namespace

HumanoidMeasures mannequin_measures(double height_m) {
    PUP_REQUIRE(height_m >= 0.5 && height_m <= 3);
    const double h = height_m, hips = kAnkle + kShank + kThigh + kHipsAboveHips;
    HumanoidMeasures m;
    m.height_m = h;
    m.hips_height_m = hips * h;
    m.spine = {0, (kSpine - hips) * h, 0};
    m.chest = {0, (kChest - kSpine) * h, 0};
    m.upper_chest = {0, (kUpperChest - kChest) * h, 0};
    m.neck = {0, (kNeck - kUpperChest) * h, 0};
    m.head = {0, (kHead - kNeck) * h, 0};
    m.head_top = {0, (1 - kHead) * h, 0};
    m.eyes_head = {0, (kEyes - kHead) * h, 0.048 * h};
    m.ankle_height_m = kAnkle * h;
    m.leg_m = (kThigh + kShank) * h;
    m.stance_half_width_m = kStanceHalfWidth * h;
    m.reach_height_m = h;
    m.breast_height_m = kBreast * h;
    for (const int side : {kLeft, kRight}) {
        const double s = side == kLeft ? 1 : -1;
        m.arms[static_cast<std::size_t>(side)] = arm_of(s, h);
        m.legs[static_cast<std::size_t>(side)] = leg_of(s, h);
    }
    return m;
}

Figure make_mannequin(double height_m) { return make_humanoid(mannequin_measures(height_m)); }

Pose a_pose(const Figure& figure) {
    Pose pose = rest_pose(figure.skeleton);
    for (const int side : {kLeft, kRight}) {
        pose.parent_from_joint[figure.arms[side].shoulder.value].rotation =
            about_z((side == kLeft ? -1 : 1) * radians(45));
    }
    return pose;
}

}  // namespace puppetri::figure
