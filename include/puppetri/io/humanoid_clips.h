// SPDX-License-Identifier: MIT
// Clips of a file for the figures of a scene. Those of a humanoid skeleton become clips of the
// normalised one (figure/mannequin.h), which every humanoid performs: the bones are found by their
// names, the rest pose is brought to the T-pose, and rotations are read against it.
#pragma once
#include <string>

#include "puppetri/io/clip_file.h"
#include "puppetri/scene/assets.h"

namespace puppetri::io {

// A file without a skeleton (keyframes by joint or DOF) is taken as it is; of one whose skeleton is
// no humanoid there is only the raw form, and no_humanoid is what figure/fit_humanoid.h says of it,
// where.file being `path`.
// Gives   keys at the times of the file's own, between them Catmull-Rom; the travel as the track of
//         the joint hips, in metres, over the floor that its feet come down to. Where the file has
//         no marks, when feet stand is found (motion/walk_cycle.h). A warning "odd-scale" where the
//         figure is taller than 4 m or smaller than 0.3 m.
scene::LoadedClips clips_for_figures(ClipFile file, const std::string& path);

}  // namespace puppetri::io
