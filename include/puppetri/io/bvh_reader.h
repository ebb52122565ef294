// SPDX-License-Identifier: MIT
// Reads BVH, the format of motion capture (docs/formats/bvh.md): any order and subset of the
// channels, several roots, joints that do not move.
#pragma once
#include <string>
#include <string_view>

#include "puppetri/base/diagnostic.h"
#include "puppetri/io/clip_file.h"

namespace puppetri::io {

// Gives   one clip, linear between frames, its root the first joint that has position channels; all
//         joints' rotations at rest are the identity; a position channel is added to the offset of
//         its joint. Tracks that do not change have one key.
//         A warning "odd-scale" where the figure is less than 0.4 m or more than 4 m tall: lengths
//         are in the unit that `options.scale` says, centimetres without it, and captures differ.
// Fails   "bad-bvh" with line and joint: what is no BVH, unknown or doubled channels, a count of
//         channels that is not theirs; "missing-channel", "extra-channel": a frame with too few or
//         too many numbers, by line, frame and joint; "bad-number"; "bad-frame-time"; "truncated":
//         fewer frames than announced; "too-large".
// Source  M. Meredith and S. Maddock, "Motion capture file formats explained", University of
//         Sheffield, CS-01-11 (2001), section 3.
// Cost    about 0.1 microseconds per number.
Checked<ClipFile> read_bvh(std::string_view text, const std::string& path,
                           const ClipReadOptions& options = {});

}  // namespace puppetri::io
