// SPDX-License-Identifier: MIT
// The mannequin's table of segments. All numbers are fractions of the height; the sources stand in
// the header. Where the printed figure gives surface landmarks (breadth of hips 0.191, of shoulders
// 0.259) the joint centres lie inside them: half 0.050 and 0.105 apart from the midline (Bell,
// Brand and Pedersen 1989; de Leva 1996).
#include "puppetri/figure/mannequin.h"

#include "puppetri/base/require.h"
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
constexpr double kStanceHalfWidth = 0.036;

// Fractions of the hand's length (Buchholz et al. 1992, table 1), thumb to little finger, from the
// palm out.
constexpr std::array<std::array<double, 3>, 5> kPhalanges{{{0.251, 0.196, 0.158},
                                                           {0.245, 0.143, 0.097},
                                                           {0.266, 0.170, 0.108},
                                                           {0.244, 0.165, 0.107},
                                                           {0.204, 0.117, 0.093}}};
constexpr std::array<const char*, kFingerJointCount> kFingerNames{
    "ThumbMetacarpal",   "ThumbProximal",      "ThumbDistal",      "IndexProximal",
    "IndexIntermediate", "IndexDistal",        "MiddleProximal",   "MiddleIntermediate",
    "MiddleDistal",      "RingProximal",       "RingIntermediate", "RingDistal",
    "LittleProximal",    "LittleIntermediate", "LittleDistal"};
// Where the fingers leave the hand: along it and across (to the thumb), fractions of the hand's
// length.
constexpr std::array<std::array<double, 2>, 5> kFingerRoots{
    {{0.17, 0.20}, {0.50, 0.17}, {0.51, 0.055}, {0.49, -0.06}, {0.46, -0.165}}};

class Builder {
 public:
    explicit Builder(double height_m) : h_(height_m) {
        f_.height_m = f_.skeleton.height_m = height_m;
    }

    Figure build() && {
        f_.root = add("root", {}, {});
        f_.hips_height_m = (kAnkle + kShank + kThigh + kHipsAboveHips) * h_;
        f_.hips = add("hips", f_.root, {0, f_.hips_height_m, 0});
        build_trunk();
        for (const int side : {kLeft, kRight}) {
            build_arm(side);
        }
        for (const int side : {kLeft, kRight}) {
            build_leg(side);
        }
        f_.ankle_height_m = kAnkle * h_;
        f_.leg_m = (kThigh + kShank) * h_;
        f_.stance_half_width_m = kStanceHalfWidth * h_;
        return std::move(f_);
    }

 private:
    JointIndex add(std::string name, JointIndex parent, Vec3 offset_m, JointLimit limit = {},
                   Vec3 end_site_m = {}) {
        const JointIndex index{static_cast<std::uint32_t>(f_.skeleton.joints.size())};
        f_.skeleton.joints.push_back({std::move(name), parent, {{}, offset_m}, end_site_m});
        f_.limits.push_back(limit);
        return index;
    }
    static std::string named(int side, const char* name) {
        return (side == kLeft ? "left" : "right") + std::string(name);
    }
    static double sign(int side) { return side == kLeft ? 1 : -1; }

    static JointLimit hinge(Vec3 axis, double lo_deg, double hi_deg) {
        return {.kind = LimitKind::kHinge,
                .axis_joint = axis,
                .lo_rad = radians(lo_deg),
                .hi_rad = radians(hi_deg)};
    }
    // Swings about `side` and across it up to the given angles around the centre, twist within
    // +-twist_deg.
    static JointLimit cone(Vec3 axis, Vec3 side, Quat centre, double side_deg, double other_deg,
                           double twist_deg) {
        return {.kind = LimitKind::kCone,
                .axis_joint = axis,
                .side_joint = side,
                .parent_from_centre = centre,
                .lo_rad = -radians(twist_deg),
                .hi_rad = radians(twist_deg),
                .swing_side_rad = radians(side_deg),
                .swing_other_rad = radians(other_deg)};
    }

    void build_trunk() {
        const Vec3 up{0, 1, 0}, x{1, 0, 0};
        const double hips = kAnkle + kShank + kThigh + kHipsAboveHips;
        const JointLimit vertebrae = cone(up, x, {}, 35, 25, 25);
        const JointLimit cervical = cone(up, x, {}, 40, 30, 45);
        f_.spine = add("spine", f_.hips, {0, (kSpine - hips) * h_, 0}, vertebrae);
        f_.chest = add("chest", f_.spine, {0, (kChest - kSpine) * h_, 0}, vertebrae);
        f_.upper_chest =
            add("upperChest", f_.chest, {0, (kUpperChest - kChest) * h_, 0}, vertebrae);
        f_.neck = add("neck", f_.upper_chest, {0, (kNeck - kUpperChest) * h_, 0}, cervical);
        f_.head =
            add("head", f_.neck, {0, (kHead - kNeck) * h_, 0}, cervical, {0, (1 - kHead) * h_, 0});
        f_.eyes_head = {0, (kEyes - kHead) * h_, 0.048 * h_};
    }

    void build_arm(int side) {
        const double s = sign(side);
        const Vec3 along{s, 0, 0}, up{0, 1, 0}, ahead{0, 0, 1};
        Arm& arm = f_.arms[side];
        arm.upper_m = kUpperArm * h_;
        arm.fore_m = kForearm * h_;
        arm.clavicle_chest = {s * kClavicleSide * h_, (kClavicleHeight - kUpperChest) * h_, 0};
        arm.shoulder_clavicle = {s * (kShoulderSide - kClavicleSide) * h_,
                                 (kShoulderHeight - kClavicleHeight) * h_, 0};
        arm.clavicle = add(named(side, "Shoulder"), f_.upper_chest, arm.clavicle_chest,
                           cone(along, up, {}, 30, 40, 20));
        // The middle of a shoulder's range points ahead, outward and a little down.
        const Quat centre = shortest_arc(along, normalized(Vec3{s * 0.7, -0.15, 0.7}), up);
        arm.shoulder = add(named(side, "UpperArm"), arm.clavicle, arm.shoulder_clavicle,
                           cone(along, up, centre, 120, 125, 110));
        arm.shoulder_twist =
            add(named(side, "UpperArmTwist"), arm.shoulder, along * (arm.upper_m / 2),
                hinge(along, -90, 90), along * (arm.upper_m / 2));
        arm.elbow = add(named(side, "LowerArm"), arm.shoulder, along * arm.upper_m,
                        hinge({0, -s, 0}, 0, 150));
        arm.elbow_twist = add(named(side, "LowerArmTwist"), arm.elbow, along * (arm.fore_m / 2),
                              hinge(along, -90, 90), along * (arm.fore_m / 2));
        // Palmar flexion 80 and extension 70, deviation 35; pronation and supination 90 are its
        // twist.
        arm.hand = add(named(side, "Hand"), arm.elbow, along * arm.fore_m,
                       cone(along, ahead, {}, 80, 40, 95));
        const double hand_m = kHand * h_;
        arm.hand_from_palm = {about_z(kPi), Vec3{s * 0.44, -0.11, 0} * hand_m};
        for (int finger = 0; finger < 5; ++finger) {
            const Vec3 direction = finger == 0 ? normalized(Vec3{s * 0.66, -0.22, 0.72}) : along;
            JointIndex parent = arm.hand;
            Vec3 offset = Vec3{s * kFingerRoots[finger][0], finger == 0 ? -0.06 : 0,
                               kFingerRoots[finger][1]} *
                          hand_m;
            for (int k = 0; k < 3; ++k) {
                const double length_m = kPhalanges[finger][k] * hand_m;
                const JointLimit limit =
                    finger == 0 ? cone(direction, up, {}, 65, 65, 60)
                    : k == 0    ? cone(along, ahead, about_z(-s * radians(35)), 70, 30, 20)
                                : hinge({0, 0, -s}, -10, 110);
                const JointIndex joint = add(named(side, kFingerNames[finger * 3 + k]), parent,
                                             offset, limit, k == 2 ? direction * length_m : Vec3{});
                arm.fingers[finger * 3 + k] = parent = joint;
                offset = direction * length_m;
            }
        }
        build_hand_poses(side);
    }

    // Fingers curl about the axis that turns them towards the palm; the thumb about one that takes
    // it across the palm.
    void build_hand_poses(int side) {
        const double s = sign(side);
        HandPoses& poses = f_.hands[side];
        auto curl = [s](double degrees) { return about_z(-s * radians(degrees)); };
        auto fan = [s](double degrees) { return about_y(-s * radians(degrees)); };
        const Vec3 thumb_axis = normalized(Vec3{0.55, s * 0.62, -s * 0.35 * s});
        auto thumb = [&](double degrees) { return from_axis_angle(thumb_axis, radians(degrees)); };
        const std::array<double, 5> fan_deg{0, 9, 1, -7, -16};
        for (int finger = 0; finger < 5; ++finger) {
            for (int k = 0; k < 3; ++k) {
                const int i = finger * 3 + k;
                if (finger == 0) {
                    poses.relaxed[i] = thumb(k == 0 ? 8 : 14);
                    poses.spread[i] = thumb(k == 0 ? -14 : -4);
                    poses.grip[i] = thumb(k == 0 ? 22 : 30);
                    continue;
                }
                poses.relaxed[i] = curl(k == 0 ? 14 + 3 * finger : k == 1 ? 20 + 3 * finger : 12);
                poses.spread[i] = (k == 0 ? fan(fan_deg[finger]) : Quat{}) * curl(k == 0 ? 4 : 9);
                poses.grip[i] = curl(k == 0 ? 55 : k == 1 ? 70 : 40);
            }
        }
    }

    void build_leg(int side) {
        const double s = sign(side);
        const Vec3 up{0, 1, 0}, x{1, 0, 0};
        Leg& leg = f_.legs[side];
        leg.thigh_m = kThigh * h_;
        leg.shank_m = kShank * h_;
        leg.hip_pelvis = Vec3{s * kHipSide, -kHipsAboveHips, 0} * h_;
        const double ball_z = kFootLength - kHeelBehindAnkle - kToes;
        leg.toes_foot = Vec3{0, kToesHeight - kAnkle, ball_z} * h_;
        leg.heel_foot = Vec3{0, -kAnkle, -kHeelBehindAnkle} * h_;
        leg.ball_foot = Vec3{0, -kAnkle, ball_z} * h_;
        leg.toe_tip_foot = Vec3{0, -kAnkle, kFootLength - kHeelBehindAnkle} * h_;
        leg.ball_toes = leg.ball_foot - leg.toes_foot;
        leg.toe_tip_toes = leg.toe_tip_foot - leg.toes_foot;
        // Flexion 120, extension 30, abduction 45; rotation 45.
        leg.hip = add(named(side, "UpperLeg"), f_.hips, leg.hip_pelvis,
                      cone(up, x, about_x(-radians(45)), 75, 45, 45));
        leg.knee = add(named(side, "LowerLeg"), leg.hip, {0, -leg.thigh_m, 0}, hinge(x, 0, 150));
        // Plantar flexion 55; dorsiflexion 35 under weight (Bennell et al. 1998), turning in and
        // out 30.
        leg.ankle = add(named(side, "Foot"), leg.knee, {0, -leg.shank_m, 0},
                        cone(up, x, about_x(radians(10)), 45, 30, 30));
        leg.toes = add(named(side, "Toes"), leg.ankle, leg.toes_foot, hinge(x, -70, 40),
                       {0, leg.toe_tip_toes.y, leg.toe_tip_toes.z});
    }

    double h_;
    Figure f_;
};

}  // namespace

Figure make_mannequin(double height_m) {
    PUP_REQUIRE(height_m >= 0.5 && height_m <= 3);
    return Builder(height_m).build();
}

Pose a_pose(const Figure& figure) {
    Pose pose = rest_pose(figure.skeleton);
    for (const int side : {kLeft, kRight}) {
        pose.parent_from_joint[figure.arms[side].shoulder.value].rotation =
            about_z((side == kLeft ? -1 : 1) * radians(45));
    }
    return pose;
}

}  // namespace puppetri::figure
