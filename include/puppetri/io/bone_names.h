// SPDX-License-Identifier: MIT
// What other programs call the joints of a humanoid. Inside, joints have the names of VRM 1.0
// (docs/conventions.md).
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace puppetri::io {

enum class BoneNames : std::uint8_t { kVrm, kMixamo, kUnreal, kRigify };

// "vrm", "mixamo", "unreal", "rigify".
std::optional<BoneNames> parse_bone_names(std::string_view text);

// The joint's name in another program's set; a joint that the set does not know keeps its own name.
// Mixamo's "mixamorig:Hips" is written mixamorigHips, as three.js reads it, which strips colons.
// Source  VRM 1.0 humanoid bones; Mixamo's auto-rigger; Unreal Engine's mannequin; Rigify's human
// metarig.
std::string bone_name(BoneNames names, std::string_view vrm_name);

// All bones that the sets have names for, in VRM's names.
std::vector<std::string> humanoid_bones();

}  // namespace puppetri::io
