// SPDX-License-Identifier: MIT
// Linear blend skinning: where the vertices of a mesh are, given where its joints are. The same
// formula as in glTF viewers, so that pictures show what exported files will.
#pragma once
#include <array>
#include <span>
#include <vector>

#include "puppetri/figure/mesh.h"
#include "puppetri/figure/skeleton.h"

namespace puppetri::render {

// Three rows of four: rotation and translation.
using Matrix34 = std::array<std::array<float, 4>, 3>;

Matrix34 matrix_of(const Transform& t);

class Skin {
 public:
    // Both outlive the skin.
    Skin(const figure::Skeleton& skeleton, const figure::Mesh& mesh);

    // Fills positions (four floats apart) and normals (three floats, unit) in world space.
    void apply(const figure::Pose& pose, float* positions_world,
               std::span<std::array<float, 3>> normals_world);

 private:
    const figure::Skeleton& skeleton_;
    const figure::Mesh& mesh_;
    std::vector<Transform> joint_from_model_rest_, model_from_joint_;
    std::vector<Matrix34> matrices_;
};

// A rigid mesh at a place.
void place(const figure::Mesh& mesh, const Transform& world_from_mesh, float* positions_world,
           std::span<std::array<float, 3>> normals_world);

}  // namespace puppetri::render
