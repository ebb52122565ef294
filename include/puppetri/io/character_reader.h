// SPDX-License-Identifier: MIT
// Characters out of glTF files: one skeleton out of all skins and the nodes between their joints,
// one textured mesh out of all meshes that hang on it, and for humanoids the rig.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "puppetri/base/diagnostic.h"
#include "puppetri/figure/character.h"
#include "puppetri/figure/fit_humanoid.h"
#include "puppetri/io/gltf_document.h"
#include "puppetri/scene/assets.h"

namespace puppetri::io {

// Gives   the character in metres, +Y up, facing +Z, soles on the floor. Its skeleton has a root on
//         the floor, then the joints of all skins and the nodes between them (of a file without
//         skins: all nodes), with the names of the nodes; a name that comes twice gets a number.
//         The rest pose is the one in which the skins were bound (of a file without: that of the
//         nodes). Humanoid bones are those that the request names, then those that a VRM file
//         names, then what find_bones finds.
// Fails   "no-figure" without nodes or meshes, "bad-skin" where a bind matrix has no inverse,
//         "unknown-joint" for a name of the request that the file has not, what fit_humanoid says,
//         "height-out-of-range" for a height that is not between 1 cm and 100 m. where.file is
//         request.path. Warnings (the document's notes) are appended to `notes`.
// Cost    linear in vertices and joints.
Checked<figure::Character> read_character(const GltfDocument& document,
                                          const scene::CharacterRequest& request,
                                          Diagnostics& notes);

// The humanoid bones that the names of joints tell: those of VRM, Mixamo, Unreal, Rigify, CMU, 3ds
// Max (Biped), and of others by the words in them ("arm", "leg", "torso", "neck"; a left and a
// right) and the order in which they hang. Each bone and each joint at most once.
std::vector<figure::FoundBone> find_bones(const figure::Skeleton& skeleton);

}  // namespace puppetri::io
