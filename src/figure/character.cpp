// SPDX-License-Identifier: MIT
#include "puppetri/figure/character.h"

namespace puppetri::figure {

Figure Character::moved_figure() const {
    if (humanoid) {
        return humanoid->figure;
    }
    Figure figure;
    figure.skeleton = skeleton;
    figure.limits = limits;
    figure.dofs = dofs;
    figure.root = {0};
    figure.height_m = skeleton.height_m;
    return figure;
}

void Character::carry(const Pose& pose, Pose& raw) const {
    if (humanoid) {
        humanoid->rig.to_raw(humanoid->figure, skeleton, pose, raw);
    } else {
        raw = pose;
    }
}

}  // namespace puppetri::figure
