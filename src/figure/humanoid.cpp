// SPDX-License-Identifier: MIT
// The joints of a humanoid, their limits and hand poses; lengths come from the measures.
#include "puppetri/figure/humanoid.h"

#include "finger_names.h"
#include "puppetri/base/require.h"
#include "puppetri/math/rotation.h"

namespace puppetri::figure {
namespace {

class Builder {
 public:
    explicit Builder(const HumanoidMeasures& measures) : m_(measures) {
        f_.height_m = f_.skeleton.height_m = m_.height_m;
    }

    Figure build() && {
        f_.root = add("root", {}, {});
        f_.hips_height_m = m_.hips_height_m;
        f_.hips = add("hips", f_.root, {0, f_.hips_height_m, 0});
        build_trunk();
        for (const int side : {kLeft, kRight}) {
            build_arm(side);
        }
        for (const int side : {kLeft, kRight}) {
            build_leg(side);
        }
        f_.ankle_height_m = m_.ankle_height_m;
        f_.leg_m = m_.leg_m;
        f_.stance_half_width_m = m_.stance_half_width_m;
        f_.reach_height_m = m_.reach_height_m;
        f_.breast_height_m = m_.breast_height_m;
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
        const JointLimit vertebrae = cone(up, x, {}, 35, 25, 25);
        const JointLimit cervical = cone(up, x, {}, 40, 30, 45);
        f_.spine = add("spine", f_.hips, m_.spine, vertebrae);
        f_.chest = add("chest", f_.spine, m_.chest, vertebrae);
        f_.upper_chest = add("upperChest", f_.chest, m_.upper_chest, vertebrae);
        f_.neck = add("neck", f_.upper_chest, m_.neck, cervical);
        f_.head = add("head", f_.neck, m_.head, cervical, m_.head_top);
        f_.eyes_head = m_.eyes_head;
    }

    void build_arm(int side) {
        const double s = sign(side);
        const Vec3 along{s, 0, 0}, up{0, 1, 0}, ahead{0, 0, 1};
        const HumanoidMeasures::Arm& measures = m_.arms[side];
        Arm& arm = f_.arms[side];
        PUP_REQUIRE(measures.upper_m > 0 && measures.fore_m > 0);
        arm.upper_m = measures.upper_m;
        arm.fore_m = measures.fore_m;
        arm.clavicle_chest = measures.clavicle;
        arm.shoulder_clavicle = measures.shoulder;
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
        arm.hand_from_palm = measures.hand_from_palm;
        for (int finger = 0; finger < 5; ++finger) {
            const Vec3 direction = finger == 0 ? normalized(Vec3{s * 0.66, -0.22, 0.72}) : along;
            JointIndex parent = arm.hand;
            for (int k = 0; k < 3; ++k) {
                const int i = finger * 3 + k;
                const JointLimit limit =
                    finger == 0 ? cone(direction, up, {}, 65, 65, 60)
                    : k == 0    ? cone(along, ahead, about_z(-s * radians(35)), 70, 30, 20)
                                : hinge({0, 0, -s}, -10, 110);
                parent = add(named(side, kFingerNames[i]), parent, measures.fingers[i], limit,
                             k == 2 ? measures.finger_tips[finger] : Vec3{});
                arm.fingers[i] = parent;
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
        const Vec3 up{0, 1, 0}, x{1, 0, 0};
        const HumanoidMeasures::Leg& measures = m_.legs[side];
        Leg& leg = f_.legs[side];
        PUP_REQUIRE(measures.thigh_m > 0 && measures.shank_m > 0);
        leg.thigh_m = measures.thigh_m;
        leg.shank_m = measures.shank_m;
        leg.hip_pelvis = measures.hip;
        leg.toes_foot = measures.toes;
        leg.heel_foot = measures.heel_foot;
        leg.ball_foot = measures.ball_foot;
        leg.toe_tip_foot = measures.toe_tip_foot;
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

    const HumanoidMeasures& m_;
    Figure f_;
};

}  // namespace

Figure make_humanoid(const HumanoidMeasures& measures) {
    Figure figure = Builder(measures).build();
    figure.dofs = humanoid_dofs(figure);
    return figure;
}

}  // namespace puppetri::figure
