// SPDX-License-Identifier: MIT
#include "character_mesh.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace puppetri::io {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

std::vector<Triangle> triangles_of(const GltfDocument& document, const GltfPrimitiveIn& p) {
    std::vector<std::uint32_t> order;
    if (p.indices != kNoGltf) {
        order = document.integers(p.indices);
    } else {
        order.resize(document.count(p.positions));
        for (std::uint32_t i = 0; i < order.size(); ++i) {
            order[i] = i;
        }
    }
    std::vector<Triangle> list;
    if (p.mode == 4) {
        for (std::size_t i = 0; i + 2 < order.size(); i += 3) {
            list.push_back({order[i], order[i + 1], order[i + 2]});
        }
    } else if (p.mode == 5) {
        for (std::size_t i = 0; i + 2 < order.size(); ++i) {
            list.push_back({order[i], order[i + 1 + i % 2], order[i + 2 - i % 2]});
        }
    } else if (p.mode == 6) {
        for (std::size_t i = 1; i + 1 < order.size(); ++i) {
            list.push_back({order[0], order[i], order[i + 1]});
        }
    }
    return list;
}

// Means over the triangles of a vertex, weighted by their areas.
std::vector<Vec3> normals_of(const std::vector<Vec3>& positions,
                             const std::vector<Triangle>& triangles) {
    std::vector<Vec3> sum(positions.size());
    for (const Triangle& t : triangles) {
        const Vec3 n = cross(positions[t[1]] - positions[t[0]], positions[t[2]] - positions[t[0]]);
        for (const std::uint32_t v : t) {
            sum[v] = sum[v] + n;
        }
    }
    return sum;
}

// Of a vertex: weights that sum to 1; without any, the first joint.
CharacterVertex vertex_of(const CharacterPart& part, const std::uint32_t* joints,
                          const float* weights) {
    CharacterVertex v;
    float sum = 0;
    for (std::size_t k = 0; k < 4; ++k) {
        v.joints[k] = part.joints[weights[k] > 0 ? joints[k] : 0];
        v.weights[k] = std::fmax(weights[k], 0.0f);
        sum += v.weights[k];
    }
    for (float& w : v.weights) {
        w = sum > 0 ? w / sum : 0;
    }
    v.weights[0] = sum > 0 ? v.weights[0] : 1;
    return v;
}

}  // namespace

void add_positions(const GltfDocument& document, const CharacterPart& part, CharacterMesh& mesh) {
    for (const GltfPrimitiveIn& p : document.meshes[part.mesh].primitives) {
        if (p.mode < 4 || p.mode > 6) {
            continue;
        }
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        const std::vector<float> positions = document.floats(p.positions);
        const std::size_t count = positions.size() / 3;
        const bool skinned = part.skinned && p.joints != kNoGltf;
        const std::vector<std::uint32_t> joints =
            skinned ? document.integers(p.joints) : std::vector<std::uint32_t>{};
        const std::vector<float> weights =
            skinned ? document.floats(p.weights) : std::vector<float>{};
        const std::vector<float> uvs =
            p.uvs != kNoGltf ? document.floats(p.uvs) : std::vector<float>(count * 2, 0.0f);
        mesh.has_uvs = mesh.has_uvs || p.uvs != kNoGltf;
        std::vector<Affine> model_from_vertex(1, part.model_from_mesh);
        for (std::size_t v = 0; v < count; ++v) {
            CharacterVertex vertex;
            if (skinned) {
                vertex = vertex_of(part, &joints[v * 4], &weights[v * 4]);
            } else {
                vertex.joints.fill(part.holder);
                if (part.skinned) {
                    vertex.joints.fill(part.joints.front());
                }
                vertex.weights[0] = 1;
            }
            const Vec3 at{positions[v * 3], positions[v * 3 + 1], positions[v * 3 + 2]};
            Vec3 model = part.model_from_mesh * at;
            if (skinned && !part.model_from_joint_mesh.empty()) {
                model = {};
                for (std::size_t k = 0; k < 4; ++k) {
                    const float w = vertex.weights[k];
                    const std::size_t joint = weights[v * 4 + k] > 0 ? joints[v * 4 + k] : 0;
                    model =
                        model + (part.model_from_joint_mesh[joint] * at) * static_cast<double>(w);
                }
            }
            mesh.positions.push_back(model);
            mesh.vertices.push_back(vertex);
            mesh.uvs.push_back({uvs[v * 2], uvs[v * 2 + 1]});
        }
        std::vector<Triangle> triangles = triangles_of(document, p);
        const bool mirrored = part.model_from_mesh.determinant() < 0;
        if (mirrored) {
            for (Triangle& t : triangles) {
                std::swap(t[1], t[2]);
            }
        }
        if (p.normals != kNoGltf && part.model_from_joint_mesh.empty()) {
            // Normals go by the cofactors: they stay orthogonal under scales that differ.
            const Affine& a = part.model_from_mesh;
            const Vec3 x = cross(a.y, a.z), y = cross(a.z, a.x), z = cross(a.x, a.y);
            const double sign = mirrored ? -1 : 1;
            const std::vector<float> n = document.floats(p.normals);
            for (std::size_t v = 0; v < count; ++v) {
                mesh.normals.push_back((x * n[v * 3] + y * n[v * 3 + 1] + z * n[v * 3 + 2]) * sign);
            }
        } else {
            const std::vector<Vec3> own(mesh.positions.begin() + first, mesh.positions.end());
            const std::vector<Vec3> normals = normals_of(own, triangles);
            mesh.normals.insert(mesh.normals.end(), normals.begin(), normals.end());
        }
        CharacterMesh::Triangles made{p.material, std::move(triangles)};
        for (Triangle& t : made.list) {
            for (std::uint32_t& v : t) {
                v += first;
            }
        }
        mesh.parts.push_back(std::move(made));
    }
}

namespace {

figure::TextureWrap wrap_of(std::uint32_t word) {
    return word == 33071   ? figure::TextureWrap::kClamp
           : word == 33648 ? figure::TextureWrap::kMirror
                           : figure::TextureWrap::kRepeat;
}

class Materials {
 public:
    Materials(const GltfDocument& document, figure::Mesh& mesh) : doc_(document), mesh_(mesh) {}

    std::uint32_t index(std::uint32_t material) {
        const auto known = of_.find(material);
        if (known != of_.end()) {
            return known->second;
        }
        mesh_.materials.push_back(material == kNoGltf ? figure::Material{"default"}
                                                      : made(doc_.materials[material]));
        return of_[material] = static_cast<std::uint32_t>(mesh_.materials.size() - 1);
    }

 private:
    figure::Material made(const GltfMaterialIn& in) {
        figure::Material m;
        m.name = in.name;
        const auto part = [](double v) { return static_cast<float>(std::clamp(v, 0.0, 1.0)); };
        for (std::size_t i = 0; i < 3; ++i) {
            m.base_colour[i] = part(in.base_colour[i]);
            m.emissive[i] = part(in.emissive[i]);
        }
        m.alpha = part(in.base_colour[3]);
        m.roughness = part(in.roughness);
        m.metallic = part(in.metallic);
        m.alpha_mode = in.alpha_mode == "MASK"    ? figure::AlphaMode::kMask
                       : in.alpha_mode == "BLEND" ? figure::AlphaMode::kBlend
                                                  : figure::AlphaMode::kOpaque;
        m.alpha_cutoff = part(in.alpha_cutoff);
        m.double_sided = in.double_sided;
        m.normal_scale = static_cast<float>(in.normal_scale);
        m.occlusion_strength = part(in.occlusion_strength);
        m.base_colour_texture = texture(in.base_colour_texture);
        m.metallic_roughness_texture = texture(in.metallic_roughness_texture);
        m.normal_texture = texture(in.normal_texture);
        m.occlusion_texture = texture(in.occlusion_texture);
        m.emissive_texture = texture(in.emissive_texture);
        return m;
    }
    std::uint32_t texture(std::uint32_t texture) {
        if (texture == kNoGltf || doc_.textures[texture].image == kNoGltf) {
            return figure::kNoTexture;
        }
        const GltfTexture& t = doc_.textures[texture];
        const GltfImage& image = doc_.images[t.image];
        const std::array<std::uint32_t, 4> key{t.image, t.wrap_s, t.wrap_t, t.mag_filter};
        const auto known = textures_.find(key);
        if (known != textures_.end()) {
            return known->second;
        }
        bytes_ += image.bytes.size();
        if (bytes_ > GltfDocument::kLargestDecoded) {
            return figure::kNoTexture;  // one picture in many ways
        }
        mesh_.textures.push_back({image.name, image.mime_type, image.bytes, wrap_of(t.wrap_s),
                                  wrap_of(t.wrap_t), t.mag_filter != 9728});
        return textures_[key] = static_cast<std::uint32_t>(mesh_.textures.size() - 1);
    }

    const GltfDocument& doc_;
    figure::Mesh& mesh_;
    std::map<std::uint32_t, std::uint32_t> of_;
    std::map<std::array<std::uint32_t, 4>, std::uint32_t> textures_;
    std::uint64_t bytes_ = 0;
};

std::array<float, 3> floats_of(Vec3 v) {
    return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

}  // namespace

figure::Mesh make_character_mesh(const GltfDocument& document, const CharacterMesh& in) {
    figure::Mesh mesh;
    for (std::size_t v = 0; v < in.positions.size(); ++v) {
        mesh.positions.push_back(floats_of(in.positions[v]));
        mesh.normals.push_back(floats_of(normalized(in.normals[v], {0, 1, 0})));
        std::array<std::uint16_t, 4> joints{};
        for (std::size_t k = 0; k < 4; ++k) {
            joints[k] = static_cast<std::uint16_t>(in.vertices[v].joints[k]);
        }
        mesh.joints.push_back(joints);
        mesh.weights.push_back(in.vertices[v].weights);
    }
    if (in.has_uvs) {
        mesh.uvs = in.uvs;
    }
    Materials materials(document, mesh);
    for (const CharacterMesh::Triangles& part : in.parts) {
        if (part.list.empty()) {
            continue;
        }
        mesh.parts.push_back({materials.index(part.material),
                              static_cast<std::uint32_t>(mesh.triangles.size()),
                              static_cast<std::uint32_t>(part.list.size())});
        mesh.triangles.insert(mesh.triangles.end(), part.list.begin(), part.list.end());
    }
    return mesh;
}

}  // namespace puppetri::io
