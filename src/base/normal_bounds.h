// SPDX-License-Identifier: MIT
// The bounds of a truncated normal distribution: those written, or 0 .. infinity.
#pragma once
#include <limits>
#include <span>

namespace puppetri {

struct NormalBounds {
    double low = 0;
    double high = std::numeric_limits<double>::infinity();
};

inline NormalBounds normal_bounds(std::span<const double> parameters) {
    return parameters.size() == 4 ? NormalBounds{.low = parameters[2], .high = parameters[3]}
                                  : NormalBounds{};
}

}  // namespace puppetri
