// SPDX-License-Identifier: MIT
// Rigid meshes: balls, boxes, cylinders, forks, and the ground that figures walk on. Their origin
// is their centre (for the ground: the middle of its surface); joints and weights are empty.
#pragma once
#include "puppetri/figure/mesh.h"
#include "puppetri/figure/palette.h"
#include "puppetri/math/transform.h"

namespace puppetri::figure {

// A ball with two-coloured panels, so that its spin can be seen. Needs diameter_m > 0.
Mesh make_ball_mesh(double diameter_m, const Palette& palette);

// A box with bevelled edges. Needs all sizes > 0.
Mesh make_box_mesh(Vec3 size_m, const Palette& palette);

// An upright disc or cylinder, its rim bevelled. Needs both > 0.
Mesh make_cylinder_mesh(double diameter_m, double height_m, const Palette& palette);

// A table fork that lies on its back, tines to +Z, within that size. Needs all sizes > 0.
Mesh make_fork_mesh(Vec3 size_m, const Palette& palette);

// A straight road along +Z at height 0: asphalt, a dashed centre line, edge lines, a strip of grass
// either side. Needs length_m > 0 and width_m > 0 (of the asphalt).
Mesh make_road_mesh(double length_m, double width_m);

// A square floor at height 0 with a thin grid every metre.
Mesh make_floor_mesh(double length_m, double width_m);

}  // namespace puppetri::figure
