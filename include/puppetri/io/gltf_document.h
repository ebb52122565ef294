// SPDX-License-Identifier: MIT
// A glTF 2.0 or GLB file as data that has been checked: the one reader on which characters and
// clips are built. All indices lie inside, all accessors lie inside their buffers, all numbers are
// finite, the nodes are a forest; whoever reads on needs no further checks. Nothing is drawn from
// the network; buffers and images come from data URIs, the binary chunk, or files beside.
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "puppetri/base/diagnostic.h"
#include "puppetri/math/transform.h"

namespace puppetri::scene {
class FileSource;
}

namespace puppetri::io {

inline constexpr std::uint32_t kNoGltf = ~std::uint32_t{0};  // an index that is not there

struct GltfNode {
    std::string name;  // maybe empty
    std::uint32_t parent = kNoGltf;
    std::vector<std::uint32_t> children;
    // parent_from_node = translation * rotation * scale. A matrix is taken apart into them; what it
    // shears is left out.
    Transform parent_from_node;
    Vec3 scale{1, 1, 1};
    std::uint32_t mesh = kNoGltf, skin = kNoGltf;
};

struct GltfSkin {
    std::string name;
    std::vector<std::uint32_t> joints;  // nodes, at least one, each once
    std::uint32_t inverse_bind_matrices =
        kNoGltf;  // accessor of MAT4 floats, one per joint or more
};

struct GltfPrimitiveIn {
    std::uint32_t positions = kNoGltf, normals = kNoGltf, uvs = kNoGltf, joints = kNoGltf,
                  weights = kNoGltf, indices = kNoGltf;  // accessors of one count (not indices)
    std::uint32_t material = kNoGltf;
    std::uint32_t mode = 4;  // 4 triangles, 5 strip, 6 fan; others (points, lines) are not shown
};

struct GltfMeshIn {
    std::string name;
    std::vector<GltfPrimitiveIn> primitives;
};

struct GltfImage {
    std::string name, mime_type;
    std::string bytes;  // the encoded file
};

struct GltfTexture {
    std::uint32_t image = kNoGltf;
    std::uint32_t wrap_s = 10497, wrap_t = 10497;
    std::uint32_t mag_filter = 9729;
};

struct GltfMaterialIn {
    std::string name;
    std::array<double, 4> base_colour{1, 1, 1, 1};
    double metallic = 1, roughness = 1, alpha_cutoff = 0.5, normal_scale = 1,
           occlusion_strength = 1;
    std::array<double, 3> emissive{};
    std::string alpha_mode = "OPAQUE";
    bool double_sided = false;
    std::uint32_t base_colour_texture = kNoGltf, metallic_roughness_texture = kNoGltf,
                  normal_texture = kNoGltf, occlusion_texture = kNoGltf, emissive_texture = kNoGltf;
};

enum class GltfPath : std::uint8_t { kTranslation, kRotation, kScale, kWeights };
enum class GltfInterpolation : std::uint8_t { kStep, kLinear, kCubicSpline };

// Keys of one property of one node. The times are finite, not negative and strictly increasing;
// there are as many values as the interpolation wants (three per key for kCubicSpline: in-tangent,
// value, out-tangent). kWeights are left out.
struct GltfChannelIn {
    std::uint32_t node = 0;
    GltfPath path = GltfPath::kRotation;
    GltfInterpolation interpolation = GltfInterpolation::kLinear;
    std::uint32_t times = 0, values = 0;  // accessors
};

struct GltfAnimationIn {
    std::string name;
    std::vector<GltfChannelIn> channels;
};

// A bone of a humanoid: VRM 1.0 names ("leftUpperArm"), whatever the version of the file.
struct GltfBone {
    std::string bone;
    std::uint32_t node = 0;
};

class GltfDocument {
 public:
    // Reads the bytes of a file. `path` names it in diagnostics; other files that it names are read
    // from `files` beside it (null: there are none).
    // Fails   with every defect that was found, up to a hundred: where.file is the path (with line
    //         and column for JSON that is not JSON), the element is of the file: "accessor 7",
    //         "node 3 (hips)". Codes: "not-gltf", "bad-json", "bad-gltf", "gltf-version",
    //         "unsupported-extension" (required ones only), "missing-file", "too-large".
    // Cost    time and memory are linear in the bytes: what is decoded is bounded by
    //         kLargestDecoded.
    static Checked<GltfDocument> parse(std::string bytes, const std::string& path,
                                       scene::FileSource* files);
    static constexpr std::uint64_t kLargestDecoded = std::uint64_t{1} << 28;

    std::vector<GltfNode> nodes;
    std::vector<std::uint32_t> roots;  // of the scene that is shown
    std::vector<GltfSkin> skins;
    std::vector<GltfMeshIn> meshes;
    std::vector<GltfMaterialIn> materials;
    std::vector<GltfTexture> textures;
    std::vector<GltfImage> images;
    std::vector<GltfAnimationIn> animations;
    std::vector<GltfBone> humanoid;  // of VRM 0.x, VRM 1.0 or a VRM animation
    bool vrm_0 = false;              // such figures look along -Z
    bool vrm_animation = false;      // has VRMC_vrm_animation
    Diagnostics notes;               // what was left out: no errors

    // "node 3 (hips)".
    std::string node_text(std::uint32_t node) const;

    // The values of an accessor, component after component; normalised integers become fractions.
    // Components per element: 1, 2, 3, 4 or 16. Needs an index of the document.
    std::vector<float> floats(std::uint32_t accessor) const;
    std::vector<std::uint32_t> integers(std::uint32_t accessor) const;
    std::uint32_t count(std::uint32_t accessor) const { return accessors_[accessor].count; }
    std::uint32_t components(std::uint32_t accessor) const {
        return accessors_[accessor].components;
    }

 private:
    friend class GltfReader;
    struct View {
        std::uint32_t buffer = 0;
        std::uint64_t offset = 0, length = 0;
        std::uint32_t stride = 0;  // 0: tightly packed
    };
    struct Accessor {
        std::uint32_t view = kNoGltf;  // none: zeros
        std::uint64_t offset = 0;
        std::uint32_t count = 0, components = 1, component_type = 5126;
        bool normalized = false;
        std::uint32_t sparse_count = 0, sparse_index_type = 5125;
        std::uint32_t sparse_indices_view = kNoGltf, sparse_values_view = kNoGltf;
        std::uint64_t sparse_indices_offset = 0, sparse_values_offset = 0;
    };
    template <class T>
    void read(std::uint32_t accessor, std::vector<T>& out) const;

    std::vector<std::string> buffers_;
    std::vector<View> views_;
    std::vector<Accessor> accessors_;
};

}  // namespace puppetri::io
