// SPDX-License-Identifier: MIT
#include "puppetri/figure/character.h"

namespace puppetri::figure {

void Character::carry(const Pose& pose, Pose& raw) const {
    if (humanoid) {
        humanoid->rig.to_raw(humanoid->figure, skeleton, pose, raw);
    } else {
        raw = pose;
    }
}

}  // namespace puppetri::figure
