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
#include "puppetri/figure/skeleton.h"
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

// The clips of a file, in the two forms in which figures perform them.
struct LoadedClips {
    // For humanoids: tracks of joints are those of the normalised humanoid (figure/mannequin.h),
    // whatever skeleton the file has; DOFs as the file names them. Empty where the skeleton is no
    // humanoid's: no_humanoid says why.
    std::vector<motion::Clip> humanoid;
    double hips_height_m = 0;  // of the file's figure at rest, above the soles; 0: no figure
    Diagnostics no_humanoid;
    // For creatures: as the file has them, with its skeleton; that is empty where the file has
    // none and its tracks go by the names of whatever figure plays them.
    std::vector<motion::Clip> raw;
    figure::Skeleton skeleton;
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
