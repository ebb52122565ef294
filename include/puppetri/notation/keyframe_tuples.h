// SPDX-License-Identifier: MIT
// Tuple files: which keyframe an object reaches when, `time object event`, one per line.
// Source  P. Fishwick and H. Porr, "Using discrete event modeling for effective computer animation
//         control", Winter Simulation Conference 1991, section 4.2.
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "puppetri/base/diagnostic.h"

namespace puppetri::notation {

struct KeyframeTuple {
    std::int64_t frame = 0;
    std::string object, event;  // "man1", "EATING1"
    std::uint32_t line = 0;     // of the file; 0: of none
    bool operator==(const KeyframeTuple& other) const {
        return frame == other.frame && object == other.object && event == other.event;
    }
};

// Lines of three words; `#` begins a comment. Frames are whole numbers from 0.
// Fails   "bad-tuple" with line and column: a line of other words, a frame that is none, or two
//         events of one object at one frame.
Checked<std::vector<KeyframeTuple>> read_tuples(std::string_view text, const std::string& path);

// Ordered by frame, then as given.
std::string make_tuples(std::span<const KeyframeTuple> tuples);

}  // namespace puppetri::notation
