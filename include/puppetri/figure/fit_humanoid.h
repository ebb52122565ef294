// SPDX-License-Identifier: MIT
// Finding the humanoid in a skeleton: its rest pose is brought to the T-pose, its proportions are
// measured on joints and skin, and out come the normalised Figure that all movements know and the
// rig that carries its poses back.
#pragma once
#include <span>
#include <string>

#include "puppetri/base/diagnostic.h"
#include "puppetri/figure/character.h"

namespace puppetri::figure {

// A joint of the raw skeleton as a bone of VRM 1.0 ("leftUpperArm").
struct FoundBone {
    std::string bone;
    JointIndex joint;
};

// The rotation that stands a figure upright and lets it face +Z, from the places of its hips, of
// something high in the middle (neck, head), and of its left and right side. Near a multiple of a
// quarter turn about an axis it is exactly that: files are turned by axes, while figures lean.
// Identity where the points do not tell.
Quat upright(Vec3 hips, Vec3 top, Vec3 left, Vec3 right);

// Spaces  the raw skeleton faces +Z, +Y up, in metres; joint 0 is its root at the origin; the mesh
//         is bound to its rest pose, its lowest point of the feet about y = 0.
// Needs   bones of the skeleton, each bone and each joint at most once.
// Gives   the humanoid; raw_t_pose of its rig is the rest pose with straight legs, flat feet that
//         point ahead, arms to the sides, elbows that bend forward. Lengths of left and right are
//         their own; heights are the mean of both sides.
// Fails   "no-bone" for each missing bone that a humanoid cannot do without (hips, one of the
//         trunk, head or neck, and of each side upper and lower arm, hand, upper and lower leg,
//         foot), "short-bone" where thigh, shank, upper arm or forearm are shorter than a hundredth
//         of the height, "wrong-order" where a bone does not hang from the one before it. The
//         element is the bone as the language calls it ("left_knee").
Checked<Humanoid> fit_humanoid(const Skeleton& raw, const Mesh& mesh,
                               std::span<const FoundBone> bones);

// What the language calls a bone of VRM 1.0: "left_knee" for leftLowerLeg; others as they are.
std::string language_bone(std::string_view vrm_bone);

}  // namespace puppetri::figure
