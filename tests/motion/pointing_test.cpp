// SPDX-License-Identifier: MIT
// Reaching with a turned hand, pointing, aiming, looking: measured on the pose at the movement's
// end.
#include <doctest/doctest.h>

#include "puppetri/math/rotation.h"
#include "puppetri/motion/arms.h"
#include "puppetri/motion/gaze.h"
#include "puppetri/motion/idle.h"
#include "puppetri/motion/look.h"
#include "puppetri/motion/solve_controls.h"

using namespace puppetri;
using namespace puppetri::motion;

namespace {

struct Stage {
    figure::Figure f = figure::make_mannequin(1.75);
    MotionContext context{
        .figure = f, .now = standing(f, {0.3, 0, -0.2}, 0.4), .rate = {}, .at = {}, .seed = 3};
    std::vector<Transform> world = std::vector<Transform>(f.skeleton.joints.size());
    figure::Pose pose;

    Vec3 place(Vec3 local) const { return Vec3{0.3, 0, -0.2} + rotate(about_y(0.4), local); }
    SolveOutcome end_of(const Movement& movement) {
        Controls c = context.now;
        movement.sample(movement.duration.seconds() + 0.01, c);
        const SolveOutcome outcome = solve_controls(f, c, pose);
        figure::to_model_space(f.skeleton, pose, world);
        return outcome;
    }
    Transform hand(Side side) const { return world[f.arms[index_of(side)].hand.value]; }
    double worst_excess() const {
        double worst = 0;
        for (std::size_t j = 0; j < f.limits.size(); ++j) {
            worst = std::fmax(
                worst, figure::limit_excess_rad(f.limits[j], pose.parent_from_joint[j].rotation));
        }
        return worst;
    }
};

double off(Vec3 direction, Vec3 from, Vec3 to) {
    const Vec3 way = normalized(to - from);
    return std::atan2(length(cross(direction, way)), dot(direction, way));
}

}  // namespace

TEST_CASE(
    "a palm that reaches lies on its point and faces what it shall; fingers point as told [law]") {
    Stage s;
    for (const Side side : {Side::kLeft, Side::kRight}) {
        const double out = side == Side::kLeft ? 1 : -1;
        const figure::Arm& arm = s.f.arms[index_of(side)];
        const Vec3 target = s.place({out * 0.25, 1.15, 0.4});
        const Vec3 inward = s.place({-out * 0.6, 1.15, 0.5}), ahead = s.place({out * 0.2, 1.25, 2});
        for (const int wish : {1, 2, 3}) {
            CAPTURE(wish);
            ReachSpec spec{.side = side, .target_world = target};
            if (wish & 1) {
                spec.palm_to_world = inward;
            }
            if (wish & 2) {
                spec.fingers_to_world = ahead;
            }
            const ArmMovement made = make_reach(s.context, spec);
            s.end_of(*made.movement);
            const Transform palm = s.hand(side) * arm.hand_from_palm;
            CHECK(made.residual_m < 1e-6);
            CHECK(made.residual_rad < 1e-6);
            CHECK(length(palm.translation - target) < 1e-3);
            CHECK(s.worst_excess() < 1e-6);
            if (wish & 1) {
                CHECK(off(rotate(palm.rotation, {0, 1, 0}), target, inward) < 2e-3);
            }
            if (wish == 2) {
                CHECK(off(rotate(s.hand(side).rotation, {out, 0, 0}), target, ahead) < 2e-3);
            }
            if (wish == 3) {
                CHECK(off(rotate(s.hand(side).rotation, {out, 0, 0}), target, ahead) < 0.3);
            }
        }
    }
}

TEST_CASE(
    "the line of a hand that points or aims passes through the target; the elbow bends as told "
    "[law]") {
    Stage s;
    int met = 0, bent = 0;
    for (const Side side : {Side::kLeft, Side::kRight}) {
        const double out = side == Side::kLeft ? 1 : -1;
        const figure::Arm& arm = s.f.arms[index_of(side)];
        for (const double flexion : {0.12, 0.6, 1.2}) {
            for (int i = 0; i < 24; ++i) {
                const double yaw = -0.6 + i * 0.08, height = 0.3 + 0.09 * i;
                const Vec3 target =
                    s.place({out * 2.5 * std::sin(yaw), height, 2.5 * std::cos(yaw)});
                const ArmMovement made = make_point(
                    s.context, {.side = side, .target_world = target, .flexion_rad = flexion});
                s.end_of(*made.movement);
                const Transform hand = s.hand(side);
                CHECK(s.worst_excess() < 1e-6);
                if (made.residual_m < 1e-6) {
                    ++met;
                    CHECK(off(rotate(hand.rotation, {out, 0, 0}), hand.translation, target) < 2e-3);
                    const Quat elbow = s.pose.parent_from_joint[arm.elbow.value].rotation;
                    bent += std::fabs(angle_of(elbow) - flexion) < 1e-3;
                }
            }
        }
    }
    CHECK(met > 120);
    CHECK(bent > 90);
}

TEST_CASE("a lifted elbow is lifted [unit]") {
    Stage s;
    double before = 0;
    for (const double elbow : {-0.2, 0.3, 0.8}) {
        const ArmMovement made = make_reach(s.context, {.side = Side::kRight,
                                                        .target_world = s.place({-0.2, 1.2, 0.35}),
                                                        .fingers_to_world = s.place({0.1, 1.2, 2}),
                                                        .elbow_rad = elbow});
        s.end_of(*made.movement);
        const double height = s.world[s.f.arms[1].elbow.value].translation.y;
        if (elbow > -0.1) {
            CHECK(height > before + 0.01);
        }
        before = height;
    }
}

TEST_CASE(
    "a figure that looks has its target in the middle of its eyes, with a share of the trunk "
    "[law]") {
    Stage s;
    for (int i = 0; i < 20; ++i) {
        const double yaw = -1.2 + 0.12 * i;
        const Vec3 target = s.place({3 * std::sin(yaw), 0.6 + 0.1 * i, 3 * std::cos(yaw)});
        const LookMovement made = make_look(s.context, {.target_world = target});
        CHECK(made.residual_rad < 1e-6);
        s.end_of(*made.movement);
        const Transform& head = s.world[s.f.head.value];
        CHECK(off(rotate(head.rotation, {0, 0, 1}), head * s.f.eyes_head, target) < 0.02);
        CHECK(s.worst_excess() < 1e-6);
        const double chest = turn_between(0.4, heading_of(s.world[s.f.upper_chest.value].rotation));
        if (std::fabs(yaw) > 0.3) {
            CHECK(chest / yaw > 0.15);
            CHECK(chest / yaw < 0.5);
        }
    }
    // Behind the back: as far as it goes, and it is told.
    const LookMovement made = make_look(s.context, {.target_world = s.place({0.1, 1.5, -3})});
    CHECK(made.residual_rad > 0.3);
    s.end_of(*made.movement);
    CHECK(s.worst_excess() < 1e-6);
}
