// SPDX-License-Identifier: MIT
// What must hold for any bytes whatever that are given to the reader of glTF files and to that of
// characters: the test of hostile files and the fuzzer ask the same.
#pragma once
#include <cmath>
#include <string>
#include <string_view>

#include "puppetri/io/character_reader.h"

namespace puppetri::io::testing {

inline bool finite(Vec3 v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}
inline bool finite(const Transform& t) {
    return finite(t.translation) && std::isfinite(t.rotation.x) && std::isfinite(t.rotation.y) &&
           std::isfinite(t.rotation.z) && std::isfinite(t.rotation.w);
}

inline std::string broken_gltf_diagnostics(const Diagnostics& list) {
    for (const Diagnostic& d : list) {
        if (d.message.empty() || d.code.empty() || d.remedy.empty() ||
            (d.element.empty() && d.code != "more-defects")) {
            return "a diagnostic says what is wrong, with what, and what to do: " + d.code;
        }
        if (d.where.file.empty() && d.code != "more-defects") {
            return "a diagnostic names the file";
        }
    }
    return has_errors(list) ? "" : "who fails says why";
}

inline std::string broken_character_law(const figure::Character& c) {
    const std::size_t joints = c.skeleton.joints.size();
    for (std::size_t j = 0; j < joints; ++j) {
        const figure::Joint& joint = c.skeleton.joints[j];
        if (joint.parent.valid() != (j > 0) || (j > 0 && joint.parent.value >= j)) {
            return "parents come first";
        }
        if (!finite(joint.parent_from_joint_rest)) {
            return "the rest pose is made of numbers";
        }
    }
    const figure::Mesh& m = c.mesh;
    const std::size_t vertices = m.positions.size();
    if (m.normals.size() != vertices || m.joints.size() != vertices ||
        m.weights.size() != vertices || (!m.uvs.empty() && m.uvs.size() != vertices)) {
        return "every vertex has all it needs";
    }
    for (std::size_t v = 0; v < vertices; ++v) {
        float sum = 0;
        for (std::size_t k = 0; k < 4; ++k) {
            if (m.joints[v][k] >= joints || !(m.weights[v][k] >= 0)) {
                return "vertices hang on joints of the skeleton";
            }
            sum += m.weights[v][k];
        }
        if (!(std::fabs(sum - 1) < 1e-4f)) {
            return "weights sum to one";
        }
        for (const float p : m.positions[v]) {
            if (!std::isfinite(p)) {
                return "vertices are numbers";
            }
        }
    }
    for (const auto& t : m.triangles) {
        for (const std::uint32_t v : t) {
            if (v >= vertices) {
                return "triangles are made of vertices";
            }
        }
    }
    for (const figure::MeshPart& part : m.parts) {
        if (part.material >= m.materials.size() ||
            part.first_triangle + part.triangle_count > m.triangles.size()) {
            return "parts are of the mesh";
        }
    }
    if (c.humanoid) {
        const figure::Figure& f = c.humanoid->figure;
        for (const figure::Joint& joint : f.skeleton.joints) {
            if (!finite(joint.parent_from_joint_rest)) {
                return "the humanoid is made of numbers";
            }
        }
        figure::Pose raw;
        c.carry(figure::rest_pose(f.skeleton), raw);
        for (const Transform& t : raw.parent_from_joint) {
            if (!finite(t)) {
                return "the rig gives numbers";
            }
        }
    }
    return {};
}

// Empty when all is well, otherwise the law that the bytes broke.
inline std::string broken_gltf_law(std::string bytes) {
    const Checked<GltfDocument> document =
        GltfDocument::parse(std::move(bytes), "hostile", nullptr);
    if (!document) {
        return broken_gltf_diagnostics(document.error());
    }
    for (const bool humanoid : {true, false}) {
        scene::CharacterRequest request;
        request.path = "hostile";
        request.humanoid = humanoid;
        request.height_m = 1.7;
        Diagnostics notes;
        const Checked<figure::Character> c = read_character(*document, request, notes);
        const std::string law = c ? broken_character_law(*c) : broken_gltf_diagnostics(c.error());
        if (!law.empty()) {
            return law;
        }
    }
    return {};
}

}  // namespace puppetri::io::testing
