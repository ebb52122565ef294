// SPDX-License-Identifier: MIT
// Writes takes as glTF 2.0: one skin per actor, props and sets as meshes, one animation per take,
// markers in the extras of the animations (docs/formats/gltf.md). Buffers are written straight from
// the keys; a joint that does not move gets no channel, or one key where it rests elsewhere than
// the skeleton says.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "puppetri/base/diagnostic.h"
#include "puppetri/figure/mesh.h"
#include "puppetri/io/bone_names.h"
#include "puppetri/io/take.h"

namespace puppetri::io {

// Something that stands still: a floor, a road.
struct StaticMesh {
    std::string name;
    const figure::Mesh* mesh = nullptr;
    Transform world_from_mesh;
};

// A camera that looks along its -Z with +Y up.
struct CameraTrack {
    std::string name;
    double fov_y_rad = 0.61;
    double aspect = 16.0 / 9;
    std::vector<Transform> world_from_camera;  // one per key of the first take
};

struct GltfOptions {
    BoneNames names = BoneNames::kVrm;
    // Leaves keys out where the joints' positions stay within this distance of the sampled ones, at
    // every key; 0 keeps all. Keys of events always stay.
    double reduce_m = 0;
    std::string title;  // of the scene
};

struct GltfContent {
    std::span<const Take> takes;  // at least one; actors and props of one name are the same in all
    std::span<const StaticMesh> sets;
    std::span<const CameraTrack> cameras;
};

// One file with everything in it.
std::string make_glb(const GltfContent& content, const GltfOptions& options);

// The readable form: JSON, and the buffer that it finds under buffer_uri.
struct GltfText {
    std::string json, binary;
};
GltfText make_gltf(const GltfContent& content, const GltfOptions& options,
                   std::string_view buffer_uri);

// Writes FILE.glb, or FILE.gltf with FILE.bin beside it. Each whole or absent.
// Fails   "cannot-write", "disk-full".
Status write_gltf(const std::string& path, const GltfContent& content, const GltfOptions& options);

}  // namespace puppetri::io
