// SPDX-License-Identifier: MIT
// How characters and clips reach a scene: files with figures and motion are read by `io`, which the
// scene does not know. Who hands a FileSource to the scene hands these with it
// (FileSource::assets).
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "puppetri/base/diagnostic.h"

namespace puppetri::figure {
struct Character;
}
namespace puppetri::motion {
struct Clip;
}

namespace puppetri::scene {

// `hips: "Armature_Hips"` in a block `bones`.
struct NamedBone {
    std::string bone;   // "hips", "left_elbow", or a VRM name
    std::string joint;  // as the file calls it
    SourceSpan where;
};

struct CharacterRequest {
    std::string path;                // resolved
    std::optional<double> height_m;  // sole to crown; none: as the file says
    std::vector<NamedBone> bones;    // instead of what the names say
    bool humanoid = true;            // false: nothing is looked for; a creature
};

struct LoadedCharacter {
    std::shared_ptr<const figure::Character> character;  // not null
    Diagnostics notes;                                   // warnings: what the file has and is not
                                                         // shown
};

class Assets {
 public:
    virtual ~Assets() = default;

    // Reads a character: a glTF, GLB or VRM file. Fails with every defect of it; where.file is the
    // path, the element is of the file ("node 7 (Bip01 L Thigh)") or the bone that is missing
    // ("left_knee").
    virtual Checked<LoadedCharacter> character(const CharacterRequest& request) = 0;

    // All clips of a file (glTF, GLB, VRMA, BVH, keyframes), by the names that it gives them.
    virtual Checked<std::shared_ptr<const std::vector<motion::Clip>>> clips(
        const std::string& path) = 0;
};

}  // namespace puppetri::scene
