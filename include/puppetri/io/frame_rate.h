// SPDX-License-Identifier: MIT
// A frame rate as an exact ratio: 23.976 means 24000/1001, so that frame 86 400 is where the
// cutting room expects it.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "puppetri/base/time.h"

namespace puppetri::io {

// numerator / denominator frames per second, both positive, in lowest terms.
struct FrameRate {
    std::int64_t numerator = 24;
    std::int64_t denominator = 1;

    double per_second() const {
        return static_cast<double>(numerator) / static_cast<double>(denominator);
    }
    // When frame k is shown, to the nearest tick. Needs |k| at most 10 million.
    SimTime time_of(std::int64_t frame) const;
    // The last frame that is not after `at`. Needs at >= 0 and less than ten days.
    std::int64_t frame_at_or_before(SimTime at) const;
    // The frame nearest to `at`; halves go up. Needs the same.
    std::int64_t nearest_frame(SimTime at) const;
    bool operator==(const FrameRate&) const = default;
};

inline constexpr double kLowestExportRate = 23.976;
inline constexpr double kHighestExportRate = 120;

// Reads "24", "12.5", "30000/1001"; 23.976 (or 23.98), 29.97, 47.952, 59.94, 119.88 mean the
// television rates N*1000/1001. None for anything else than a positive number of at most 1000.
std::optional<FrameRate> parse_frame_rate(std::string_view text);

// "24" or "24000/1001": what parse_frame_rate reads back.
std::string to_string(FrameRate rate);

}  // namespace puppetri::io
