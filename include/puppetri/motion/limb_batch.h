// SPDX-License-Identifier: MIT
// Many limbs of one shape at once, as arrays of coordinates: crowds. Limits of the hinge are kept,
// those of ball joints are not looked at; goals out of reach are approached as far as the hinge
// goes.
#pragma once
#include <array>
#include <cstdint>
#include <span>

#include "puppetri/motion/limb_ik.h"

namespace puppetri::motion {

// All spans that are not empty are equally long. Figures of one build that differ in size alone
// share a limb: divide the position by the size, rotations do not depend on it.
template <class T>
struct LimbGoalsSoa {
    std::array<std::span<const T>, 3> position_parent;
    std::array<std::span<const T>, 4> rotation_parent;  // x y z w; empty: positions alone
    std::array<std::span<const T>, 3> swivel_zero;      // LimbGoal::swivel_zero_parent
    std::array<std::span<const T>, 2> swivel;           // cosine and sine; empty: swivel 0
};
template <class T>
struct LimbPosesSoa {
    std::array<std::span<T>, 4> start, hinge;
    std::array<std::span<T>, 4> end;  // not written for positions alone
    std::span<T> residual_m;
};

// One at a time, as wide as every processor can, or as wide as this one can.
enum class BatchWidth : std::uint8_t { kOne, kBase, kWidest };

// Gives   the first family of LimbIk::families at the swivel; the same bits at every width, and for
//         double those of LimbIk::solve_free.
// Cost    10 to 40 ns a limb; no allocation.
void solve_limbs_soa(const LimbIk& ik, const LimbGoalsSoa<double>& goals,
                     const LimbPosesSoa<double>& poses, BatchWidth width = BatchWidth::kWidest);
void solve_limbs_soa(const LimbIk& ik, const LimbGoalsSoa<float>& goals,
                     const LimbPosesSoa<float>& poses, BatchWidth width = BatchWidth::kWidest);

}  // namespace puppetri::motion
