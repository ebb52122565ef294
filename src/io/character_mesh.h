// SPDX-License-Identifier: MIT
// The meshes of a file as one: first in the file's model space, while the figure is still being
// turned and scaled, then as a figure::Mesh.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "affine.h"
#include "puppetri/figure/mesh.h"
#include "puppetri/io/gltf_document.h"

namespace puppetri::io {

// One use of a mesh by a node.
struct CharacterPart {
    std::uint32_t mesh = 0;
    Affine model_from_mesh;
    bool skinned = false;
    std::vector<std::uint32_t> joints;          // of the skin: nodes
    std::vector<Affine> model_from_joint_mesh;  // without bind matrices: one per joint
    std::uint32_t holder = kNoGltf;             // rigid: the node that carries it
};

struct CharacterVertex {
    std::array<std::uint32_t, 4> joints{};  // nodes; then joints of the skeleton
    std::array<float, 4> weights{};
};

struct CharacterMesh {
    std::vector<Vec3> positions, normals;
    std::vector<CharacterVertex> vertices;
    std::vector<std::array<float, 2>> uvs;
    struct Triangles {
        std::uint32_t material = kNoGltf;  // of the document
        std::vector<std::array<std::uint32_t, 3>> list;
    };
    std::vector<Triangles> parts;
    bool has_uvs = false;
};

// Appends what the part shows: triangles, strips and fans as triangles; normals where there are
// none are made from the triangles.
void add_positions(const GltfDocument& document, const CharacterPart& part, CharacterMesh& mesh);

figure::Mesh make_character_mesh(const GltfDocument& document, const CharacterMesh& mesh);

}  // namespace puppetri::io
