// SPDX-License-Identifier: MIT
// Where the pelvis must be so that both feet reach: the point nearest to the wanted one from which
// no leg is longer than it can be.
#pragma once
#include <array>

#include "puppetri/math/transform.h"

namespace puppetri::motion {

struct LegReach {
    Vec3 hip_pelvis;  // of the hip joint in the space of the pelvis
    Vec3 ankle_world;
    double longest_m = 0;
};
struct PelvisPlacement {
    Transform wanted_world;
    std::array<LegReach, 2> legs;
    bool lower_first = true;  // straight down where that is enough, so that the balance is kept
};
struct PlacedPelvis {
    Vec3 position_world;
    std::array<double, 2> residual_m{};  // by how much each leg is still too short
};

// Gives   the wanted place where both feet reach from it. Feet farther apart than two legs and the
//         pelvis: both are missed by the same length.
// Cost    O(1), closed form: the projection onto the intersection of two balls; no allocation.
PlacedPelvis place_pelvis(const PelvisPlacement& placement);

}  // namespace puppetri::motion
