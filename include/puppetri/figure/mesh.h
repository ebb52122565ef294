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

inline constexpr std::uint32_t kNoTexture = ~std::uint32_t{0};

// What happens outside [0, 1] of texture coordinates.
enum class TextureWrap : std::uint8_t { kRepeat, kClamp, kMirror };

// A picture as its file has it, undecoded: PNG or JPEG.
struct Texture {
    std::string name;
    std::string mime_type;  // "image/png", "image/jpeg"
    std::string bytes;
    TextureWrap wrap_u = TextureWrap::kRepeat, wrap_v = TextureWrap::kRepeat;
    bool smooth = true;  // between texels
    bool operator==(const Texture&) const = default;
};

enum class AlphaMode : std::uint8_t { kOpaque, kMask, kBlend };

// The base colour texture is in sRGB and multiplies base_colour and alpha; the others as glTF 2.0
// says.
struct Material {
    std::string name;
    std::array<float, 3> base_colour{0.8f, 0.8f, 0.8f};  // linear RGB
    float roughness = 0.7f;
    float metallic = 0;
    float alpha = 1;
    AlphaMode alpha_mode = AlphaMode::kOpaque;
    float alpha_cutoff = 0.5f;
    bool double_sided = false;
    std::array<float, 3> emissive{};
    float normal_scale = 1, occlusion_strength = 1;
    // Of Mesh::textures.
    std::uint32_t base_colour_texture = kNoTexture, metallic_roughness_texture = kNoTexture,
                  normal_texture = kNoTexture, occlusion_texture = kNoTexture,
                  emissive_texture = kNoTexture;
    bool operator==(const Material&) const = default;
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
    // Texture coordinates, one per position, or empty; v grows downwards, as glTF has it.
    std::vector<std::array<float, 2>> uvs;
    std::vector<Texture> textures;
};

}  // namespace puppetri::figure
