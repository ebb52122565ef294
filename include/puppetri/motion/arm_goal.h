// SPDX-License-Identifier: MIT
// A goal for an arm of a humanoid, answered with the handles that movements write: the limb's
// inverse kinematics in chest space, with a collar bone that follows the hand.
#pragma once
#include <optional>

#include "puppetri/motion/context.h"
#include "puppetri/motion/limb_ik.h"

namespace puppetri::motion {

struct ArmGoal {
    Side side = Side::kRight;
    LimbGoal goal_chest;  // "parent" is chest space here; swivel_zero_parent is not read
    // Of the elbow about the goal's line, as ArmControl::swivel_rad counts. Without: the arm moves
    // as little as its limits let it.
    std::optional<double> elbow_rad = {};
};
struct ArmAnswer {
    ArmControl control;                       // fingers as they were
    double residual_m = 0, residual_rad = 0;  // see LimbSolution
};

// Gives   an arm within its limits whose controls, solved, are that arm.
// Cost    some microseconds.
ArmAnswer solve_arm(const figure::Figure& figure, const Controls& now, const ArmGoal& goal);

}  // namespace puppetri::motion
