// SPDX-License-Identifier: MIT
// Where the pelvis must be so that both feet reach: the point nearest to the wanted one from which
// no leg is longer than it can be. solve_controls.h asks for it before it poses anything, so that a
// foot whose leg is too short takes the pelvis along instead of leaving its place.
#pragma once
#include <array>

#include "puppetri/math/transform.h"
#include "puppetri/motion/controls.h"

namespace puppetri::figure {
struct Figure;
}

namespace puppetri::motion {

struct LegReach {
    Vec3 hip_pelvis;  // of the hip joint in the space of the pelvis
    Vec3 ankle_world;
    double easy_m = 0;     // a leg no longer than that leaves the pelvis where it is
    double longest_m = 0;  // no leg gets longer; above easy_m
};
struct PelvisPlacement {
    Transform wanted_world;
    std::array<LegReach, 2> legs;
};
struct PlacedPelvis {
    Vec3 position_world;
    std::array<double, 2> residual_m{};  // by how much each leg is still too short
};

// Gives   the wanted place, to the bit, where no leg is longer than is easy from there. Otherwise
//         the place nearest to it that both legs reach, but for the way from easy to longest, in
//         which a leg resists more and more: so the place depends on the wanted one and on the feet
//         with a continuous derivative, also where a leg begins to pull and where the other one
//         joins in, and it never moves farther than what is wanted does. Feet farther apart than
//         two legs and the pelvis: both are missed by the same length, nearly.
// Cost    O(1), no allocation: 10 ns where both reach, closed form where one leg pulls, two or
//         three microseconds where both do.
PlacedPelvis place_pelvis(const PelvisPlacement& placement);

// The pelvis of these controls where both ankles are within reach. Easy are 99.91 % of a leg (more
// than any movement of the library asks of a foot that stands), its longest 99.99 %: an ankle is
// then within a millimetre of its goal (solve_controls.h straightens legs softly). Creatures have
// no such legs: their pelvis is where it is wanted.
Vec3 pelvis_in_reach(const figure::Figure& figure, const Controls& controls);

}  // namespace puppetri::motion
