// SPDX-License-Identifier: MIT
// Rigs that leave something of a humanoid's limbs to controllers. Feet and hands of a rig made for
// inverse kinematics hang from the controller that drives them instead of from the shin or the
// forearm, and a hand whose fingers hang from the forearm has no wrist. Where it is clear what is
// meant, the skeleton is put right here, before the humanoid is found in it (fit_humanoid.h).
#pragma once
#include <span>
#include <vector>

#include "puppetri/base/diagnostic.h"
#include "puppetri/figure/fit_humanoid.h"
#include "puppetri/figure/mesh.h"
#include "puppetri/figure/skeleton.h"

namespace puppetri::figure {

struct CompletedSkeleton {
    Skeleton skeleton;             // every joint where the given one has it at rest
    std::vector<FoundBone> bones;  // of it
    std::vector<JointIndex> from;  // for each of its joints the given one; none: a wrist made here
    Diagnostics notes;             // kNote: what was changed, by bones as the language calls them

    // What a pose of the given skeleton is on this one: each joint where it was, wrists at rest.
    Pose carry(const Skeleton& given, const Pose& pose) const;
    // The mesh, bound to the given skeleton, bound to this one. Where a wrist was made on a forearm
    // that nothing hangs from, the skin beyond the wrist goes with it.
    void rebind(Mesh& mesh) const;

    struct Sleeve {  // skin of the forearm, on the far side of a plane, that goes with a wrist
        JointIndex forearm, wrist;  // given; here
        Vec3 wrist_model, ahead_model;
    };
    std::vector<Sleeve> sleeves;
};

// Spaces  as fit_humanoid.
// Needs   bones of the skeleton, each bone and each joint at most once; mesh: bound to the rest
//         pose, or empty.
// Gives   the given skeleton and bones, changed by these rules alone:
//         - where the legs do not hang from the hips, the lowest joint above all three is the hips
//           (the root is not), and what was called so, without another spine, the spine;
//         - a foot that does not hang from its shin, or a hand that does not hang from its forearm,
//           is hung there, if that leaves a tree and the shin (forearm) gets between two fifths and
//           five halves of the length of the thigh (upper arm): else what was named is no foot;
//         - a missing wrist is made, where most of the joints that hang from the forearm lie (of
//           several such places the farthest); what hangs from the outer fifth of the forearm hangs
//           from the wrist then. Nothing hangs there: at the part of the forearm's skin that a
//           mannequin's forearm has of forearm and hand; without skin at the forearm's end site.
//           The same bound holds.
//         What cannot be put right so stays for fit_humanoid to tell.
// Cost    linear in joints and vertices.
CompletedSkeleton complete_humanoid(const Skeleton& raw, const Mesh& mesh,
                                    std::span<const FoundBone> bones);

}  // namespace puppetri::figure
