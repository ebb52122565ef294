// SPDX-License-Identifier: MIT
// A skinned mesh: triangles bound to at most four joints per vertex, in the rest pose's model
// space.
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "puppetri/figure/skeleton.h"

namespace puppetri::figure {

struct Material {
    std::string name;
    std::array<float, 3> base_colour{0.8f, 0.8f, 0.8f};  // linear RGB
    float roughness = 0.7f;
    float metallic = 0;
};

// Triangles first .. first + count - 1 (in triangles) have one material.
struct MeshPart {
    std::uint32_t material = 0;
    std::uint32_t first_triangle = 0;
    std::uint32_t triangle_count = 0;
};

struct Mesh {
    std::vector<std::array<float, 3>> positions;  // model space of the rest pose, metres
    std::vector<std::array<float, 3>> normals;    // unit, one per position
    std::vector<std::array<std::uint16_t, 4>>
        joints;                                 // one per position; empty for a rigid mesh (a prop)
    std::vector<std::array<float, 4>> weights;  // sum to 1, non-negative, unused slots 0
    std::vector<std::array<std::uint32_t, 3>> triangles;  // counter-clockwise seen from outside
    std::vector<MeshPart> parts;
    std::vector<Material> materials;
};

}  // namespace puppetri::figure
