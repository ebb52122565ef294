// SPDX-License-Identifier: MIT
// The seven-degree limb: goals against forward kinematics on random limbs of any hinge and
// proportion, its singular places, its check.
#include "puppetri/motion/limb_ik.h"

#include <doctest/doctest.h>

#include "puppetri/math/rotation.h"
#include "random_limbs.h"

using namespace puppetri;
using namespace puppetri::motion;
using test::LimbSource;

TEST_CASE("every family of a pose goal meets it exactly, at every swivel, for any limb [law]") {
    LimbSource random(1);
    int two = 0;
    for (int i = 0; i < 4000; ++i) {
        const LimbShape shape = random.shape({.limits = i % 2 == 0, .crooked = i % 3 == 0});
        const LimbIk ik(shape);
        const Transform wanted = parent_from_end(shape, random.pose(shape));
        const Vec3 tip = random.vector() * 0.1;
        const LimbGoal goal{.kind = LimbGoalKind::kPose,
                            .position_parent = wanted * tip,
                            .rotation_parent = wanted.rotation,
                            .tip_end = tip,
                            .swivel_zero_parent = random.vector()};
        std::array<LimbFamily, kMaxLimbFamilies> families;
        const int count = ik.families(goal, families);
        REQUIRE(count > 0);
        two += count == 2;
        for (int f = 0; f < count; ++f) {
            const LimbPose pose = ik.at(families[f], random.circle());
            const Transform hand = parent_from_end(shape, pose);
            CHECK(length(hand * tip - goal.position_parent) < 1e-9);
            CHECK(angle_between(hand.rotation, wanted.rotation) < 1e-9);
            CHECK(families[f].residual_m < 1e-9);
            CHECK(figure::limit_excess_rad(shape.hinge, pose.hinge) < 2e-8);
        }
    }
    CHECK(two > 500);
}

namespace {

// The same question asked the slow way: is the limb at this swivel within the limits of its balls?
bool allowed_by_clamping(const LimbShape& shape, const LimbPose& pose, double room_rad) {
    return figure::limit_excess_rad(shape.start_limit, pose.start) <= room_rad &&
           figure::limit_excess_rad(shape.end_limit, pose.end) <= room_rad;
}

bool in_intervals(const SwivelIntervals& s, int family, CirclePoint x) {
    for (int i = 0; i < s.count; ++i) {
        if (s.intervals[i].family == family && contains(s.intervals[i].arc, x)) {
            return true;
        }
    }
    return false;
}

// How far a point is from the nearest end of an arc.
double from_border(const SwivelIntervals& s, int family, CirclePoint x) {
    double least = 7;
    for (int i = 0; i < s.count; ++i) {
        if (s.intervals[i].family == family && !s.intervals[i].arc.full) {
            for (const CirclePoint& end : {s.intervals[i].arc.from, s.intervals[i].arc.to}) {
                least = std::fmin(least, std::fabs(radians_of(x * conjugate(end))));
            }
        }
    }
    return least;
}

void compare_with_scan(LimbSource& random, int limbs, int angles, LimbGoalKind kind) {
    int inside = 0, outside = 0, with_several = 0;
    for (int i = 0; i < limbs; ++i) {
        LimbShape shape = random.shape({.limits = true, .crooked = i % 2 == 0});
        LimbPose pose = random.pose(shape);
        LimbGoal goal{.kind = kind, .swivel_zero_parent = random.direction()};
        if (kind == LimbGoalKind::kDirection) {
            goal.axis_end = shape.end_limit.axis_joint * (i % 3 == 0 ? -1.0 : 1.0);
        } else {
            goal.axis_end = random.direction();
        }
        goal.end_rotation = pose.end;
        goal.hinge_rad = hinge_angle(shape, pose);
        if (kind == LimbGoalKind::kPosition) {
            goal.tip_end = random.vector() * 0.1;
        }
        const Transform hand = parent_from_end(shape, pose);
        goal.position_parent = hand * goal.tip_end;
        goal.rotation_parent = hand.rotation;
        goal.direction_parent = rotate(hand.rotation, normalized(goal.axis_end));
        if (kind == LimbGoalKind::kAim) {
            goal.position_parent = hand.translation + goal.direction_parent * random.between(0, 2);
        }
        const LimbIk ik(shape);
        SwivelIntervals s;
        ik.intervals(goal, s);
        with_several += s.count > 1;
        const double turn = random.unit();
        for (int f = 0; f < s.family_count; ++f) {
            for (int k = 0; k < angles; ++k) {
                const CirclePoint x = circle_point(2 * kPi * (k + turn) / angles);
                const LimbPose p = ik.at(s.families[f], x);
                const bool found = in_intervals(s, f, x);
                if (allowed_by_clamping(shape, p, 0) != found && from_border(s, f, x) > 1e-7) {
                    // Two arcs that touch in one point may be told as one.
                    CHECK(found);
                    CHECK(allowed_by_clamping(shape, p, 1e-9));
                }
                found ? ++inside : ++outside;
            }
        }
    }
    CHECK(inside > 20 * limbs);
    CHECK(outside > 20 * limbs);
    CHECK(with_several > limbs / 20);
}

}  // namespace

TEST_CASE(
    "the intervals of swivels are those of a scan of 720 angles, for every kind of goal [oracle]") {
    LimbSource random(2);
    for (const LimbGoalKind kind :
         {LimbGoalKind::kPose, LimbGoalKind::kPosition, LimbGoalKind::kDirection,
          LimbGoalKind::kAim, LimbGoalKind::kPoint}) {
        CAPTURE(static_cast<int>(kind));
        compare_with_scan(random, 150, 720, kind);
    }
}

TEST_CASE("the intervals of swivels are those of a scan of 7 200 angles [oracle]") {
    LimbSource random(3);
    compare_with_scan(random, 60, 7200, LimbGoalKind::kPose);
}

TEST_CASE("what a pose within limits reaches is solved within limits, by every rule [law]") {
    LimbSource random(4);
    for (int i = 0; i < 3000; ++i) {
        LimbShape shape = random.shape({.limits = true, .crooked = i % 2 == 0});
        const LimbPose pose = random.pose(shape);
        const bool border = i % 5 == 0;
        if (!border) {  // many random poses lie on the border of their limits; now none does
            for (figure::JointLimit* limit : {&shape.start_limit, &shape.end_limit}) {
                limit->swing_side_rad += 0.01;
                limit->swing_other_rad += 0.01;
                limit->lo_rad -= 0.01;
                limit->hi_rad += 0.01;
            }
        }
        const LimbIk ik(shape);
        const Transform hand = parent_from_end(shape, pose);
        const LimbGoal goal{.kind = LimbGoalKind::kPose,
                            .position_parent = hand.translation,
                            .rotation_parent = hand.rotation};
        for (const SwivelRule rule : {SwivelRule::kNearest, SwivelRule::kMiddle,
                                      SwivelRule::kLeastMotion, SwivelRule::kElbow}) {
            const LimbSolution s = ik.solve(goal, {.rule = rule,
                                                   .swivel = random.circle(),
                                                   .from = pose,
                                                   .elbow_parent = elbow_parent(shape, pose)});
            const Transform got = parent_from_end(shape, s.pose);
            CHECK(length(got.translation - hand.translation) < 1e-9);
            CHECK(angle_between(got.rotation, hand.rotation) < 1e-9);
            CHECK(allowed_by_clamping(shape, s.pose, 1e-7));
            CHECK(s.residual_m < 1e-9);
            CHECK(s.residual_rad < 1e-9);
            if (!border && (rule == SwivelRule::kLeastMotion || rule == SwivelRule::kElbow)) {
                // The pose it comes from is itself a solution.
                CHECK(length(elbow_parent(shape, s.pose) - elbow_parent(shape, pose)) < 1e-6);
            }
        }
    }
}
