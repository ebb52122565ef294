// SPDX-License-Identifier: MIT
// Changing what poses are measured from, and binding a mesh anew.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "puppetri/figure/mesh.h"
#include "puppetri/figure/skeleton.h"

namespace puppetri::io {

// The skeleton with the upper arms 45 degrees lower at rest. Poses keep their meaning: they are
// absolute.
figure::Skeleton with_a_pose(const figure::Skeleton& t_pose);

// The mesh as linear blend skinning carries it from one rest pose to the other. Needs equal joints.
figure::Mesh rebound(const figure::Mesh& mesh, const figure::Skeleton& from,
                     const figure::Skeleton& to);

// model_from_joint of the rest pose, one per joint.
std::vector<Transform> model_from_rest(const figure::Skeleton& skeleton);

// The part of a dotted path after its last dot.
inline std::string_view last_part(std::string_view path) {
    const std::size_t dot = path.rfind('.');
    return dot == std::string_view::npos ? path : path.substr(dot + 1);
}

// Names of nodes and clips: letters, digits, underscore and dash as they are, all else becomes an
// underscore. (three.js strips . : / [ ], and some importers cut at blanks.) Letters beyond ASCII
// stay.
std::string node_name(std::string_view text);

}  // namespace puppetri::io
