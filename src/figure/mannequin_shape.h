// SPDX-License-Identifier: MIT
// The body as an implicit shape: which cones and ellipsoids, where along the bones, how thick. All
// the modelling is here.
#pragma once
#include <array>
#include <vector>

#include "contour.h"
#include "implicit_shape.h"
#include "puppetri/figure/skeleton.h"

namespace puppetri::figure {

// Everything is modelled on a figure of this height and scaled at the very end.
inline constexpr double kCanonicalHeight_m = 1.75;

// The joints that the shape hangs on, in the rest pose at the canonical height. Sides: 0 left (+X),
// 1 right.
struct Landmarks {
    double scale = 1;  // the figure's height over the canonical one
    Vec3 hips, spine, chest, upper_chest, neck, head;
    std::array<Vec3, 2> shoulder, elbow, wrist, hip, knee, ankle, toes;
    std::array<std::array<std::array<Vec3, 4>, 5>, 2>
        fingers;  // side, thumb to little, three joints and the tip
};

// Needs a humanoid skeleton with the names of VRM 1.0.
Landmarks landmarks_of(const Skeleton& skeleton);

ImplicitShape mannequin_shape(const Landmarks& marks);
ContourGrid mannequin_grid(const Landmarks& marks);

// Clothes are zones of the skin, divided by the zero sets of these functions.
enum class Zone : std::uint8_t { kSkin, kHair, kShirt, kTrousers, kShoes };
inline constexpr int kZoneCount = 5;

// A border: negative on the side of `inside`. Borders are cut in order; a point belongs to the
// first zone whose border it is inside of, or to the skin.
inline constexpr int kBorderCount = 6;
double border(const Landmarks& marks, int which, Vec3 p_model);
Zone zone_inside(int which);
// False where the border does not concern the point, for instance the hair line at the feet.
bool border_applies(const Landmarks& marks, int which, Vec3 p_model);

// Clothes and hair stand out from the skin by so much, in metres; the step lies within kHem outside
// of the border.
double relief(const Landmarks& marks, Vec3 p_model);
inline constexpr double kHem = 0.006;

}  // namespace puppetri::figure
