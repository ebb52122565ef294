// SPDX-License-Identifier: MIT
// Several goals at once on any skeleton, with priorities: a goal moves the figure only in ways that
// leave the goals of higher priority as they are. For what analytic solvers do not cover: two hands
// on one box while the gaze and a foot stay, a spider's body over eight feet.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "puppetri/figure/limits.h"

namespace puppetri::motion {

enum class SkeletonGoalKind : std::uint8_t { kPosition, kRotation, kDirection };

struct SkeletonGoal {
    SkeletonGoalKind kind = SkeletonGoalKind::kPosition;
    figure::JointIndex joint;
    Vec3 point_joint = {};  // kPosition: the point that goes to position_model
    Vec3 position_model = {};
    Quat rotation_model = {};     // kRotation
    Vec3 axis_joint = {0, 0, 1};  // kDirection: unit axis that shall point along direction_model
    Vec3 direction_model = {0, 0, 1};
    int priority = 0;   // 0 comes first; equal ones are weighed against each other
    double weight = 1;  // > 0
};

struct GoalStack {
    const figure::Skeleton& skeleton;
    std::span<const figure::JointLimit> limits;   // one per joint, or empty
    std::span<const figure::JointIndex> movable;  // joints that may turn, in ascending order
    bool root_moves = false;                      // joint 0 may also be shifted
    std::span<const SkeletonGoal> goals;
    int rounds = 60;
    double damping =
        0.02;  // in metres and radians: larger is calmer near singular poses, and slower
    double tolerance = 1e-6;
};

// Memory that grows to what the largest stack needed; results do not depend on it.
struct GoalScratch {
    std::vector<double> numbers;
    std::vector<Transform> model_from_joint;
    std::vector<std::uint32_t> order;
};

struct GoalOutcome {
    int rounds = 0;
    double worst_m = 0, worst_rad = 0;  // over all goals
};

// Starts from the pose and changes its movable joints.
// Gives   joints within their limits. A hinge turns about its axis alone. Goals of one priority
// that
//         contradict each other are compromised in the sense of weighted least squares.
// Cost    per round O(n^2 m) for n degrees of freedom and m goal coordinates; no allocation once
//         the scratch has grown.
// Source  damped pseudo-inverses in the null space of all higher priorities: Siciliano and Slotine,
//         "A general framework for managing multiple tasks" (ICAR 1991); limits as in Baerlocher
//         and Boulic, "An inverse kinematics architecture enforcing an arbitrary number of strict
//         priority levels" (The Visual Computer 20 (2004) 402-417): a degree of freedom that would
//         leave its range is taken out and the step is made again.
GoalOutcome solve_goals(const GoalStack& stack, figure::Pose& pose, GoalScratch& scratch);

}  // namespace puppetri::motion
