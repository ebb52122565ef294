// SPDX-License-Identifier: MIT
// Between two keys a file interpolates the turns of a whole arm and the way of the ball by itself,
// and the ball leaves the hand: by 15 mm in the middle of a throw at 24 frames per second. More
// keys, only there, bring it back.
#pragma once
#include <vector>

#include "puppetri/io/take.h"

namespace puppetri::io {

// The middles of those gaps between keys in which a prop, held by a hand at both ends, would be
// more than tolerance_m away from where the interpolated hand carries it. In increasing order. Cost
// two chains of rotations per key and held prop; no poses.
std::vector<SimTime> loose_middles(const Take& take, double tolerance_m);

}  // namespace puppetri::io
