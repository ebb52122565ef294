// SPDX-License-Identifier: MIT
// Chains, looking with several joints, stacks of goals.
#include "puppetri/motion/chain_ik.h"

#include <doctest/doctest.h>

#include <algorithm>

#include "puppetri/figure/mannequin.h"
#include "puppetri/math/rotation.h"
#include "puppetri/motion/goal_stack.h"
#include "random_limbs.h"
#include "support/count_allocations.h"

using namespace puppetri;
using namespace puppetri::motion;
using figure::JointIndex;
using test::LimbSource;

namespace {

// A tail of so many joints, 0.1 m each, along +Z; every joint bends by up to `cone_rad`.
struct Tail {
    figure::Skeleton skeleton;
    std::vector<figure::JointLimit> limits;
    std::vector<JointIndex> joints;
    figure::Pose pose;

    Tail(int count, double cone_rad) {
        for (int i = 0; i < count; ++i) {
            const auto index = static_cast<std::uint32_t>(i);
            skeleton.joints.push_back({"tail" + std::to_string(i),
                                       i == 0 ? JointIndex{} : JointIndex{index - 1},
                                       {{}, {0, 0, i == 0 ? 0.0 : 0.1}},
                                       {0, 0, 0.1}});
            limits.push_back({.kind = figure::LimitKind::kCone,
                              .axis_joint = {0, 0, 1},
                              .side_joint = {1, 0, 0},
                              .lo_rad = -0.3,
                              .hi_rad = 0.3,
                              .swing_side_rad = cone_rad,
                              .swing_other_rad = cone_rad});
            joints.push_back({index});
        }
        pose = figure::rest_pose(skeleton);
    }
    ChainView view() const { return {skeleton, limits, joints}; }
    Vec3 tip(const figure::Pose& p) const {
        std::vector<Transform> model(skeleton.joints.size());
        figure::to_model_space(skeleton, p, model);
        return model.back() * Vec3{0, 0, 0.1};
    }
    double excess(const figure::Pose& p) const {
        double most = 0;
        for (std::size_t i = 0; i < limits.size(); ++i) {
            most = std::max(most,
                            figure::limit_excess_rad(limits[i], p.parent_from_joint[i].rotation));
        }
        return most;
    }
};

}  // namespace

TEST_CASE("a chain reaches what a pose within its limits reaches, and stays within them [law]") {
    LimbSource random(1);
    int exact = 0;
    for (int i = 0; i < 300; ++i) {
        Tail tail(4 + i % 9, 0.7);
        figure::Pose wanted = tail.pose;
        for (std::size_t j = 0; j < tail.limits.size(); ++j) {
            wanted.parent_from_joint[j].rotation =
                slerp({}, figure::clamp_to_limit(tail.limits[j], random.rotation()), 0.8);
        }
        const Vec3 target = tail.tip(wanted);
        const ChainOutcome outcome = solve_chain(
            tail.view(), {.target_model = target, .tip_joint = {0, 0, 0.1}, .rounds = 400},
            tail.pose);
        CHECK(length(tail.tip(tail.pose) - target) == doctest::Approx(outcome.residual_m));
        CHECK(tail.excess(tail.pose) < 1e-9);
        exact += outcome.residual_m <= 1e-4;
        CHECK(outcome.residual_m < 0.05);
    }
    CHECK(exact > 290);
}

TEST_CASE("a chain straightens towards a target out of reach [unit]") {
    Tail tail(6, 0.9);
    const Vec3 target{2, 1, 2};
    const ChainOutcome outcome = solve_chain(
        tail.view(), {.target_model = target, .tip_joint = {0, 0, 0.1}, .rounds = 2000}, tail.pose);
    CHECK(outcome.residual_m == doctest::Approx(length(target) - 0.6).epsilon(1e-4));
}

TEST_CASE("a small change of the target is a small change of the chain [law]") {
    Tail tail(8, 0.8);
    figure::Pose before = tail.pose;
    for (int i = 0; i <= 400; ++i) {
        const double a = i * 0.005;
        solve_chain(tail.view(),
                    {.target_model = Vec3{0.5 * std::sin(a), 0.2 * std::sin(3 * a), 0.55},
                     .tip_joint = {0, 0, 0.1},
                     .share = 0.5},
                    tail.pose);
        if (i > 0) {
            for (std::size_t j = 0; j < tail.joints.size(); ++j) {
                CHECK(angle_between(before.parent_from_joint[j].rotation,
                                    tail.pose.parent_from_joint[j].rotation) < 0.08);
            }
        }
        before = tail.pose;
    }
}

TEST_CASE("spine, neck and head look at a target together, within their limits [law]") {
    const figure::Figure f = figure::make_mannequin(1.75);
    const std::array joints{f.spine, f.chest, f.upper_chest, f.neck, f.head};
    const std::array shares{0.1, 0.1, 0.15, 0.5, 1.0};
    const ChainView chain{f.skeleton, f.limits, joints};
    LimbSource random(2);
    std::vector<Transform> model(f.skeleton.joints.size());
    int seen = 0;
    for (int i = 0; i < 300; ++i) {
        figure::Pose pose = figure::rest_pose(f.skeleton);
        const double yaw = random.between(-1.9, 1.9), pitch = random.between(-0.6, 0.6);
        const Vec3 target = Vec3{std::sin(yaw) * std::cos(pitch), std::sin(pitch),
                                 std::cos(yaw) * std::cos(pitch)} *
                                3 +
                            Vec3{0, 1.6, 0};
        const auto before = test::allocations();
        const LookAtOutcome outcome = look_at(
            chain, {.target_model = target, .eye_joint = f.eyes_head, .shares = shares}, pose);
        CHECK(test::allocations() == before);
        figure::to_model_space(f.skeleton, pose, model);
        const Transform& head = model[f.head.value];
        const Vec3 way = normalized(target - head * f.eyes_head);
        const double off = std::acos(std::min(1.0, dot(way, rotate(head.rotation, {0, 0, 1}))));
        CHECK(off == doctest::Approx(outcome.residual_rad).epsilon(1e-3));
        CHECK(outcome.residual_rad < 1e-6);
        seen += outcome.residual_rad < 1e-6;
        for (const JointIndex joint : joints) {
            CHECK(figure::limit_excess_rad(f.limits[joint.value],
                                           pose.parent_from_joint[joint.value].rotation) < 1e-9);
        }
    }
    CHECK(seen == 300);
    // Half way, and not at all.
    figure::Pose pose = figure::rest_pose(f.skeleton);
    const Vec3 aside{3, 1.6, 3};
    const double whole =
        look_at(chain,
                {.target_model = aside, .eye_joint = f.eyes_head, .shares = shares, .weight = 0},
                pose)
            .residual_rad;
    CHECK(pose.parent_from_joint[f.head.value].rotation == Quat{});
    const double half =
        look_at(chain,
                {.target_model = aside, .eye_joint = f.eyes_head, .shares = shares, .weight = 0.5},
                pose)
            .residual_rad;
    CHECK(half == doctest::Approx(whole / 2).epsilon(0.02));
}

TEST_CASE("a stack of goals meets all that can be met together, within limits [law]") {
    const figure::Figure f = figure::make_mannequin(1.75);
    std::vector<JointIndex> movable;
    for (const JointIndex j : {f.hips, f.spine, f.chest, f.upper_chest}) {
        movable.push_back(j);
    }
    for (int side = 0; side < 2; ++side) {
        for (const JointIndex j : {f.arms[side].clavicle, f.arms[side].shoulder, f.arms[side].elbow,
                                   f.legs[side].hip, f.legs[side].knee, f.legs[side].ankle}) {
            movable.push_back(j);
        }
    }
    std::sort(movable.begin(), movable.end(),
              [](JointIndex a, JointIndex b) { return a.value < b.value; });
    LimbSource random(4);
    GoalScratch scratch;
    int solved = 0;
    constexpr int kTries = 60;
    for (int i = 0; i < kTries; ++i) {
        // What a pose within limits does can be asked for.
        figure::Pose wanted = figure::rest_pose(f.skeleton);
        for (const JointIndex j : movable) {
            Quat& q = wanted.parent_from_joint[j.value].rotation;
            const figure::JointLimit& limit = f.limits[j.value];
            q = figure::clamp_to_limit(
                limit, limit.kind == figure::LimitKind::kHinge
                           ? from_axis_angle(limit.axis_joint, random.between(0.2, 1.2))
                           : slerp({}, random.rotation(), 0.25));
        }
        std::vector<Transform> model(f.skeleton.joints.size());
        figure::to_model_space(f.skeleton, wanted, model);
        std::vector<SkeletonGoal> goals;
        for (int side = 0; side < 2; ++side) {
            const JointIndex ankle = f.legs[side].ankle, hand = f.arms[side].hand;
            goals.push_back(
                {.joint = ankle, .position_model = model[ankle.value].translation, .priority = 0});
            goals.push_back(
                {.joint = hand, .position_model = model[hand.value].translation, .priority = 1});
        }
        figure::Pose pose = figure::rest_pose(f.skeleton);
        for (int side = 0; side < 2; ++side) {  // not straight: there the way on is unknown
            pose.parent_from_joint[f.arms[side].elbow.value].rotation =
                from_axis_angle(f.limits[f.arms[side].elbow.value].axis_joint, 0.5);
            pose.parent_from_joint[f.legs[side].knee.value].rotation = about_x(0.3);
        }
        const GoalOutcome outcome = solve_goals({.skeleton = f.skeleton,
                                                 .limits = f.limits,
                                                 .movable = movable,
                                                 .root_moves = true,
                                                 .goals = goals,
                                                 .rounds = 300},
                                                pose, scratch);
        figure::to_model_space(f.skeleton, pose, model);
        double worst = 0;
        for (const SkeletonGoal& goal : goals) {
            worst =
                std::fmax(worst, length(model[goal.joint.value].translation - goal.position_model));
        }
        CHECK(worst == doctest::Approx(outcome.worst_m));
        solved += worst < 1e-4;
        for (const JointIndex j : movable) {
            CHECK(figure::limit_excess_rad(f.limits[j.value],
                                           pose.parent_from_joint[j.value].rotation) < 1e-9);
        }
    }
    CHECK(solved > kTries * 9 / 10);
}

TEST_CASE(
    "goals of lower priority do not disturb higher ones, equal ones compromise by weight [law]") {
    Tail tail(7, 1.2);
    for (std::size_t j = 0; j < tail.joints.size(); ++j) {
        tail.pose.parent_from_joint[j].rotation = about_x(0.15);
    }
    const Vec3 here{0.25, 0.1, 0.45}, there{-0.4, 0.3, 0.2};
    GoalScratch scratch;
    const auto solve = [&](int second_priority, double weight) {
        const SkeletonGoal goals[] = {
            {.joint = {6}, .point_joint = {0, 0, 0.1}, .position_model = here},
            {.joint = {6},
             .point_joint = {0, 0, 0.1},
             .position_model = there,
             .priority = second_priority,
             .weight = weight}};
        figure::Pose pose = tail.pose;
        const GoalStack stack{.skeleton = tail.skeleton,
                              .limits = tail.limits,
                              .movable = tail.joints,
                              .goals = goals,
                              .rounds = 400};
        solve_goals(stack, pose, scratch);
        const auto before = test::allocations();
        solve_goals(stack, pose, scratch);
        CHECK(test::allocations() == before);
        return tail.tip(pose);
    };
    CHECK(length(solve(1, 1) - here) < 1e-4);
    CHECK(length(solve(1, 100) - here) < 1e-4);
    const Vec3 even = solve(0, 1), heavy = solve(0, 4);
    CHECK(length(even - (here + there) * 0.5) < 0.02);
    CHECK(length(heavy - there) < length(heavy - here));
    // What is left free is used: the middle of the tail goes where it shall while the tip stays.
    const SkeletonGoal both[] = {
        {.joint = {6}, .point_joint = {0, 0, 0.1}, .position_model = here},
        {.joint = {3}, .position_model = {-0.05, 0.1, 0.25}, .priority = 1},
        {.kind = SkeletonGoalKind::kDirection,
         .joint = {6},
         .direction_model = {1, 0, 0},
         .priority = 2}};
    figure::Pose alone = tail.pose, together = tail.pose;
    const GoalStack one{.skeleton = tail.skeleton,
                        .limits = tail.limits,
                        .movable = tail.joints,
                        .goals = std::span(both).first(1),
                        .rounds = 400};
    GoalStack three{.skeleton = tail.skeleton,
                    .limits = tail.limits,
                    .movable = tail.joints,
                    .goals = both,
                    .rounds = 400};
    solve_goals(one, alone, scratch);
    solve_goals(three, together, scratch);
    std::vector<Transform> model(7), alone_model(7);
    figure::to_model_space(tail.skeleton, together, model);
    figure::to_model_space(tail.skeleton, alone, alone_model);
    CHECK(length(tail.tip(together) - here) < 1e-4);
    CHECK(length(model[3].translation - both[1].position_model) <
          length(alone_model[3].translation - both[1].position_model));
    CHECK(length(model[3].translation - both[1].position_model) < 1e-3);
}
