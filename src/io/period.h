// SPDX-License-Identifier: MIT
// One period of a performance that repeats itself, and closing the small gap at its end.
#pragma once
#include <optional>

#include "puppetri/io/take.h"

namespace puppetri::io {

// The earliest stretch of whole frames within `range` after which all actors are at the same point
// of the same places of the net, in nearly the same pose (every joint within 2 cm of where it was,
// seen from the root), and all props have the same holders. Among the ends that fit one beginning,
// the first.
std::optional<FrameRange> find_period(const stage::Performance& performance, FrameRate rate,
                                      FrameRange range);

// Makes the last key equal the first in all joints but the root: the gap is spread smoothly over
// the take.
void close_loop(Take& take);

}  // namespace puppetri::io
