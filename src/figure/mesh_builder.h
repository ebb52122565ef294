// SPDX-License-Identifier: MIT
// Building simple closed surfaces into a mesh: surfaces of revolution with a pole at either end.
#pragma once
#include <span>

#include "puppetri/figure/mesh.h"

namespace puppetri::figure {

// One ring of a surface of revolution about +Y: its radius and height, and its normal in that
// plane.
struct ProfilePoint {
    double radius_m = 0, y_m = 0, normal_out = 1, normal_y = 0;
};

// Appends a closed surface of revolution: the first and the last point of the profile lie on the
// axis (radius 0), the profile rises. `material_of(ring, sector)` would be too much: all triangles
// get `material` as a part of their own. Needs   at least three profile points, sectors >= 3. Gives
// vertices bound to `joint` with weight 1 when the mesh is skinned (skinned: its joints are not
// empty, or it has
//         no vertices yet and `joint` is given).
void append_revolution(Mesh& mesh, std::span<const ProfilePoint> profile, int sectors,
                       const Transform& model_from_local, std::uint32_t material,
                       const std::uint16_t* joint);

// Unit circle: `count` points from angle 0, exact at the quarters.
void circle_points(int count, std::span<double> cosines, std::span<double> sines);

// Joins neighbouring parts with one material and orders parts by material.
void sort_parts(Mesh& mesh);

}  // namespace puppetri::figure
