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

int wrap_word(figure::TextureWrap wrap) {
    return wrap == figure::TextureWrap::kClamp    ? 33071
           : wrap == figure::TextureWrap::kMirror ? 33648
                                                  : 10497;
}

template <class T>
int index_in(std::vector<T>& list, const T& value) {
    const auto at = std::find(list.begin(), list.end(), value);
    if (at == list.end()) {
        list.push_back(value);
        return static_cast<int>(list.size()) - 1;
    }
    return static_cast<int>(at - list.begin());
}

std::uint32_t texture_index(GltfMeshes& all, GltfBuffer& buffer, const figure::Mesh& mesh,
                            std::uint32_t texture) {
    if (texture == figure::kNoTexture) {
        return texture;
    }
    const figure::Texture& t = mesh.textures[texture];
    const auto image = all.image_of.emplace(t.bytes, static_cast<int>(all.images.size()));
    if (image.second) {
        all.images.push_back({t.name, t.mime_type, buffer.add_bytes(t.bytes)});
    }
    const int sampler =
        index_in(all.samplers, {wrap_word(t.wrap_u), wrap_word(t.wrap_v), t.smooth});
    return static_cast<std::uint32_t>(index_in(all.textures, {image.first->second, sampler}));
}

int material_index(GltfMeshes& all, GltfBuffer& buffer, const figure::Mesh& mesh,
                   figure::Material material) {
    for (std::uint32_t* texture :
         {&material.base_colour_texture, &material.metallic_roughness_texture,
          &material.normal_texture, &material.occlusion_texture, &material.emissive_texture}) {
        *texture = texture_index(all, buffer, mesh, *texture);
    }
    return index_in(all.materials, material);
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
    if (!mesh.uvs.empty()) {
        PUP_REQUIRE(mesh.uvs.size() == vertices);
        std::vector<float> uvs;
        uvs.reserve(vertices * 2);
        for (const auto& uv : mesh.uvs) {
            uvs.insert(uvs.end(), uv.begin(), uv.end());
        }
        shared.uvs = buffer.add(std::span<const float>(uvs), Target::kVertices, Component::kFloat,
                                "VEC2", 2);
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
            primitive.material = material_index(all, buffer, mesh, mesh.materials[part.material]);
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
            if (primitive.uvs >= 0) {
                json.member("TEXCOORD_0", primitive.uvs);
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

namespace {

void write_texture(JsonWriter& json, const char* name, std::uint32_t texture,
                   const char* factor = nullptr, float value = 1) {
    if (texture == figure::kNoTexture) {
        return;
    }
    json.key(name).begin_object().member("index", static_cast<int>(texture));
    if (factor != nullptr && value != 1) {
        json.key(factor).number(value);
    }
    json.end_object();
}

}  // namespace

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
        if (material.alpha == 1) {
            json.integer(1).end_array();
        } else {
            json.number(std::clamp(material.alpha, 0.0f, 1.0f)).end_array();
        }
        json.key("metallicFactor").number(std::clamp(material.metallic, 0.0f, 1.0f));
        json.key("roughnessFactor").number(std::clamp(material.roughness, 0.0f, 1.0f));
        write_texture(json, "baseColorTexture", material.base_colour_texture);
        write_texture(json, "metallicRoughnessTexture", material.metallic_roughness_texture);
        json.end_object();
        write_texture(json, "normalTexture", material.normal_texture, "scale",
                      material.normal_scale);
        write_texture(json, "occlusionTexture", material.occlusion_texture, "strength",
                      material.occlusion_strength);
        write_texture(json, "emissiveTexture", material.emissive_texture);
        if (material.emissive != std::array<float, 3>{}) {
            json.key("emissiveFactor").begin_array();
            for (const float part : material.emissive) {
                json.number(std::clamp(part, 0.0f, 1.0f));
            }
            json.end_array();
        }
        if (material.alpha_mode != figure::AlphaMode::kOpaque) {
            const bool mask = material.alpha_mode == figure::AlphaMode::kMask;
            json.member("alphaMode", mask ? "MASK" : "BLEND");
            if (mask) {
                json.key("alphaCutoff").number(std::clamp(material.alpha_cutoff, 0.0f, 1.0f));
            }
        }
        if (material.double_sided) {
            json.key("doubleSided").boolean(true);
        }
        json.end_object();
    }
}

void write_textures(JsonWriter& json, const GltfMeshes& all) {
    for (const GltfTextureOut& texture : all.textures) {
        json.begin_object().member("sampler", texture.sampler).member("source", texture.image);
        json.end_object();
    }
}

void write_samplers(JsonWriter& json, const GltfMeshes& all) {
    for (const GltfSamplerOut& s : all.samplers) {
        json.begin_object().member("magFilter", s.smooth ? 9729 : 9728);
        json.member("minFilter", s.smooth ? 9987 : 9984);
        json.member("wrapS", s.wrap_s).member("wrapT", s.wrap_t).end_object();
    }
}

void write_images(JsonWriter& json, const GltfMeshes& all) {
    for (const GltfImageOut& image : all.images) {
        json.begin_object();
        if (!image.name.empty()) {
            json.member("name", image.name);
        }
        json.member("bufferView", image.view).member("mimeType", image.mime_type).end_object();
    }
}

}  // namespace puppetri::io
