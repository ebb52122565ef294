// SPDX-License-Identifier: MIT
// Model time: an int64 count of ticks of 1/705 600 000 s, which all usual frame and audio rates
// divide.
#pragma once
#include <compare>
#include <cstdint>
#include <limits>

namespace puppetri {

inline constexpr std::int64_t kTicksPerSecond = 705'600'000;
inline constexpr std::int64_t kTicksPerMillisecond = kTicksPerSecond / 1000;

// An instant (since the start of the run) or a duration.
struct SimTime {
    std::int64_t ticks = 0;

    static constexpr SimTime never() { return {std::numeric_limits<std::int64_t>::max()}; }
    constexpr double seconds() const { return static_cast<double>(ticks) / kTicksPerSecond; }
    auto operator<=>(const SimTime&) const = default;
    friend constexpr SimTime operator+(SimTime a, SimTime b) { return {a.ticks + b.ticks}; }
    friend constexpr SimTime operator-(SimTime a, SimTime b) { return {a.ticks - b.ticks}; }
};

}  // namespace puppetri
