// SPDX-License-Identifier: MIT
// From a performance to tuples (notation/keyframe_tuples.h); and from tuples and poses that were
// made once in a local frame to the absolute keyframes of a whole scene.
// Source  P. Fishwick and H. Porr, "Using discrete event modeling for effective computer animation
//         control", Winter Simulation Conference 1991, section 4.2.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "puppetri/base/diagnostic.h"
#include "puppetri/base/frame_rate.h"
#include "puppetri/io/clip_file.h"
#include "puppetri/notation/keyframe_tuples.h"
#include "puppetri/stage/performance.h"

namespace puppetri::io {

// What a performance did, as tuples: each movement of an actor that came to its end before the
// token left, at the frame of that end, by the movement's name. Where two end in one frame (arms
// and legs apart) the one that began last is told.
std::vector<notation::KeyframeTuple> tuples_of(const stage::Performance& performance,
                                               FrameRate rate);

// One clip per object, in the order in which they first come. At each tuple the object has reached
// the pose that the event names, a clip of `poses` (its begin counts); in between its tracks go on
// by `between`. A clip of `poses` that is called like the object says where it is in the world: its
// root, under which the poses' roots are placed; without it the local frame is the world.
// Needs   rate_hz > 0.
// Fails   "unknown-pose": an event that names no clip.
Checked<ClipFile> absolute_keyframes(std::span<const notation::KeyframeTuple> tuples,
                                     const ClipFile& poses, double rate_hz,
                                     motion::Interpolation between, const std::string& path);

}  // namespace puppetri::io
