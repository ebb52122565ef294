// SPDX-License-Identifier: MIT
// Animations of glTF files as clips, VRM animations among them.
#pragma once
#include "puppetri/base/diagnostic.h"
#include "puppetri/io/clip_file.h"
#include "puppetri/io/gltf_document.h"

namespace puppetri::io {

// All animations of the document. The skeleton has the joints of the skins, what is animated, and
// the nodes between them and above them that are not at the identity, with the names of the nodes
// ("node_7" without one, a number behind a name that comes twice) and their rest pose.
// Gives   a clip per animation, with the keys of the file: step and linear as they are; cubic
//         splines as Hermite segments, with keys in between where a spline of quaternions is more
//         than 1e-4 rad from the curve of rotations. Scale: of nodes it goes into the translations
//         below; an animated one that changes is left out with a warning. The root is the joint
//         nearest to the top whose translation is animated.
//         A VRM animation gives the humanoid: joints named as in VRM 1.0, all rotations at rest the
//         identity, with the file's proportions.
// Fails   "no-animation", "bad-rotation" (by animation, node and key), the codes of motion::check.
Checked<ClipFile> clips_of(const GltfDocument& document, const std::string& path,
                           const ClipReadOptions& options = {});

}  // namespace puppetri::io
