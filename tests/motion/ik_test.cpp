// SPDX-License-Identifier: MIT
// Two-bone and seven-degree inverse kinematics, solving of controls, inertialization.
#include <doctest/doctest.h>

#include <cstdint>

#include "puppetri/math/rotation.h"
#include "puppetri/motion/gait.h"
#include "puppetri/motion/gaze.h"
#include "puppetri/motion/idle.h"
#include "puppetri/motion/inertialize.h"
#include "puppetri/motion/solve_controls.h"
#include "puppetri/motion/two_bone_ik.h"

using namespace puppetri;
using namespace puppetri::motion;

namespace {

struct Lcg {
    std::uint32_t state = 11;
    double next() {
        return ((state = state * 1664525u + 1013904223u) >> 8) / double(1 << 24) * 2 - 1;
    }
    Vec3 vector() {
        const double x = next(), y = next(), z = next();
        return {x, y, z};
    }
    Quat rotation() {
        const Vec3 v = vector();
        return normalized(Quat{v.x, v.y, v.z, next()});
    }
};

}  // namespace

TEST_CASE("two-bone IK reaches every target inside the ring, with bones of their lengths [law]") {
    Lcg random;
    int inside = 0;
    for (int i = 0; i < 5000; ++i) {
        const TwoBoneIk ik{.start = random.vector(),
                           .target = random.vector(),
                           .pole = random.vector(),
                           .upper_m = 0.5,
                           .lower_m = 0.4,
                           .soft = 0.99};
        const TwoBoneResult r = solve_two_bone(ik);
        CHECK(length(r.middle - ik.start) == doctest::Approx(0.5));
        CHECK(length(r.end - r.middle) == doctest::Approx(0.4));
        const double d = length(ik.target - ik.start);
        if (d > 0.1 && d < 0.99 * 0.9) {
            CHECK(length(r.end - ik.target) < 1e-12);
            ++inside;
        } else {
            CHECK(r.residual_m == doctest::Approx(length(r.end - ik.target)));
        }
        CHECK(dot(r.middle - ik.start, ik.pole - ik.start) > -10);
    }
    CHECK(inside > 500);
}

TEST_CASE("two-bone IK has an answer where the question has none [unit]") {
    const TwoBoneIk on_start{
        .start = {1, 1, 1}, .target = {1, 1, 1}, .pole = {0, 0, 1}, .upper_m = 0.5, .lower_m = 0.5};
    CHECK(length(solve_two_bone(on_start).end - Vec3{1, 1, 1}) < 1e-6);
    const TwoBoneIk pole_along{
        .start = {}, .target = {0, -0.8, 0}, .pole = {0, 3, 0}, .upper_m = 0.5, .lower_m = 0.5};
    CHECK(length(solve_two_bone(pole_along).end - Vec3{0, -0.8, 0}) < 1e-12);
    const TwoBoneIk far{
        .start = {}, .target = {0, -5, 0}, .pole = {0, 0, 1}, .upper_m = 0.5, .lower_m = 0.5};
    CHECK(solve_two_bone(far).residual_m == doctest::Approx(4).epsilon(0.01));
    CHECK(std::isfinite(solve_two_bone(far).bend_rad));
}

TEST_CASE("the middle joint's angle has no corner as a target leaves the reach [law]") {
    auto bend = [](double d) {
        return solve_two_bone({.start = {},
                               .target = {0, -d, 0},
                               .pole = {0, 0, 1},
                               .upper_m = 0.43,
                               .lower_m = 0.43,
                               .soft = 0.98})
            .bend_rad;
    };
    double before = bend(0.80), slope_before = 0;
    for (double d = 0.80; d < 1.0; d += 0.0005) {
        const double now = bend(d), slope = (now - before) / 0.0005;
        if (d > 0.801) {
            CHECK(std::fabs(slope - slope_before) <
                  1.0);  // an unsoftened leg has a corner of hundreds here
        }
        before = now;
        slope_before = slope;
    }
}

TEST_CASE(
    "solving puts feet and hands where the controls say and every joint inside its limits [law]") {
    Lcg random;
    int raised = 0;
    for (const double height : {1.5, 1.9}) {
        const figure::Figure f = figure::make_mannequin(height);
        figure::Pose pose;
        std::vector<Transform> world(f.skeleton.joints.size());
        for (int i = 0; i < 400; ++i) {
            Controls c = standing(f, random.vector() * 3, 3 * random.next());
            c.pelvis.position_world.y -= 0.1 + 0.1 * random.next();
            c.body.pelvis_from_chest = from_rotation_vector(random.vector() * 0.3);
            c.body.chest_from_head = from_rotation_vector(random.vector() * 0.3);
            for (ArmControl& arm : c.arms) {
                arm.chest_from_hand.translation =
                    arm.chest_from_hand.translation + random.vector() * 0.06 + Vec3{0, 0.15, 0.2};
            }
            const SolveOutcome outcome = solve_controls(f, c, pose);
            figure::to_model_space(f.skeleton, pose, world);
            const Transform chest = world_from_chest(f, c);
            for (int side = 0; side < 2; ++side) {
                CHECK(length(world[f.legs[side].ankle.value].translation -
                             c.legs[side].ankle_world) < outcome.leg_residual_m[side] + 1e-9);
                CHECK(length(world[f.arms[side].hand.value].translation -
                             chest * c.arms[side].chest_from_hand.translation) <
                      outcome.arm_residual_m[side] + 1e-9);
                // Hips too low for an ankle raise the heel; the toes stay.
                const Vec3 toes =
                    Transform{c.legs[side].foot_rotation_world, c.legs[side].ankle_world} *
                    f.legs[side].toes_foot;
                const bool flat = outcome.leg_residual_m[side] < 1e-9;
                CHECK(length(world[f.legs[side].toes.value].translation - toes) <
                      (flat ? 1e-9 : 1e-4));
                raised += !flat;
            }
            for (std::size_t j = 0; j < world.size(); ++j) {
                CAPTURE(f.skeleton.joints[j].name);
                CHECK(figure::limit_excess_rad(f.limits[j], pose.parent_from_joint[j].rotation) <
                      1e-6);
            }
        }
    }
    CHECK(raised > 100);
}

TEST_CASE("a hand fixed to the world stays there whatever the trunk does [unit]") {
    const figure::Figure f = figure::make_mannequin(1.75);
    Controls c = standing(f, {}, 0);
    const Vec3 point{0.2, 1.2, 0.4};
    c.arms[0].world_from_hand = {Quat{}, point};
    c.arms[0].world_weight = 1;
    figure::Pose pose;
    std::vector<Transform> world(f.skeleton.joints.size());
    for (double bend = -0.3; bend < 0.3; bend += 0.05) {
        c.body.pelvis_from_chest = about_y(bend) * about_x(bend / 2);
        solve_controls(f, c, pose);
        figure::to_model_space(f.skeleton, pose, world);
        CHECK(length(world[f.arms[0].hand.value].translation - point) < 1e-9);
    }
}

TEST_CASE("eyes look at what they are told to, and ahead when it is behind the back [unit]") {
    const figure::Figure f = figure::make_mannequin(1.75);
    Controls c = standing(f, {}, 0);
    for (const Vec3 target : {Vec3{1, 1.5, 2}, Vec3{-2, 1, 1.5}, Vec3{0, 2.5, 3}}) {
        c.body.chest_from_head = gaze_at(f, c, target);
        figure::Pose pose;
        std::vector<Transform> world(f.skeleton.joints.size());
        solve_controls(f, c, pose);
        figure::to_model_space(f.skeleton, pose, world);
        const Transform& head = world[f.head.value];
        const Vec3 eyes = head * f.eyes_head;
        CHECK(dot(normalized(target - eyes), rotate(head.rotation, {0, 0, 1})) >
              std::cos(radians(6)));
    }
    CHECK(angle_of(gaze_at(f, c, {0, 1.6, -3})) < 1e-9);
}

TEST_CASE(
    "an inertial offset starts with value and rate and ends at rest, without overshooting [law]") {
    for (const double v0 : {-8.0, -2.0, 0.0, 1.0}) {
        const InertialOffset o(0.4, v0, 0.5);
        CHECK(o.at(0) == doctest::Approx(0.4));
        CHECK((o.at(1e-6) - o.at(0)) / 1e-6 == doctest::Approx(v0).epsilon(1e-3));
        CHECK(o.at(0.5) == 0);
        double least = 1;
        for (double t = 0; t < 0.6; t += 0.001) {
            least = std::fmin(least, o.at(t));
        }
        CHECK(least > -0.02);
    }
    CHECK(InertialOffset(1, 1, 0).at(0) == 0);
}

TEST_CASE(
    "an inertialized arm begins with the value and the rate that were found, also for large turns "
    "[law]") {
    Lcg random;
    const figure::Figure figure = figure::make_mannequin(1.75);
    for (int i = 0; i < 200; ++i) {
        const Quat q = random.rotation(), own_q = random.rotation();
        const Vec3 w = random.vector() * 3, own_w = random.vector() * 3, v = random.vector(),
                   u = random.vector();
        const Vec3 p = Vec3{-0.5, 0, 0.3} + random.vector() * 0.2,
                   own_p = Vec3{-0.5, 0, 0.3} + random.vector() * 0.2;
        ArmControl now, own;
        now.chest_from_hand = {q, p};
        own.chest_from_hand = {own_q, own_p};
        ControlsRate::Arm rate, own_rate;
        rate.hand_angular_chest = w;
        own_rate.hand_angular_chest = own_w;
        rate.hand_velocity_chest = v;
        own_rate.hand_velocity_chest = u;
        const InertialArm inertia(figure, Side::kRight, now, rate, own, own_rate, 0.4);
        auto at = [&](double t) {
            ArmControl a = own;
            a.chest_from_hand = {from_rotation_vector(own_w * t) * own_q, own_p + u * t};
            inertia.apply(t, a);
            return a.chest_from_hand;
        };
        constexpr double h = 1e-5;
        CHECK(angle_between(at(0).rotation, q) < 1e-7);
        CHECK(length(at(0).translation - p) < 1e-12);
        CHECK(length(angular_velocity(at(0).rotation, at(h).rotation, h) - w) < 0.02);
        CHECK(length((at(h).translation - at(0).translation) * (1 / h) - v) < 0.02);
        CHECK(length(at(1).translation - (own_p + u)) < 1e-9);
        CHECK(angle_between(at(1).rotation, from_rotation_vector(own_w) * own_q) < 1e-7);
    }
}
