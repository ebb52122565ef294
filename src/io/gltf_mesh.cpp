// SPDX-License-Identifier: MIT
#include "gltf_mesh.h"

#include <algorithm>
#include <cmath>

#include "puppetri/base/require.h"
#include "rest_pose.h"

namespace puppetri::io {
namespace {

// What one vertex may hang on: at most four different joints, heaviest first, unused slots all
// zero, and weights whose sum is 1 as near as floats can say it.
struct Influences {
    std::array<std::uint16_t, 4> joints{};
    std::array<float, 4> weights{};
};

Influences cleaned(const std::array<std::uint16_t, 4>& joints,
                   const std::array<float, 4>& weights) {
    std::array<std::pair<double, std::uint16_t>, 4> found{};
    std::size_t count = 0;
    double sum = 0;
    for (std::size_t k = 0; k < 4; ++k) {
        if (!(weights[k] > 0)) {
            continue;
        }
        sum += weights[k];
        std::size_t same = 0;
        while (same < count && found[same].second != joints[k]) {
            ++same;
        }
        count = std::max(count, same + 1);
        found[same].first += weights[k];
        found[same].second = joints[k];
    }
    std::stable_sort(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(count),
                     [](const auto& a, const auto& b) { return a.first > b.first; });
    Influences result;
    if (count == 0) {
        result.weights[0] = 1;
        return result;
    }
    float rest = 1;
    for (std::size_t k = count; k-- > 1;) {
        result.joints[k] = found[k].second;
        result.weights[k] = static_cast<float>(found[k].first / sum);
        rest -= result.weights[k];
    }
    result.joints[0] = found[0].second;
    result.weights[0] = rest;
    return result;
}

std::vector<float> flat(const std::vector<std::array<float, 3>>& vectors) {
    std::vector<float> values;
    values.reserve(vectors.size() * 3);
    for (const auto& v : vectors) {
        values.insert(values.end(), v.begin(), v.end());
    }
    return values;
}

std::vector<float> unit_vectors(const std::vector<std::array<float, 3>>& vectors) {
    std::vector<float> values;
    values.reserve(vectors.size() * 3);
    for (const auto& v : vectors) {
        const Vec3 n = normalized({v[0], v[1], v[2]}, {0, 1, 0});
        values.push_back(static_cast<float>(n.x));
        values.push_back(static_cast<float>(n.y));
        values.push_back(static_cast<float>(n.z));
    }
    return values;
}

int add_indices(GltfBuffer& buffer, std::span<const std::array<std::uint32_t, 3>> triangles,
                std::size_t vertices) {
    if (vertices <= 0xFFFF) {
        std::vector<std::uint16_t> indices;
        indices.reserve(triangles.size() * 3);
        for (const auto& triangle : triangles) {
            for (const std::uint32_t vertex : triangle) {
                indices.push_back(static_cast<std::uint16_t>(vertex));
            }
        }
        return buffer.add(std::span<const std::uint16_t>(indices), Target::kIndices,
                          Component::kU16, "SCALAR", 1);
    }
    std::vector<std::uint32_t> indices;
    indices.reserve(triangles.size() * 3);
    for (const auto& triangle : triangles) {
        indices.insert(indices.end(), triangle.begin(), triangle.end());
    }
    return buffer.add(std::span<const std::uint32_t>(indices), Target::kIndices, Component::kU32,
                      "SCALAR", 1);
}

bool same_material(const figure::Material& a, const figure::Material& b) {
    return a.name == b.name && a.base_colour == b.base_colour && a.roughness == b.roughness &&
           a.metallic == b.metallic;
}

int material_index(GltfMeshes& all, const figure::Material& material) {
    for (std::size_t i = 0; i < all.materials.size(); ++i) {
        if (same_material(all.materials[i], material)) {
            return static_cast<int>(i);
        }
    }
    all.materials.push_back(material);
    return static_cast<int>(all.materials.size()) - 1;
}

}  // namespace

int add_mesh(GltfMeshes& all, GltfBuffer& buffer, const std::string& name,
             const figure::Mesh& mesh) {
    const std::size_t vertices = mesh.positions.size();
    PUP_REQUIRE(mesh.normals.size() == vertices);
    PUP_REQUIRE(mesh.joints.empty() ||
                (mesh.joints.size() == vertices && mesh.weights.size() == vertices));
    if (mesh.triangles.empty()) {
        return -1;
    }
    GltfPrimitive shared;
    shared.positions = buffer.add(std::span<const float>(flat(mesh.positions)), Target::kVertices,
                                  Component::kFloat, "VEC3", 3, true);
    shared.normals = buffer.add(std::span<const float>(unit_vectors(mesh.normals)),
                                Target::kVertices, Component::kFloat, "VEC3", 3);
    if (!mesh.joints.empty()) {
        std::vector<std::uint16_t> joints;
        std::vector<float> weights;
        joints.reserve(vertices * 4);
        weights.reserve(vertices * 4);
        for (std::size_t v = 0; v < vertices; ++v) {
            const Influences influences = cleaned(mesh.joints[v], mesh.weights[v]);
            joints.insert(joints.end(), influences.joints.begin(), influences.joints.end());
            weights.insert(weights.end(), influences.weights.begin(), influences.weights.end());
        }
        shared.joints = buffer.add(std::span<const std::uint16_t>(joints), Target::kVertices,
                                   Component::kU16, "VEC4", 4);
        shared.weights = buffer.add(std::span<const float>(weights), Target::kVertices,
                                    Component::kFloat, "VEC4", 4);
    }
    GltfMesh result{name, {}};
    std::vector<figure::MeshPart> parts = mesh.parts;
    if (parts.empty()) {
        parts.push_back({0, 0, static_cast<std::uint32_t>(mesh.triangles.size())});
    }
    for (const figure::MeshPart& part : parts) {
        if (part.triangle_count == 0) {
            continue;
        }
        GltfPrimitive primitive = shared;
        primitive.indices = add_indices(
            buffer, std::span(mesh.triangles).subspan(part.first_triangle, part.triangle_count),
            vertices);
        if (part.material < mesh.materials.size()) {
            primitive.material = material_index(all, mesh.materials[part.material]);
        }
        result.primitives.push_back(primitive);
    }
    all.meshes.push_back(std::move(result));
    return static_cast<int>(all.meshes.size()) - 1;
}

int add_inverse_bind_matrices(GltfBuffer& buffer, const figure::Skeleton& skeleton) {
    std::vector<float> matrices;
    for (const Transform& model_from_joint : model_from_rest(skeleton)) {
        const Transform joint_from_model = inverse(model_from_joint);
        for (const Vec3 column :
             {rotate(joint_from_model.rotation, Vec3{1, 0, 0}),
              rotate(joint_from_model.rotation, Vec3{0, 1, 0}),
              rotate(joint_from_model.rotation, Vec3{0, 0, 1}), joint_from_model.translation}) {
            matrices.push_back(static_cast<float>(column.x));
            matrices.push_back(static_cast<float>(column.y));
            matrices.push_back(static_cast<float>(column.z));
            matrices.push_back(0);
        }
        matrices.back() = 1;
    }
    return buffer.add(std::span<const float>(matrices), Target::kNone, Component::kFloat, "MAT4",
                      16);
}

void write_meshes(JsonWriter& json, const GltfMeshes& all) {
    for (const GltfMesh& mesh : all.meshes) {
        json.begin_object().member("name", mesh.name).key("primitives").begin_array();
        for (const GltfPrimitive& primitive : mesh.primitives) {
            json.begin_object().key("attributes").begin_object();
            json.member("POSITION", primitive.positions).member("NORMAL", primitive.normals);
            if (primitive.joints >= 0) {
                json.member("JOINTS_0", primitive.joints).member("WEIGHTS_0", primitive.weights);
            }
            json.end_object().member("indices", primitive.indices);
            if (primitive.material >= 0) {
                json.member("material", primitive.material);
            }
            json.end_object();
        }
        json.end_array().end_object();
    }
}

void write_materials(JsonWriter& json, const GltfMeshes& all) {
    for (const figure::Material& material : all.materials) {
        json.begin_object()
            .member("name", material.name)
            .key("pbrMetallicRoughness")
            .begin_object();
        json.key("baseColorFactor").begin_array();
        for (const float part : material.base_colour) {
            json.number(std::clamp(part, 0.0f, 1.0f));
        }
        json.integer(1).end_array();
        json.key("metallicFactor").number(std::clamp(material.metallic, 0.0f, 1.0f));
        json.key("roughnessFactor").number(std::clamp(material.roughness, 0.0f, 1.0f));
        json.end_object().end_object();
    }
}

}  // namespace puppetri::io
