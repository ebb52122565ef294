// SPDX-License-Identifier: MIT
// Where a figure looks, and where its chest and hands are, as its controls say.
#pragma once
#include "puppetri/motion/context.h"

namespace puppetri::motion {

// The rotation chest_from_head that makes the eyes look at the target, no further than the neck
// turns: 70 degrees to the side, 40 up and down. A target behind the back is not looked at: from
// 110 degrees on the head turns back ahead, without a jump.
Quat gaze_at(const figure::Figure& figure, const Controls& controls, Vec3 target_world);

// World transform of the joint upperChest and of a hand as the controls ask for it (the pelvis
// within reach of both feet, pelvis_placement.h; no limits of joints applied); what `hold`, `reach`
// and `throw` compute with.
Transform world_from_chest(const figure::Figure& figure, const Controls& controls);
Transform world_from_hand(const figure::Figure& figure, const Controls& controls, Side side);
Transform world_from_palm(const figure::Figure& figure, const Controls& controls, Side side);
// Where the shoulder joint is at rest of the clavicle, for reach tests.
Vec3 shoulder_chest(const figure::Figure& figure, Side side);

}  // namespace puppetri::motion
