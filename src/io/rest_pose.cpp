// SPDX-License-Identifier: MIT
#include "rest_pose.h"

#include "puppetri/base/require.h"
#include "puppetri/math/rotation.h"

namespace puppetri::io {

std::vector<Transform> model_from_rest(const figure::Skeleton& skeleton) {
    std::vector<Transform> model_from_joint(skeleton.joints.size());
    figure::to_model_space(skeleton, figure::rest_pose(skeleton), model_from_joint);
    return model_from_joint;
}

figure::Skeleton with_a_pose(const figure::Skeleton& t_pose) {
    const std::vector<Transform> model_from_joint = model_from_rest(t_pose);
    figure::Skeleton result = t_pose;
    for (const char* name : {"leftUpperArm", "rightUpperArm"}) {
        const figure::JointIndex joint = t_pose.find(name);
        if (!joint.valid()) {
            continue;
        }
        // About the model's +Z, which the figure faces: the left arm (+X) goes down by a negative
        // angle.
        const Quat lowered = about_z(radians(name[0] == 'l' ? -45 : 45));
        const figure::JointIndex parent = t_pose.joints[joint.value].parent;
        const Quat model_from_parent =
            parent.valid() ? model_from_joint[parent.value].rotation : Quat{};
        result.joints[joint.value].parent_from_joint_rest.rotation =
            conjugate(model_from_parent) * lowered * model_from_joint[joint.value].rotation;
    }
    return result;
}

figure::Mesh rebound(const figure::Mesh& mesh, const figure::Skeleton& from,
                     const figure::Skeleton& to) {
    PUP_REQUIRE(from.joints.size() == to.joints.size());
    const std::vector<Transform> before = model_from_rest(from), after = model_from_rest(to);
    std::vector<Transform> after_from_before(before.size());
    for (std::size_t j = 0; j < before.size(); ++j) {
        after_from_before[j] = after[j] * inverse(before[j]);
    }
    figure::Mesh result = mesh;
    for (std::size_t v = 0; v < mesh.joints.size(); ++v) {
        const auto& p = mesh.positions[v];
        const auto& n = mesh.normals[v];
        Vec3 position, normal;
        for (std::size_t k = 0; k < 4; ++k) {
            const double weight = mesh.weights[v][k];
            if (weight > 0) {
                const Transform& move = after_from_before[mesh.joints[v][k]];
                position = position + weight * (move * Vec3{p[0], p[1], p[2]});
                normal = normal + weight * rotate(move.rotation, Vec3{n[0], n[1], n[2]});
            }
        }
        normal = normalized(normal, {n[0], n[1], n[2]});
        result.positions[v] = {static_cast<float>(position.x), static_cast<float>(position.y),
                               static_cast<float>(position.z)};
        result.normals[v] = {static_cast<float>(normal.x), static_cast<float>(normal.y),
                             static_cast<float>(normal.z)};
    }
    return result;
}

std::string node_name(std::string_view text) {
    std::string name(text);
    for (char& c : name) {
        const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                           (c >= '0' && c <= '9') || c == '_' || c == '-' ||
                           static_cast<unsigned char>(c) >= 0x80;
        c = plain ? c : '_';
    }
    return name;
}

}  // namespace puppetri::io
