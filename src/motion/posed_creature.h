// SPDX-License-Identifier: MIT
// Movements that pose joints, of figures without controls (figure::Character): what the source does
// not pose stays at rest, and where joints change hands the stage fades the difference.
#pragma once
#include <memory>

#include "puppetri/motion/posed.h"

namespace puppetri::motion {

// Needs   a figure that is no humanoid, DOFs and joints of it; of paths only that of the pelvis is
//         followed: it is the way of the root.
MovementPtr make_posed_creature(const MotionContext& context, const PosedSpec& spec,
                                std::shared_ptr<const PoseSource> source);

}  // namespace puppetri::motion
