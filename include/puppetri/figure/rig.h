// SPDX-License-Identifier: MIT
// A rig carries poses from the normalised humanoid (figure/mannequin.h: T-pose, identity rotations)
// to the skeleton of a character file, whose joints have any axes, any rest pose, more bones or
// fewer, and back. Both have the same proportions (figure/humanoid.h), so that feet and hands that
// inverse kinematics brought to a place in the one are at that place in the other.
#pragma once
#include <cstdint>
#include <string_view>
#include <vector>

#include "puppetri/figure/mannequin.h"
#include "puppetri/figure/skeleton.h"

namespace puppetri::figure {

// One joint of the raw skeleton that follows a bone of the humanoid:
//   model_from_joint = model_from_bone * bone_from_joint,
// of which the translation counts for root and hips alone: bones do not lengthen.
struct RigBone {
    JointIndex joint;           // raw
    JointIndex bone;            // of Figure::skeleton; of several at one place the lowest
    Transform bone_from_joint;  // in the T-pose
};

struct Rig {
    std::vector<RigBone> bones;  // by joint, increasing
    JointIndex raw_root, raw_hips;
    // Raw joints that follow no bone keep these transforms relative to their parents: those of the
    // T-pose. Followers keep the translations.
    std::vector<Transform> raw_t_pose;  // one per raw joint

    // Writes the raw pose. `raw` is resized once, then nothing is allocated.
    void to_raw(const Figure& figure, const Skeleton& skeleton, const Pose& pose, Pose& raw) const;
    // The humanoid pose that to_raw would carry to `raw`; virtual bones are at rest. Gives the
    // nearest where the raw joints do what no humanoid does (lengthen, shift).
    void to_figure(const Figure& figure, const Skeleton& skeleton, const Pose& raw,
                   Pose& pose) const;
};

}  // namespace puppetri::figure
