// SPDX-License-Identifier: MIT
// A frame rate as an exact ratio: 23.976 means 24000/1001, so that frame 86 400 is where the
// cutting room expects it. Frame 0 is time 0.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "puppetri/base/time.h"

namespace puppetri {

// numerator / denominator frames per second, both positive and at most 10^9, in lowest terms.
struct FrameRate {
    std::int64_t numerator = 24;
    std::int64_t denominator = 1;

    double per_second() const {
        return static_cast<double>(numerator) / static_cast<double>(denominator);
    }
    // When frame k >= 0 is shown: the nearest tick, ties to even. None when it does not fit.
    std::optional<SimTime> time_of_frame(std::int64_t frame) const;
    // The same. Needs it to fit: ten million frames do at any rate of at least one per hour.
    SimTime time_of(std::int64_t frame) const;
    // The last frame that is shown at `at` or before. Needs at >= 0.
    std::int64_t frame_at_or_before(SimTime at) const;
    // The frame nearest to `at`, halves up. Needs at >= 0.
    std::int64_t nearest_frame(SimTime at) const;

    bool operator==(const FrameRate&) const = default;
};

// Reads "24", "12.5", "30000/1001"; 23.976 (or 23.98), 29.97, 47.952 (or 47.95), 59.94, 119.88 mean
// the rates of television, N*1000/1001. None for anything else than a positive number of at most
// 1000.
std::optional<FrameRate> parse_frame_rate(std::string_view text);

// "24" or "24000/1001": what parse_frame_rate reads back.
std::string to_string(FrameRate rate);

}  // namespace puppetri
