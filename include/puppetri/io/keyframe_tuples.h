// SPDX-License-Identifier: MIT
// Tuple files: which keyframe an object reaches when, `time object event`, one per line; and from
// them and poses that were made once in a local frame, the absolute keyframes of a whole scene.
// Source  P. Fishwick and H. Porr, "Using discrete event modeling for effective computer animation
//         control", Winter Simulation Conference 1991, section 4.2.
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "puppetri/base/diagnostic.h"
#include "puppetri/io/clip_file.h"

namespace puppetri::io {

struct KeyframeTuple {
    std::int64_t frame = 0;
    std::string object, event;  // "man1", "EATING1"
    bool operator==(const KeyframeTuple&) const = default;
};

// Lines of three words; `#` begins a comment. Frames are whole numbers from 0.
// Fails   "bad-tuple" with line and column: a line of other words, a frame that is none, or two
//         events of one object at one frame.
Checked<std::vector<KeyframeTuple>> read_tuples(std::string_view text, const std::string& path);

// Ordered by frame, then as given.
std::string make_tuples(std::span<const KeyframeTuple> tuples);

// One clip per object, in the order in which they first come. At each tuple the object has reached
// the pose that the event names, a clip of `poses` (its begin counts); in between its tracks go on
// by `between`. A clip of `poses` that is called like the object says where it is in the world: its
// root, under which the poses' roots are placed; without it the local frame is the world.
// Needs   rate_hz > 0.
// Fails   "unknown-pose": an event that names no clip.
Checked<ClipFile> absolute_keyframes(std::span<const KeyframeTuple> tuples, const ClipFile& poses,
                                     double rate_hz, motion::Interpolation between,
                                     const std::string& path);

}  // namespace puppetri::io
