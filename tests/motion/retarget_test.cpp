// SPDX-License-Identifier: MIT
// Retargeting between mannequins of different sizes: where feet and hands must be is known from the
// handles that the source was made of.
#include "puppetri/motion/retarget.h"

#include <doctest/doctest.h>

#include <cmath>

#include "puppetri/motion/solve_controls.h"

using namespace puppetri;
using namespace puppetri::motion;

namespace {

// The mannequin as somebody's character: its raw skeleton is the normalised one, turned and named
// otherwise.
struct Someone {
    figure::Skeleton skeleton;
    figure::Humanoid humanoid;
    Performer performer() const { return {skeleton, humanoid}; }
};
Someone someone(double height_m) {
    Someone s{{}, {figure::make_mannequin(height_m), {}}};
    const figure::Figure& f = s.humanoid.figure;
    s.skeleton = f.skeleton;
    for (std::uint32_t j = 0; j < s.skeleton.joints.size(); ++j) {
        s.skeleton.joints[j].name = "raw_" + f.skeleton.joints[j].name;
        s.humanoid.rig.bones.push_back({{j}, {j}, {}});
        s.humanoid.rig.raw_t_pose.push_back(f.skeleton.joints[j].parent_from_joint_rest);
    }
    s.humanoid.rig.raw_root = f.root;
    s.humanoid.rig.raw_hips = f.hips;
    return s;
}

// A walker's handles by formula: one foot stands while the other one swings.
Controls handles(const figure::Figure& f, double t_s) {
    Controls c;
    const double stride = 0.6 * f.leg_m;
    c.pelvis.position_world = {0.01, f.hips_height_m - 0.04 * f.leg_m, stride * t_s};
    c.body.pelvis_from_chest = about_y(0.1 * std::sin(2 * kPi * t_s));
    for (const int side : {figure::kLeft, figure::kRight}) {
        const double s = side == figure::kLeft ? 1 : -1;
        const double phase = t_s + (side == figure::kLeft ? 0 : 0.5);
        const double k = std::floor(phase), u = phase - k;
        const double swing = u < 0.6 ? 0 : (u - 0.6) / 0.4;
        LegControl& leg = c.legs[side];
        leg.ankle_world = {
            s * f.stance_half_width_m, f.ankle_height_m + 0.08 * std::pow(std::sin(kPi * swing), 2),
            stride *
                (k + swing * swing * (3 - 2 * swing) - 0.2 + (side == figure::kLeft ? 0 : -0.5))};
        const figure::Arm& arm = f.arms[side];
        const Vec3 shoulder = arm.clavicle_chest + arm.shoulder_clavicle;
        const double reach = arm.upper_m + arm.fore_m;
        c.arms[side].chest_from_hand = {
            about_z(-s * 1.3),
            shoulder + Vec3{s * 0.15, -0.85, 0.25 * std::sin(2 * kPi * t_s)} * reach};
    }
    return c;
}

Clip walk_of(const Someone& who, double duration_s) {
    Clip clip;
    clip.name = "walk";
    clip.duration_s = duration_s;
    for (const figure::Joint& joint : who.skeleton.joints) {
        clip.rotations.push_back({joint.name, {}});
        clip.translations.push_back({joint.name, {}});
    }
    figure::Pose pose;
    for (int k = 0; k <= std::lround(duration_s * 60); ++k) {
        solve_controls(who.humanoid.figure, handles(who.humanoid.figure, k / 60.0), pose);
        for (std::size_t j = 0; j < pose.parent_from_joint.size(); ++j) {
            clip.rotations[j].keys.push_back(
                RotationKey{.t_s = k / 60.0, .value = pose.parent_from_joint[j].rotation});
            clip.translations[j].keys.push_back(
                VectorKey{.t_s = k / 60.0, .value = pose.parent_from_joint[j].translation});
        }
    }
    return clip;
}

std::vector<Transform> model_at(const figure::Skeleton& skeleton, const Clip& clip, double t) {
    figure::Pose pose = figure::rest_pose(skeleton);
    sample_clip(clip, bind_clip(clip, skeleton), t, pose);
    std::vector<Transform> model(skeleton.joints.size());
    figure::to_model_space(skeleton, pose, model);
    return model;
}

}  // namespace

TEST_CASE("onto a figure of the same size every joint stays where it was [law]") {
    const Someone a = someone(1.75);
    const Clip clip = walk_of(a, 2);
    const Retargeted same = retarget(clip, a.performer(), a.performer());
    REQUIRE(check(same.clip).has_value());
    CHECK(same.clip.name == "walk");
    for (int k = 0; k <= 120; k += 7) {
        const auto was = model_at(a.skeleton, clip, k / 60.0);
        const auto is = model_at(a.skeleton, same.clip, k / 60.0);
        for (std::size_t j = 0; j < was.size(); ++j) {
            // Feet, hands and trunk; knees of nearly straight legs go a little their own way.
            const std::string& name = a.skeleton.joints[j].name;
            const bool between = name.ends_with("LowerLeg") || name.find("LowerArm") < 99;
            REQUIRE_MESSAGE(
                length(was[j].translation - is[j].translation) < (between ? 3e-2 : 2e-3), name);
        }
    }
}

TEST_CASE(
    "feet of another size stand on the floor and do not slide, its travel is its own "
    "[oracle]") {
    const Someone a = someone(1.75);
    const Clip clip = walk_of(a, 3);
    for (const double height : {1.2, 1.9}) {
        const Someone b = someone(height);
        const Retargeted other = retarget(clip, a.performer(), b.performer());
        REQUIRE(check(other.clip).has_value());
        CHECK(other.worst_foot_m < 0.0012);
        const figure::Figure &fa = a.humanoid.figure, &fb = b.humanoid.figure;
        const double size = (fb.leg_m + fb.ankle_height_m) / (fa.leg_m + fa.ankle_height_m);
        for (int k = 0; k <= 180; k += 3) {
            const double t = k / 60.0;
            const auto is = model_at(b.skeleton, other.clip, t);
            const auto was = model_at(a.skeleton, clip, t);
            for (const int side : {figure::kLeft, figure::kRight}) {
                const Vec3 ankle = is[fb.legs[side].ankle.value].translation;
                const Vec3 goal = was[fa.legs[side].ankle.value].translation;
                CHECK(std::fabs(ankle.x - goal.x * size) < 5e-3);
                CHECK(std::fabs(ankle.z - goal.z * size) < 5e-3);
                CHECK(std::fabs(ankle.y - fb.ankle_height_m - (goal.y - fa.ankle_height_m) * size) <
                      5e-3);
            }
        }
    }
}

TEST_CASE(
    "a hand in contact is where the source's is in the world, another one hangs as it did "
    "[oracle]") {
    const Someone a = someone(1.75), b = someone(1.6);
    Clip clip = walk_of(a, 1);
    clip.marks = {{0.4, 0.6, "contact", "raw_leftHand"}};
    const Retargeted other = retarget(clip, a.performer(), b.humanoid.figure, {.travel_scale = 1});
    CHECK(other.clip.find_rotation("leftUpperArm") != nullptr);  // names of the humanoid
    const auto palm = [](const figure::Figure& f, const std::vector<Transform>& model, int side) {
        return model[f.arms[side].hand.value] * f.arms[side].hand_from_palm.translation;
    };
    for (const double t : {0.4, 0.5, 0.6}) {
        const auto was = model_at(a.skeleton, clip, t);
        const auto is = model_at(b.humanoid.figure.skeleton, other.clip, t);
        const Vec3 goal = palm(a.humanoid.figure, was, figure::kLeft);
        CHECK(length(palm(b.humanoid.figure, is, figure::kLeft) - goal) < 0.02);
        CHECK(length(palm(b.humanoid.figure, is, figure::kRight) -
                     palm(a.humanoid.figure, was, figure::kRight)) > 0.03);
    }
}
