// SPDX-License-Identifier: MIT
// Who is cut in a stride first goes on with it until both feet are on the floor, and brings the one
// behind beside the other: from there any movement begins as from standing.
#pragma once
#include <vector>

#include "puppetri/motion/context.h"
#include "puppetri/motion/movement.h"

namespace puppetri::motion {

inline constexpr double kLongestFinish_s = 1.5;  // strides that would last longer are cut

// The movements that finish the stride, and the context at their end: with what is left of a
// prescribed duration, 0.3 s at least. None, and the context as it is, where no stride is under
// way.
std::vector<MovementPtr> finish_stride(MotionContext& context, LimbSet limbs);

}  // namespace puppetri::motion
