// SPDX-License-Identifier: MIT
// How the trunk's and the head's rotation are spread over their joints; shared by solving and by
// the questions of gaze.h, so that both mean the same chest.
#pragma once
#include "puppetri/figure/mannequin.h"
#include "puppetri/motion/controls.h"

namespace puppetri::motion {

struct TrunkRotations {
    Quat spine, chest, upper_chest, neck, head;  // each relative to its parent
};
TrunkRotations trunk_rotations(const BodyControl& body);

// What a breath does to the upper chest (the head keeps its attitude).
Quat breath_rotation(double breath);

// pelvis_from_chest: the joint upperChest in the space of `hips`.
Transform pelvis_from_upper_chest(const figure::Figure& figure, const TrunkRotations& trunk);

// The clavicle follows the hand: it rises with a raised arm (the rhythm of shoulder blade and upper
// arm, Inman et al. 1944) and comes forward with one that reaches, and it rises a little with the
// breath.
Quat clavicle_rotation(const figure::Figure& figure, int side, Vec3 hand_chest, double breath);

}  // namespace puppetri::motion
