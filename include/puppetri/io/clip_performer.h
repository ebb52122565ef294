// SPDX-License-Identifier: MIT
// The humanoid in a file of motion that has a skeleton but no skin: what retargeting needs of a
// capture.
#pragma once
#include "puppetri/base/diagnostic.h"
#include "puppetri/figure/character.h"
#include "puppetri/io/clip_file.h"

namespace puppetri::io {

// A figure without a mesh on which the file's clips play: the file's joints with their names, below
// a `root` that stands them upright, facing +Z. Its humanoid has the proportions of the joints; the
// rest pose is the file's (BVH: all channels zero), brought to the T-pose.
// Fails   "no-skeleton"; what figure::fit_humanoid says, with the bones by name.
Checked<figure::Character> performer_of(const ClipFile& file, const std::string& path);

}  // namespace puppetri::io
