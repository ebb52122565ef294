// SPDX-License-Identifier: MIT
// Choosing few keys that linear interpolation turns back into many.
#pragma once
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "puppetri/io/take.h"

namespace puppetri::io {

// Keeps the first, the last and the pinned keys, and as many more as are needed for `misfit(from,
// to, key)`, the deviation at a key left out between the kept keys `from` and `to`, to stay within
// the tolerance. Halves at the worst key (Ramer 1972; Douglas and Peucker 1973). Cost: O(n log n)
// misfits when it halves evenly, O(n^2) at worst.
std::vector<std::uint32_t> reduce_keys(
    std::uint32_t count, std::span<const std::uint32_t> pinned, double tolerance,
    const std::function<double(std::uint32_t, std::uint32_t, std::uint32_t)>& misfit);

// What joints may deviate by, so that no joint's position deviates by more than `tolerance_m`: the
// tolerance is shared evenly along the longest chain, with two shares for the translations of root
// and hips; a rotation's share is divided by the distance to the farthest joint below.
struct Allowance {
    std::vector<double> rotation_rad;  // per joint
    double translation_m = 0;
};
Allowance allowance_for(const figure::Skeleton& skeleton, double tolerance_m);

}  // namespace puppetri::io
