// SPDX-License-Identifier: MIT
// Distributions: a kind and its parameters, flat, so that parameters may be computed anew for each
// draw without allocation. The number of uniform draws that a sample takes may vary (rejection);
// the stream counts them, and the same stream gives the same sample on every system.
#pragma once
#include <cstdint>
#include <span>

#include "puppetri/base/diagnostic.h"
#include "puppetri/base/random.h"

namespace puppetri {

enum class DistributionKind : std::uint8_t {
    kConstant,  // value
    kUniform,   // low, high: low <= high
    kNormal,  // mean, deviation >= 0 [, low, high: low <= high]; without bounds 0 .. infinity. The
              // normal distribution on condition of lying within the bounds: its mean is not `mean`
    kExponential,  // mean > 0
    kTriangular,   // low, mode, high: low <= mode <= high
    kErlang,       // shape, a whole number from 1 to 10^6; mean of the whole > 0
    kGamma,        // shape > 0, mean of the whole > 0
    kEmpirical,    // observations in ascending order, at least one: linear between neighbours, each
                   // step equally likely
    kDiscrete,     // value, weight, value, weight, ...: weights >= 0, not all 0
};

// "uniform", "exponential", ... as in the scene language.
const char* name_of(DistributionKind kind);

// Whether these are parameters of that kind. All finite, but the bounds of kNormal.
// Fails   with one diagnostic per defect, code "wrong-distribution", without a place in a file.
Status check(DistributionKind kind, std::span<const double> parameters);

// Needs   check(kind, parameters); otherwise the result is some number or NaN, without endless
// search. Cost    5 to 60 ns; kEmpirical O(1), kDiscrete linear. Source  each kind names its method
// in distribution.cpp.
double sample(DistributionKind kind, std::span<const double> parameters, RandomStream& stream);

// The mean and the variance, in closed form; kNormal by Simpson's rule (relative error below 1e-9).
// Needs   check(kind, parameters).
struct Moments {
    double mean = 0;
    double variance = 0;
};
Moments moments(DistributionKind kind, std::span<const double> parameters);

// The smallest and the largest value that a sample can have; infinite where there is none.
// Needs   check(kind, parameters).
struct Support {
    double low = 0;
    double high = 0;
};
Support support(DistributionKind kind, std::span<const double> parameters);

}  // namespace puppetri
