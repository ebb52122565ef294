// SPDX-License-Identifier: MIT
// From controls to a pose: the one place where handles become joint rotations. Pelvis first, then
// trunk and head, then each limb by analytic inverse kinematics; rotations about a limb's own axis
// are spread over its twist bones; all joints end inside their limits.
#pragma once
#include <array>

#include "puppetri/figure/mannequin.h"
#include "puppetri/motion/controls.h"

namespace puppetri::motion {

// How far the pose is from what the controls asked.
struct SolveOutcome {
    std::array<double, 2> leg_residual_m{}, arm_residual_m{};  // ankle, wrist
    double pelvis_moved_m = 0;                                 // so that both feet are within reach
    double clamped_rad = 0;  // largest angle by which a joint had to be turned back into its limits
};

// What becomes of the pelvis where a foot is out of reach.
enum class PelvisRule : std::uint8_t {
    kInReach,  // it goes to the nearest place from which both legs reach (pelvis_placement.h)
    kAsWanted  // it stays, the leg is stretched: for poses whose legs are not the controls' at last
};

// Gives   a pose whose feet and hands are where the controls say, as far as bones and limits allow;
//         the feet keep their rotation in the world. Of a creature the rest pose, with its root
//         where the pelvis control is.
// Cost    a few microseconds; `out` is resized once, then nothing is allocated.
SolveOutcome solve_controls(const figure::Figure& figure, const Controls& controls,
                            figure::Pose& out, PelvisRule rule = PelvisRule::kInReach);

}  // namespace puppetri::motion
