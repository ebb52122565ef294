// SPDX-License-Identifier: MIT
// Files of motion, whatever their format: keyframe files (docs/formats/keys.md), BVH, glTF and GLB,
// VRM animations. Reading gives clips and the skeleton that they were made for; writing needs both.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "puppetri/base/diagnostic.h"
#include "puppetri/figure/skeleton.h"
#include "puppetri/io/bone_names.h"
#include "puppetri/motion/clip.h"

namespace puppetri::scene {
class FileSource;
}

namespace puppetri::io {

enum class ClipFormat : std::uint8_t { kKeys, kBvh, kGltf, kVrma };
// "keys", "BVH", "glTF", "VRM animation".
const char* name_of(ClipFormat format);
// By the ending: .keys; .bvh; .gltf, .glb, .vrm; .vrma. None for others.
std::optional<ClipFormat> clip_format_of(std::string_view path);

struct ClipFile {
    ClipFormat format = ClipFormat::kKeys;
    // The tree of joints with its rest pose, in metres, +Y up, joint names unique. Of a keyframe
    // file that has none: empty.
    figure::Skeleton skeleton;
    std::vector<motion::Clip> clips;  // checked; names unique
    double frame_s = 0;               // of formats with a fixed frame time
    Diagnostics notes;                // warnings: odd scales, what was left out
};

struct ClipReadOptions {
    // A length of the file times this is metres. 0: the format's own unit (BVH: centimetres).
    double scale = 0;
    std::uint64_t largest_bytes = 1u << 28;
};

// Reads a file from memory. `files` gives what the file names beside itself (the .bin of a .gltf);
// may be null.
// Fails   with all defects, each naming line, joint, channel or accessor.
Checked<ClipFile> parse_clips(std::string bytes, const std::string& path,
                              const ClipReadOptions& options = {},
                              scene::FileSource* files = nullptr);
// The same from the disk. Fails "cannot-read" besides.
Checked<ClipFile> load_clips(const std::string& path, const ClipReadOptions& options = {});

struct ClipWriteOptions {
    // Frames per second of what is sampled (BVH, glTF); 0: the source's. A glTF file of a source
    // without frames has the keys of the clip, and 60 frames per second where they are splines.
    double rate_hz = 0;
    bool metres = false;  // BVH in metres instead of centimetres
    BoneNames names = BoneNames::kVrm;
};

// Writes all clips, whole or not at all. BVH holds one clip: several become NAME_CLIP.bvh. A file
// without joints whose targets are a humanoid's plays on the mannequin of 1.75 m. Gives the paths;
// `notes` gets what the format could not hold.
// Fails   "cannot-write", "disk-full"; "no-skeleton": the format needs joints, and the file has
//         none; "not-writable": VRM animations are only read; "too-large": more than ten million
//         frames times joints.
Checked<std::vector<std::string>> write_clips(const std::string& path, const ClipFile& file,
                                              const ClipWriteOptions& options, Diagnostics& notes);

}  // namespace puppetri::io
