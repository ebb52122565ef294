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
#include "puppetri/motion/clip.h"

namespace puppetri::figure {
struct Character;
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

struct ClipRequest {
    std::string path;  // resolved
    double scale = 0;  // a length of the file times this is metres; 0: the format's own unit
};

// Tracks of joints are those of the normalised humanoid (figure/mannequin.h), whatever skeleton the
// file has; DOFs as the file names them.
struct LoadedClips {
    std::vector<motion::Clip> clips;
    double hips_height_m =
        0;  // above the soles in the rest pose of the file's figure; 0: no figure
    Diagnostics notes;
};

class Assets {
 public:
    virtual ~Assets() = default;

    // Reads a character: a glTF, GLB or VRM file. Fails with every defect of it; where.file is the
    // path, the element is of the file ("node 7 (Bip01 L Thigh)") or the bone that is missing
    // ("left_knee").
    virtual Checked<LoadedCharacter> character(const CharacterRequest& request) = 0;

    // All clips of a file (glTF, GLB, VRMA, BVH, keyframes), by the names that it gives them.
    virtual Checked<LoadedClips> clips(const ClipRequest& request) = 0;
};

}  // namespace puppetri::scene
