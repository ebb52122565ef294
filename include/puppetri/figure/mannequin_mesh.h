// SPDX-License-Identifier: MIT
// The mannequin's skin: one closed, smooth, weighted mesh, made from nothing but a humanoid
// skeleton. Its shape is an implicit surface (round cones and ellipsoids along the bones, smoothly
// joined), so that it fits any proportions; an adaptive dual contouring turns it into about ten
// thousand triangles, fine at fingers and face, coarse at the trunk.
#pragma once
#include "puppetri/figure/mesh.h"
#include "puppetri/figure/palette.h"
#include "puppetri/figure/skeleton.h"

namespace puppetri::figure {

// Makes the skin of a humanoid in its rest pose, a T-pose facing +Z.
// Needs   the joints of make_mannequin (VRM 1.0 names, fingers, twist joints) and a positive
// height. Gives   a closed manifold; unit normals that point outwards; at most four weights per
// vertex with sum 1; one part
//         per material (skin, hair, shirt, trousers, shoes). Left and right are mirror images. The
//         soles touch y = 0 and the crown height_m, within 1 % of the height.
// Cost    15 to 40 ms; memory a few MB while it works.
Mesh make_mannequin_mesh(const Skeleton& skeleton, const Palette& palette);

// The same skin for a mannequin that is `ratio` times as high: mannequins are similar figures.
// Gives what make_mannequin_mesh would make for it, up to rounding. Cost    a copy.
Mesh fit_mannequin_mesh(Mesh mesh, double ratio, const Palette& palette);

}  // namespace puppetri::figure
