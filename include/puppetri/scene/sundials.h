// SPDX-License-Identifier: MIT
// `solver stiff by sundials`: the optional part of a build that integrates large stiff systems with
// CVODE. Without it everything else is as ever, and scenes play off their baked courses.
#pragma once
#include <memory>
#include <string>

#include "puppetri/run/step_source.h"

namespace puppetri::scene {

// What to do in a build without the part, for messages.
inline constexpr const char* kSundialsRemedy =
    "write `solver stiff`, which every build has; or name a file of baked courses, `baked "
    "\"FILE\"`; or install libsundials-dev and build anew";

// "SUNDIALS 6.4.1"; empty where this build has no such part.
std::string sundials_version();

// Backward differentiation of order 1 to 5 with steps of any length, Newton's method, Jacobians by
// differences; dense matrices, or banded ones where rates read only neighbours. The course inside a
// step is CVODE's own polynomial. In a build without the part sources know nothing and say so.
// Source: Hindmarsh et al., "SUNDIALS: Suite of nonlinear and differential/algebraic equation
//         solvers", ACM Trans. Math. Softw. 31 (2005) 363-396.
// Cost:   a Jacobian takes n evaluations of the right side, or as many as the band is wide, and is
//         kept for up to 50 steps; n^3/3, or n times the width squared, to factorize.
std::unique_ptr<run::StepSources> sundials_sources();

}  // namespace puppetri::scene
