// SPDX-License-Identifier: MIT
#include "skin.h"

#include <cmath>

namespace puppetri::render {
namespace {

void transform(const Matrix34& m, const std::array<float, 3>& p, const std::array<float, 3>& n,
               float* position, std::array<float, 3>& normal) {
    float turned[3];
    for (std::size_t r = 0; r < 3; ++r) {
        position[r] = m[r][0] * p[0] + m[r][1] * p[1] + m[r][2] * p[2] + m[r][3];
        turned[r] = m[r][0] * n[0] + m[r][1] * n[1] + m[r][2] * n[2];
    }
    // A blend of rotations shortens what it turns.
    const float square = turned[0] * turned[0] + turned[1] * turned[1] + turned[2] * turned[2];
    const float scale = square > 1e-12f ? 1 / std::sqrt(square) : 1;
    normal = {turned[0] * scale, turned[1] * scale, turned[2] * scale};
}

}  // namespace

Matrix34 matrix_of(const Transform& t) {
    const auto& [x, y, z, w] = t.rotation;
    const auto f = [](double v) { return static_cast<float>(v); };
    return {{{f(1 - 2 * (y * y + z * z)), f(2 * (x * y - z * w)), f(2 * (x * z + y * w)),
              f(t.translation.x)},
             {f(2 * (x * y + z * w)), f(1 - 2 * (x * x + z * z)), f(2 * (y * z - x * w)),
              f(t.translation.y)},
             {f(2 * (x * z - y * w)), f(2 * (y * z + x * w)), f(1 - 2 * (x * x + y * y)),
              f(t.translation.z)}}};
}

Skin::Skin(const figure::Skeleton& skeleton, const figure::Mesh& mesh)
    : skeleton_(skeleton), mesh_(mesh) {
    model_from_joint_.resize(skeleton.joints.size());
    figure::to_model_space(skeleton, figure::rest_pose(skeleton), model_from_joint_);
    for (const Transform& t : model_from_joint_) {
        joint_from_model_rest_.push_back(inverse(t));
    }
    matrices_.resize(skeleton.joints.size());
}

void Skin::apply(const figure::Pose& pose, float* positions_world,
                 std::span<std::array<float, 3>> normals_world) {
    figure::to_model_space(skeleton_, pose, model_from_joint_);
    for (std::size_t j = 0; j < matrices_.size(); ++j) {
        matrices_[j] = matrix_of(model_from_joint_[j] * joint_from_model_rest_[j]);
    }
    for (std::size_t v = 0; v < mesh_.positions.size(); ++v) {
        const auto& joints = mesh_.joints[v];
        const auto& weights = mesh_.weights[v];
        if (weights[0] == 1) {
            transform(matrices_[joints[0]], mesh_.positions[v], mesh_.normals[v],
                      positions_world + 4 * v, normals_world[v]);
            continue;
        }
        Matrix34 m{};
        for (std::size_t k = 0; k < 4; ++k) {
            const Matrix34& one = matrices_[joints[k]];
            for (std::size_t r = 0; r < 3; ++r) {
                for (std::size_t c = 0; c < 4; ++c) {
                    m[r][c] += weights[k] * one[r][c];
                }
            }
        }
        transform(m, mesh_.positions[v], mesh_.normals[v], positions_world + 4 * v,
                  normals_world[v]);
    }
}

void place(const figure::Mesh& mesh, const Transform& world_from_mesh, float* positions_world,
           std::span<std::array<float, 3>> normals_world) {
    const Matrix34 m = matrix_of(world_from_mesh);
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        transform(m, mesh.positions[v], mesh.normals[v], positions_world + 4 * v, normals_world[v]);
    }
}

}  // namespace puppetri::render
