// SPDX-License-Identifier: MIT
// Between seconds of a plan and model time.
#pragma once
#include <cmath>
#include <limits>
#include <string>

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

// "0.250 s", for messages.
inline std::string told_seconds(double t_s) {
    const auto ms = static_cast<long long>(std::nearbyint(t_s * 1000));
    const std::string digits = std::to_string(ms % 1000);
    return std::to_string(ms / 1000) + "." + std::string(3 - digits.size(), '0') + digits + " s";
}

}  // namespace puppetri::motion
