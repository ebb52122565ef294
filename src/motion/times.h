// SPDX-License-Identifier: MIT
// Between seconds of a plan and model time.
#pragma once
#include <cmath>
#include <limits>

#include "puppetri/base/time.h"

namespace puppetri::motion {

// Later than any end; far enough from the largest time that sums with it do not overflow.
inline constexpr SimTime kOpenEnd{std::numeric_limits<std::int64_t>::max() / 4};

inline SimTime to_time(double seconds) {
    return {static_cast<std::int64_t>(std::nearbyint(seconds * kTicksPerSecond))};
}
// Rounded up to a whole millisecond: the unit in which movements answer how long they take.
inline SimTime whole_milliseconds(double seconds) {
    return {static_cast<std::int64_t>(std::ceil(seconds * 1000 - 1e-9)) * kTicksPerMillisecond};
}

}  // namespace puppetri::motion
