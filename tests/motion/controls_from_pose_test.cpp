// SPDX-License-Identifier: MIT
// Handles read off a pose, against solving them.
#include "puppetri/motion/controls_from_pose.h"

#include <doctest/doctest.h>

#include <cstdint>

#include "puppetri/math/rotation.h"
#include "puppetri/motion/gaze.h"
#include "puppetri/motion/idle.h"
#include "puppetri/motion/solve_controls.h"

using namespace puppetri;
using namespace puppetri::motion;

namespace {

struct Lcg {
    std::uint32_t state = 5;
    double next() {
        return ((state = state * 1664525u + 1013904223u) >> 8) / double(1 << 24) * 2 - 1;
    }
    Vec3 vector() {
        const double x = next(), y = next(), z = next();
        return {x, y, z};
    }
    Quat turn(double most_rad) { return from_rotation_vector(vector() * most_rad); }
};

// A standing figure that does something with everything it has, within easy reach.
Controls some_controls(const figure::Figure& figure, Lcg& random) {
    Controls c = standing(figure, random.vector() * 3, 3 * random.next());
    c.pelvis.position_world =
        c.pelvis.position_world + random.vector() * 0.02 - Vec3{0, 0.035 * figure.height_m, 0};
    c.pelvis.rotation_world = c.pelvis.rotation_world * random.turn(0.15);
    c.body.pelvis_from_chest = random.turn(0.4);
    c.body.chest_from_head = random.turn(0.5);
    c.body.breath = 0.5 + 0.5 * random.next();
    for (const Side side : {Side::kLeft, Side::kRight}) {
        LegControl& leg = c.legs[index_of(side)];
        leg.ankle_world = leg.ankle_world + random.vector() * 0.03;
        leg.foot_rotation_world = leg.foot_rotation_world * random.turn(0.1);
        leg.toe_bend_rad = 0.3 + 0.2 * random.next();
        leg.swivel_rad = 0.15 * random.next();
        ArmControl& arm = c.arms[index_of(side)];
        arm.chest_from_hand.translation =
            arm.chest_from_hand.translation + Vec3{0, 0.08, 0.12} + random.vector() * 0.04;
        arm.chest_from_hand.rotation = about_x(-radians(25)) * arm.chest_from_hand.rotation;
        arm.swivel_rad = 0.3 * random.next();
        arm.spread = 0.3 + 0.2 * random.next();
        arm.grip = 0.2 + 0.2 * random.next();
        arm.relaxed = 1 - arm.spread - arm.grip;
    }
    return c;
}

double apart(const Transform& a, const Transform& b) {
    return std::fmax(length(a.translation - b.translation), angle_between(a.rotation, b.rotation));
}

std::vector<Transform> world(const figure::Figure& figure, const figure::Pose& pose) {
    std::vector<Transform> joints(figure.skeleton.joints.size());
    to_model_space(figure.skeleton, pose, joints);
    return joints;
}

}  // namespace

TEST_CASE(
    "controls that can be reached are read back off the pose that they were solved into "
    "[law]") {
    Lcg random;
    int whole = 0;
    for (int i = 0; i < 400; ++i) {
        const figure::Figure figure = figure::make_mannequin(1.2 + 0.4 * (i % 3));
        const Controls c = some_controls(figure, random);
        figure::Pose pose;
        const SolveOutcome outcome = solve_controls(figure, c, pose);
        if (outcome.clamped_rad > 0 || outcome.leg_residual_m[0] > 1e-9 ||
            outcome.leg_residual_m[1] > 1e-9 || outcome.arm_residual_m[0] > 1e-9 ||
            outcome.arm_residual_m[1] > 1e-9) {
            continue;  // the pose is not what was asked
        }
        ++whole;
        Controls back;
        back.body.breath = c.body.breath;
        controls_from_pose(figure, pose, kAllLimbs, back);
        CHECK(apart({c.pelvis.rotation_world, c.pelvis.position_world},
                    {back.pelvis.rotation_world, back.pelvis.position_world}) < 1e-9);
        CHECK(angle_between(c.body.pelvis_from_chest, back.body.pelvis_from_chest) < 1e-7);
        CHECK(angle_between(c.body.chest_from_head, back.body.chest_from_head) < 1e-7);
        for (int side = 0; side < 2; ++side) {
            const LegControl &a = c.legs[side], &b = back.legs[side];
            CHECK(apart({a.foot_rotation_world, a.ankle_world},
                        {b.foot_rotation_world, b.ankle_world}) < 1e-7);
            CHECK(b.toe_bend_rad == doctest::Approx(a.toe_bend_rad));
            CHECK(b.swivel_rad == doctest::Approx(a.swivel_rad).epsilon(1e-6));
            const ArmControl &u = c.arms[side], &v = back.arms[side];
            CHECK(apart(u.chest_from_hand, v.chest_from_hand) < 1e-7);
            CHECK(v.swivel_rad == doctest::Approx(u.swivel_rad).epsilon(1e-6));
            // Weights are blended and normalized: what is read is near, and sums to 1.
            CHECK(std::fabs(v.spread - u.spread) < 0.1);
            CHECK(std::fabs(v.grip - u.grip) < 0.1);
            CHECK(v.relaxed + v.spread + v.grip == doctest::Approx(1));
        }
    }
    CHECK(whole > 100);
}

TEST_CASE(
    "a pose of free joint rotations keeps its hips, chest, ankles, feet, toes and hands through "
    "controls [law]") {
    Lcg random;
    const figure::Figure figure = figure::make_mannequin(1.75);
    int whole = 0;
    for (int i = 0; i < 400; ++i) {
        figure::Pose pose = rest_pose(figure.skeleton);
        const auto set = [&](figure::JointIndex joint, Quat q) {
            pose.parent_from_joint[joint.value].rotation =
                figure::clamp_to_limit(figure.limits[joint.value], q);
        };
        pose.parent_from_joint[figure.hips.value].rotation = random.turn(0.4);
        // The trunk bends in one plane, as people do; how it is spread is free.
        const Vec3 bend = random.vector() * 0.25;
        set(figure.spine, from_rotation_vector(bend * (1 + random.next())));
        set(figure.chest, from_rotation_vector(bend * (1 + random.next())));
        set(figure.upper_chest, from_rotation_vector(bend * (1 + random.next())));
        set(figure.neck, random.turn(0.2));
        set(figure.head, random.turn(0.2));
        for (int side = 0; side < 2; ++side) {
            const double s = side == 0 ? 1 : -1;
            set(figure.legs[side].hip, about_x(-0.5 + 0.4 * random.next()));
            set(figure.legs[side].knee, about_x(0.8 + 0.3 * random.next()));
            set(figure.legs[side].ankle, about_x(-0.1 + 0.2 * random.next()));
            set(figure.legs[side].toes, about_x(-0.2 + 0.2 * random.next()));
            set(figure.arms[side].clavicle, random.turn(0.1));
            set(figure.arms[side].shoulder,
                about_z(s * (-0.8 + 0.3 * random.next())) * about_y(-s * 0.5));
            set(figure.arms[side].elbow, about_y(-s * (1.2 + 0.4 * random.next())));
            set(figure.arms[side].hand, about_z(s * 0.3 * random.next()));
        }
        Controls c;
        controls_from_pose(figure, pose, kAllLimbs, c);
        figure::Pose solved;
        const SolveOutcome outcome = solve_controls(figure, c, solved);
        const std::vector<Transform> a = world(figure, pose), b = world(figure, solved);
        CHECK(apart(a[figure.hips.value], b[figure.hips.value]) < 1e-9);
        CHECK(angle_between(a[figure.upper_chest.value].rotation,
                            b[figure.upper_chest.value].rotation) < 0.02);
        if (outcome.clamped_rad > 0) {
            continue;
        }
        ++whole;
        for (int side = 0; side < 2; ++side) {
            CHECK(apart(a[figure.legs[side].ankle.value], b[figure.legs[side].ankle.value]) < 1e-7);
            CHECK(apart(a[figure.legs[side].toes.value], b[figure.legs[side].toes.value]) < 1e-7);
            CHECK(apart(a[figure.legs[side].knee.value], b[figure.legs[side].knee.value]) < 1e-7);
            // In the space of the chest: where the chest itself is depends on how the trunk bends.
            const auto chest = [&](const std::vector<Transform>& w, figure::JointIndex j) {
                return inverse(w[figure.upper_chest.value]) * w[j.value];
            };
            CHECK(apart(chest(a, figure.arms[side].hand), chest(b, figure.arms[side].hand)) < 1e-7);
        }
    }
    CHECK(whole > 100);
}
