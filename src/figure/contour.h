// SPDX-License-Identifier: MIT
// From an implicit shape to triangles: dual contouring on an octree whose cells are as fine as the
// shape asks where it asks. Each cell that the surface passes gets one vertex, each smallest edge
// that it crosses one quad, so that the result is closed whatever the sizes of neighbouring cells
// are.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "implicit_shape.h"

namespace puppetri::figure {

// Cells need not be cubes: the lattice may be stretched along each axis, so that cells are long
// where the shape is (an arm) and short where it bends (an elbow). A monotone, piecewise linear map
// from lattice units to metres.
struct AxisMap {
    std::vector<double> lattice, model_m;  // ascending knots; outside of them the end pieces go on
    bool odd = false;                      // knots are those of the positive half: f(-u) = -f(u)
    double operator()(double u) const;
};

struct ContourGrid {
    AxisMap x, y, z;
    double low = -0.64, size = 1.28;  // the cube of lattice space that is searched
    int depth = 6;                    // cells of level 0 have the size size / 2^depth
};

struct Contour {
    std::vector<Vec3> positions_model;
    std::vector<Vec3> normals_model;
    std::vector<std::array<std::uint32_t, 3>> triangles;  // counter-clockwise seen from outside
};

// Source  T. Ju, F. Losasso, S. Schaefer, J. Warren, "Dual contouring of Hermite data", SIGGRAPH
// 2002 (the recursion);
//         S. Gibson, "Constrained elastic surface nets", 1998 (vertices at the mean of the
//         crossings, then relaxed). Ours: vertices are relaxed along the surface and projected onto
//         it by Newton steps, so that normals and positions agree with the function rather than
//         with the lattice.
Contour contour(const ImplicitShape& shape, const ContourGrid& grid);

}  // namespace puppetri::figure
