// SPDX-License-Identifier: MIT
// The root of a clip on the floor: where it is, and carrying it elsewhere.
#pragma once
#include "puppetri/motion/clip.h"

namespace puppetri::motion {

// `base` so many times; needs a whole number, not negative.
Transform power(Transform base, double times);

// Where the root stands and where it looks at an instant within the clip; no height, no lean. The
// identity where the clip has no such tracks.
Transform planar_root(const Clip& clip, double t_s);

// Moves the root's tracks by a planar motion of the world.
void carry_root(Clip& clip, const Transform& by);

}  // namespace puppetri::motion
