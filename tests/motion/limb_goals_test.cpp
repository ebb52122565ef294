// SPDX-License-Identifier: MIT
// Aiming, pointing, partial rotations, blocked goals, the elbow, paths through singular places.
#include <doctest/doctest.h>

#include <cmath>

#include "puppetri/figure/mannequin.h"
#include "puppetri/motion/limb_track.h"
#include "random_limbs.h"
#include "support/count_allocations.h"

using namespace puppetri;
using namespace puppetri::motion;
using test::LimbSource;

namespace {

double ray_miss(const LimbShape& shape, const LimbGoal& goal, const LimbPose& pose) {
    const Transform hand = parent_from_end(shape, pose);
    const Vec3 tip = hand * goal.tip_end, axis = rotate(hand.rotation, normalized(goal.axis_end)),
               to = goal.position_parent - tip;
    return length(to - axis * std::fmax(0, dot(to, axis)));
}

LimbShape arm() { return limb_shape(figure::make_mannequin(1.75), Limb::kRightArm); }

}  // namespace

TEST_CASE("aiming with a given flexion passes the ray through the target at every swivel [law]") {
    LimbSource random(1);
    int hits = 0;
    for (int i = 0; i < 3000; ++i) {
        const LimbShape shape = random.shape({.limits = i % 2 == 0, .crooked = i % 3 == 0});
        const LimbIk ik(shape);
        const LimbPose pose = random.pose(shape);
        LimbGoal goal{.kind = LimbGoalKind::kAim,
                      .axis_end = random.direction(),
                      .tip_end = random.vector() * 0.1,
                      .end_rotation = pose.end,
                      .hinge_rad = hinge_angle(shape, pose),
                      .swivel_zero_parent = random.direction()};
        const Transform hand = parent_from_end(shape, pose);
        goal.position_parent =
            hand * goal.tip_end + rotate(hand.rotation, goal.axis_end) * random.between(0, 3);
        std::array<LimbFamily, kMaxLimbFamilies> families;
        const int count = ik.families(goal, families);
        for (int f = 0; f < count; ++f) {
            const LimbPose p = ik.at(families[f], random.circle());
            CHECK(families[f].residual_m == 0);
            CHECK(ray_miss(shape, goal, p) < 1e-9);
            CHECK(std::fabs(turn_between(hinge_angle(shape, p), goal.hinge_rad)) < 1e-7);
            ++hits;
        }
    }
    CHECK(hits > 3000);
}

TEST_CASE(
    "aiming with a free flexion finds the hinge's angle nearest to the wanted one that hits "
    "[oracle]") {
    LimbSource random(2);
    int given = 0, found = 0, none = 0;
    for (int i = 0; i < 400; ++i) {
        const LimbShape shape = random.shape({.limits = i % 2 == 0, .crooked = i % 3 == 0});
        const LimbIk ik(shape);
        LimbGoal goal{
            .kind = LimbGoalKind::kAim,
            .position_parent = shape.start + random.direction() * random.between(0.02, 0.6),
            .axis_end = random.direction(),
            .tip_end = random.vector() * 0.1,
            .end_rotation = random.inside(shape.end_limit),
            .hinge_rad = hinge_angle(shape, random.pose(shape)),
            .hinge_given = false};
        std::array<LimbFamily, kMaxLimbFamilies> families;
        ik.families(goal, families);
        const LimbPose pose = ik.at(families[0], random.circle());
        const double angle = hinge_angle(shape, pose);
        CHECK(std::fabs(ray_miss(shape, goal, pose) - families[0].residual_m) < 1e-9);
        CHECK(figure::limit_excess_rad(shape.hinge, pose.hinge) < 1e-9);
        // The scan of 1 440 angles of the hinge.
        const bool limited = shape.hinge.kind == figure::LimitKind::kHinge;
        const double lo = limited ? shape.hinge.lo_rad : -kPi,
                     hi = limited ? shape.hinge.hi_rad : kPi;
        double nearest = 100, least = 100;
        for (int k = 0; k <= 1440; ++k) {
            LimbGoal fixed = goal;
            fixed.hinge_given = true;
            fixed.hinge_rad = lo + (hi - lo) * k / 1440;
            ik.families(fixed, families);
            least = std::fmin(least, families[0].residual_m);
            if (families[0].residual_m < 1e-9) {
                nearest =
                    std::fmin(nearest, std::fabs(turn_between(goal.hinge_rad, fixed.hinge_rad)));
            }
        }
        const double way = std::fabs(turn_between(goal.hinge_rad, angle));
        if (way < 1e-9) {
            ++given;
        } else if (nearest < 100) {
            ++found;
            CHECK(ray_miss(shape, goal, pose) < 1e-7);
            CHECK(way < nearest + 1e-9);
        } else {
            ++none;
            CHECK(ray_miss(shape, goal, pose) < least + 1e-9);
        }
    }
    CHECK(given > 30);
    CHECK(found > 30);
    CHECK(none > 5);
}

TEST_CASE("pointing makes the axis of the hand parallel to the direction [law]") {
    LimbSource random(3);
    for (int i = 0; i < 2000; ++i) {
        const LimbShape shape = random.shape({.limits = true, .crooked = i % 2 == 0});
        const LimbIk ik(shape);
        const LimbPose pose = random.pose(shape);
        const LimbGoal goal{.kind = LimbGoalKind::kPoint,
                            .direction_parent = random.direction() * 3,
                            .axis_end = random.direction() * 2,
                            .end_rotation = pose.end,
                            .hinge_rad = hinge_angle(shape, pose)};
        std::array<LimbFamily, kMaxLimbFamilies> families;
        REQUIRE(ik.families(goal, families) == 1);
        const LimbPose p = ik.at(families[0], random.circle());
        const Transform hand = parent_from_end(shape, p);
        CHECK(length(cross(rotate(hand.rotation, goal.axis_end), goal.direction_parent)) < 1e-12);
        CHECK(dot(rotate(hand.rotation, goal.axis_end), goal.direction_parent) > 0);
    }
}

TEST_CASE("a partial rotation holds one axis of the hand and leaves its roll free [law]") {
    LimbSource random(4);
    int solved = 0;
    for (int i = 0; i < 600; ++i) {
        const LimbShape shape = random.shape({.limits = true, .crooked = i % 2 == 0});
        const LimbIk ik(shape);
        const LimbPose pose = random.pose(shape);
        const Transform hand = parent_from_end(shape, pose);
        // The twist axis of the wrist, or any axis with a tip beside it.
        const bool along = i % 3 != 0;
        const Vec3 axis = along ? shape.end_limit.axis_joint : random.direction(),
                   tip = along ? axis * 0.08 : random.vector() * 0.1;
        const LimbGoal goal{.kind = LimbGoalKind::kDirection,
                            .position_parent = hand * tip,
                            .direction_parent = rotate(hand.rotation, axis),
                            .axis_end = axis,
                            .tip_end = tip};
        const LimbSolution s = ik.solve(goal, {.rule = SwivelRule::kMiddle});
        const Transform got = parent_from_end(shape, s.pose);
        CHECK(figure::limit_excess_rad(shape.start_limit, s.pose.start) < 1e-7);
        CHECK(figure::limit_excess_rad(shape.end_limit, s.pose.end) < 1e-7);
        const double off =
            std::acos(std::fmin(1, dot(rotate(got.rotation, axis), goal.direction_parent)));
        CHECK(off == doctest::Approx(s.residual_rad).epsilon(1e-3));
        CHECK(length(got * tip - goal.position_parent) ==
              doctest::Approx(s.residual_m).epsilon(1e-6));
        const bool met = s.residual_m < 1e-9 && s.residual_rad < 1e-7;
        solved += met;
        if (along) {
            CHECK(met);  // the pose itself is one
        }
    }
    CHECK(solved > 520);
}

TEST_CASE(
    "a goal out of reach is projected: as far or as near as the hinge lets the limb, on the line "
    "to it [unit]") {
    LimbShape shape{.upper = {0.3, 0, 0},
                    .lower = {0.25, 0, 0},
                    .hinge = {.kind = figure::LimitKind::kHinge,
                              .axis_joint = {0, 0, 1},
                              .lo_rad = 0.2,
                              .hi_rad = 2.5}};
    const LimbIk ik(shape);
    // Law of cosines.
    const auto reach = [](double bend) {
        return std::sqrt(0.09 + 0.0625 + 2 * 0.3 * 0.25 * std::cos(bend));
    };
    CHECK(ik.farthest_m() == doctest::Approx(reach(0.2)));
    CHECK(ik.nearest_m() == doctest::Approx(reach(2.5)));
    const Vec3 direction = normalized(Vec3{1, 2, -2});
    for (const double distance : {0.02, 0.1, 0.3, 0.549, 0.6, 5.0}) {
        const LimbSolution s = ik.solve({.position_parent = direction * distance}, {});
        const Vec3 at = parent_from_end(shape, s.pose).translation;
        const double got = clamp(distance, reach(2.5), reach(0.2));
        CHECK(length(at - direction * got) < 1e-9);
        CHECK(s.residual_m == doctest::Approx(std::fabs(distance - got)));
    }
}

TEST_CASE(
    "a blocked goal is approached within limits about as near as the best of 20 000 poses, and the "
    "residual is true [oracle]") {
    LimbSource random(5);
    int blocked = 0;
    for (int i = 0; i < 60; ++i) {
        const LimbShape shape = random.shape({.limits = true});
        const LimbIk ik(shape);
        const Vec3 target = shape.start + random.direction() * random.between(0.1, 0.7);
        const LimbSolution s = ik.solve({.position_parent = target}, {});
        const double miss = length(parent_from_end(shape, s.pose).translation - target);
        CHECK(std::fabs(miss - s.residual_m) < 1e-9);
        CHECK(figure::limit_excess_rad(shape.start_limit, s.pose.start) < 1e-9);
        CHECK(figure::limit_excess_rad(shape.hinge, s.pose.hinge) < 1e-9);
        double least = 10;
        for (int k = 0; k < 20000; ++k) {
            least = std::fmin(
                least, length(parent_from_end(shape, random.pose(shape)).translation - target));
        }
        CHECK(miss < 1.02 * least + 2e-3);
        blocked += miss > 1e-6;
    }
    CHECK(blocked > 20);
}

TEST_CASE(
    "a hand that cannot turn so far keeps its place and tells the angle that is missing [unit]") {
    const LimbShape shape = arm();
    const LimbIk ik(shape);
    LimbSource random(6);
    int refused = 0;
    for (int i = 0; i < 300; ++i) {
        const Transform hand = parent_from_end(shape, random.pose(shape));
        const LimbGoal goal{.kind = LimbGoalKind::kPose,
                            .position_parent = hand.translation,
                            .rotation_parent = random.rotation()};
        const LimbSolution s = ik.solve(goal, {.rule = SwivelRule::kMiddle});
        const Transform got = parent_from_end(shape, s.pose);
        CHECK(length(got.translation - hand.translation) < 1e-7);
        CHECK(angle_between(got.rotation, goal.rotation_parent) ==
              doctest::Approx(s.residual_rad).epsilon(1e-6));
        refused += s.residual_rad > 0.01;
    }
    CHECK(refused > 50);
}

TEST_CASE("elbow to swivel and back; the elbow comes as near to a point as the arcs allow [law]") {
    LimbSource random(7);
    for (int i = 0; i < 2000; ++i) {
        const LimbShape shape = random.shape({.crooked = i % 2 == 0});
        const LimbIk ik(shape);
        const Transform hand = parent_from_end(shape, random.pose(shape));
        std::array<LimbFamily, kMaxLimbFamilies> families;
        const int count = ik.families(
            {.position_parent = hand.translation, .swivel_zero_parent = random.direction()},
            families);
        for (int f = 0; f < count; ++f) {
            const CirclePoint x = random.circle();
            const Vec3 elbow = ik.elbow_at(families[f], x);
            CHECK(length(elbow - elbow_parent(shape, ik.at(families[f], x))) < 1e-12);
            const Vec3 line = families[f].axis_parent, arm_way = elbow - shape.start;
            if (length(arm_way - line * dot(arm_way, line)) > 1e-3) {
                CHECK(std::fabs(radians_of(ik.swivel_of_elbow(families[f], elbow) * conjugate(x))) <
                      1e-9);
            }
        }
    }
    // With a hinge across the bones swivel 0 has the elbow where it is told.
    const LimbShape shape = arm();
    const LimbIk ik(shape);
    const Vec3 target = shape.start + Vec3{-0.2, -0.1, 0.3};
    std::array<LimbFamily, kMaxLimbFamilies> families;
    ik.families({.position_parent = target, .swivel_zero_parent = {0, -1, 0}}, families);
    const Vec3 elbow = ik.elbow_at(families[0], {}) - shape.start;
    const Vec3 line = normalized(target - shape.start);
    CHECK(normalized(elbow - line * dot(elbow, line)).y ==
          doctest::Approx(normalized(Vec3{0, -1, 0} - line * -line.y).y));
}

TEST_CASE("an objective is minimized over all arcs [oracle]") {
    LimbSource random(8);
    for (int i = 0; i < 60; ++i) {
        const LimbShape shape = random.shape({.limits = true});
        const LimbIk ik(shape);
        const Transform hand = parent_from_end(shape, random.pose(shape));
        const LimbGoal goal{.kind = LimbGoalKind::kPose,
                            .position_parent = hand.translation,
                            .rotation_parent = hand.rotation};
        const struct {
            const LimbShape& shape;
            Vec3 a, b;
        } wish{shape, random.direction(), random.direction()};
        const auto cost = [](const void* self, const LimbPose& pose) {
            const auto& w = *static_cast<decltype(wish)*>(self);
            const Vec3 e = elbow_parent(w.shape, pose) - w.shape.start;
            return std::sin(9 * dot(e, w.a)) + dot(e, w.b);
        };
        const LimbSolution s =
            ik.solve(goal, {.rule = SwivelRule::kObjective, .cost = cost, .self = &wish});
        SwivelIntervals arcs;
        ik.intervals(goal, arcs);
        double least = 10;
        for (int k = 0; k < arcs.count; ++k) {
            for (int n = 0; n <= 500; ++n) {
                const Arc& arc = arcs.intervals[k].arc;
                const CirclePoint x = arc.from * circle_point(length_rad(arc) * n / 500);
                least = std::fmin(least,
                                  cost(&wish, ik.at(arcs.families[arcs.intervals[k].family], x)));
            }
        }
        CHECK(cost(&wish, s.pose) < least + 1e-9);
    }
}

namespace {

// The largest turn per step along a path of targets, for a limb that follows it.
template <class Path>
double largest_step(const LimbShape& shape, const Path& path, int steps, LimbGoalKind kind,
                    double* worst_residual = nullptr) {
    const LimbIk ik(shape);
    LimbTrack track;
    double most = 0;
    for (int i = 0; i <= steps; ++i) {
        const LimbGoal goal{.kind = kind, .position_parent = path(double(i) / steps)};
        const LimbStep step = follow(ik, goal, track);
        if (i > 0) {
            most = std::fmax(most, step.moved_rad);
        }
        if (worst_residual != nullptr) {
            *worst_residual = std::fmax(*worst_residual, step.solution.residual_m);
        }
    }
    return most;
}

}  // namespace

TEST_CASE(
    "a limb follows its target through straight, out of reach and back without a jump [law]") {
    LimbShape shape{.upper = {0.3, 0, 0},
                    .lower = {0.25, 0, 0},
                    .hinge = {.kind = figure::LimitKind::kHinge,
                              .axis_joint = {0, 0, 1},
                              .lo_rad = 0,
                              .hi_rad = 2.6}};
    // Out and back in along a curve: 0.4 to 0.75 of 0.55.
    const auto out = [](double r) {
        const double d = 0.4 + 0.35 * std::sin(kPi * r);
        return Vec3{d * std::cos(r), d * std::sin(r) * 0.6, d * std::sin(r) * 0.8};
    };
    // At full reach the hinge's angle goes like the square root of the way: 4 000 steps of 0.3 mm,
    // sqrt(2 * 0.3 mm * 0.55 / (0.3 * 0.25)) = 0.07.
    CHECK(largest_step(shape, out, 4000, LimbGoalKind::kPosition) < 0.08);
    CHECK(largest_step(shape, out, 16000, LimbGoalKind::kPosition) < 0.04);
}

TEST_CASE("a target that runs through the first joint moves the limb without a jump [law]") {
    LimbShape shape{.upper = {0.3, 0, 0},
                    .lower = {0.25, 0, 0},
                    .hinge = {.kind = figure::LimitKind::kHinge,
                              .axis_joint = {0, 0, 1},
                              .lo_rad = 0,
                              .hi_rad = 2.6}};
    for (const double aside : {0.0, 1e-9, 1e-4, 0.01}) {
        const auto through = [&](double r) { return Vec3{0.5 - r, aside, 0}; };
        CHECK(largest_step(shape, through, 4000, LimbGoalKind::kPosition) < 0.03);
        CHECK(largest_step(shape, through, 16000, LimbGoalKind::kPosition) < 0.012);
    }
    // Equal bones that fold: the wrist itself runs through the shoulder.
    LimbShape folding{.upper = {0.3, 0, 0},
                      .lower = {0.3, 0, 0},
                      .hinge = {.kind = figure::LimitKind::kFree, .axis_joint = {0, 0, 1}}};
    double residual = 0;
    const auto through = [](double r) { return Vec3{0.4 - 0.8 * r, 0, 0}; };
    CHECK(largest_step(folding, through, 4001, LimbGoalKind::kPosition, &residual) < 0.02);
    CHECK(residual < 1e-9);
}

TEST_CASE(
    "a limb follows random paths through the swivel's zero direction and around limits [law]") {
    LimbSource random(9);
    int jumps = 0, paths = 0;
    for (int i = 0; i < 60; ++i) {
        const LimbShape shape =
            i % 2 == 0 ? random.shape({.limits = true, .crooked = i % 4 == 0}) : arm();
        // What follows has a little more room than what makes the path, which often runs along two
        // limits at once and leaves single swivels.
        LimbShape wide = shape;
        for (figure::JointLimit* limit : {&wide.start_limit, &wide.end_limit, &wide.hinge}) {
            limit->swing_side_rad += 0.03;
            limit->swing_other_rad += 0.03;
            limit->lo_rad -= 0.03;
            limit->hi_rad += 0.03;
        }
        const LimbIk ik(wide);
        // A smooth path of poses that the limb itself makes.
        const LimbPose a = random.pose(shape), b = random.pose(shape);
        LimbTrack track{a, {}, false};
        const int steps = 3000;
        bool jumped = false, leaps = false;
        LimbPose last = a;
        for (int k = 0; k <= steps; ++k) {
            const double r = double(k) / steps;
            const LimbPose p{figure::clamp_to_limit(shape.start_limit, slerp(a.start, b.start, r)),
                             figure::clamp_to_limit(shape.hinge, slerp(a.hinge, b.hinge, r)),
                             figure::clamp_to_limit(shape.end_limit, slerp(a.end, b.end, r))};
            const Transform hand = parent_from_end(shape, p);
            if (k == 0) {
                track = {p, normalized(hand.translation - shape.start), true};
            } else {  // clamping itself may leap from one end of a range to the other
                leaps = leaps || angle_between(p.start, last.start) > 0.05 ||
                        angle_between(p.end, last.end) > 0.05;
            }
            last = p;
            const LimbStep step = follow(ik,
                                         {.kind = LimbGoalKind::kPose,
                                          .position_parent = hand.translation,
                                          .rotation_parent = hand.rotation},
                                         track);
            CHECK(step.solution.residual_m < 1e-9);
            CHECK(length(parent_from_end(shape, step.solution.pose).translation -
                         hand.translation) < 1e-9);
            jumped = jumped || step.moved_rad > 0.3;
        }
        jumps += jumped && !leaps;
        paths += !leaps;
    }
    // An arc may end for good: then it must jump.
    CHECK(paths > 40);
    CHECK(jumps * 12 < paths);
}

TEST_CASE("solving, choosing and following allocate nothing [alloc]") {
    LimbSource random(10);
    const LimbShape shape = arm();
    const LimbIk ik(shape);
    LimbTrack track;
    SwivelIntervals arcs;
    for (int i = 0; i < 200; ++i) {
        const Transform hand = parent_from_end(shape, random.pose(shape));
        const LimbGoal goal{.kind = LimbGoalKind::kPose,
                            .position_parent = hand.translation * (i % 5 == 0 ? 2.0 : 1.0),
                            .rotation_parent = hand.rotation};
        const auto before = test::allocations();
        ik.intervals(goal, arcs);
        ik.solve(goal, {.rule = SwivelRule::kMiddle});
        ik.solve_free(goal, {});
        follow(ik, goal, track);
        CHECK(test::allocations() == before);
    }
}

TEST_CASE("bad limbs are told by name: no length, no bend, wrong limits [unit]") {
    const auto code = [](const LimbShape& shape) {
        const Status status = check(shape, "left_arm");
        return status.has_value() ? std::string() : status.error()[0].code;
    };
    const LimbShape good = arm();
    CHECK(code(good) == "");
    LimbShape bad = good;
    bad.lower = {};
    CHECK(code(bad) == "zero-length-bone");
    bad.lower = {std::nan(""), 0, 0};
    CHECK(code(bad) == "zero-length-bone");
    bad = good;
    bad.hinge.lo_rad = 2;
    bad.hinge.hi_rad = 1;
    CHECK(code(bad) == "limit-order");
    bad = good;
    bad.start_limit.swing_side_rad = 0;
    CHECK(code(bad) == "limit-swing");
    bad = good;
    bad.end_limit.axis_joint = {1, 1, 0};
    CHECK(code(bad) == "limit-axis");
    bad = good;
    bad.end_limit.hi_rad = 1e300;
    CHECK(code(bad) == "limit-range");
    bad = good;
    bad.hinge.axis_joint = {1, 0, 0};
    CHECK(code(bad) == "stiff-limb");
    bad = good;
    bad.start_limit = good.hinge;
    CHECK(code(bad) == "limb-limit");
    bad = good;
    bad.start_limit.parent_from_centre = {0, 0, 0, 2};
    CHECK(code(bad) == "limit-centre");
    const Status status = check(bad, "left_arm");
    for (const Diagnostic& d : status.error()) {
        CHECK(d.element == "left_arm.start");
        CHECK(!d.remedy.empty());
    }
}
