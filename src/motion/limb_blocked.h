// SPDX-License-Identifier: MIT
// Goals for which no swivel keeps all limits.
#pragma once
#include "puppetri/motion/limb_ik.h"

namespace puppetri::motion {

// `families` has the goal's families and no interval. Gives joints within their limits, as near to
// the goal as LimbIk::solve says.
LimbSolution solve_blocked(const LimbIk& ik, const LimbGoal& goal, const SwivelIntervals& families,
                           const SwivelChoice& choice);

}  // namespace puppetri::motion
