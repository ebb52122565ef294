// SPDX-License-Identifier: MIT
// Clips carried from one humanoid to another. Not rotations are copied but what they are for: where
// feet stand and how they roll, how high the hips are over them, where hands are from the
// shoulders, or, while they touch something, in the world. Inverse kinematics does the rest for the
// other proportions.
#pragma once
#include <cstdint>

#include "puppetri/figure/character.h"
#include "puppetri/motion/clip.h"

namespace puppetri::motion {

// Who performs a clip: a skeleton with the humanoid in it.
struct Performer {
    const figure::Skeleton& skeleton;  // raw: the names of the clip's tracks
    const figure::Humanoid& humanoid;
};

struct RetargetOptions {
    double rate_hz = 60;  // of the keys that are made
    // Ways on the floor: 0 scales them by the length of the legs, so that feet do not slide; 1
    // keeps them, for clips that must arrive at a place.
    double travel_scale = 0;
    // Captures have their floor anywhere: it is put where the soles usually are lowest (a tenth of
    // the instants has them lower), where that is more than a centimetre off.
    bool find_floor = true;
    // A hand about which the clip has a mark "contact" (leftHand, rightHand or the source's joint)
    // is where the source's is in the world, travel scaled; over this time before and after it goes
    // there and back.
    double hand_blend_s = 0.15;
};

struct Retargeted {
    // On the target's raw skeleton; or, without a rig, on the normalised humanoid.
    Clip clip;
    double worst_foot_m = 0;  // by which a foot is not where it should be: legs are too short
    double worst_hand_m = 0;  // the same of hands in contact
};

// Gives   the clip for the target: tracks of all joints that a humanoid moves, keys at rate_hz and
// at
//         both ends, linear; marks, loop and name of the source. Planted feet stay planted: their
//         height over the floor is the target's own, their way is scaled as one piece.
// Source  the idea of keeping contacts instead of angles: M. Gleicher, "Retargetting motion to new
//         characters", SIGGRAPH 1998; limbs per frame by inverse kinematics: K.-J. Choi and
//         H.-S. Ko, "Online motion retargetting", J. Visualization and Computer Animation 11
//         (2000).
// Cost    a few microseconds per key and joint.
Retargeted retarget(const Clip& clip, const Performer& source, const Performer& target,
                    const RetargetOptions& options = {});

// The same onto a normalised humanoid (the mannequin): tracks by the names of VRM 1.0.
Retargeted retarget(const Clip& clip, const Performer& source, const figure::Figure& target,
                    const RetargetOptions& options = {});

}  // namespace puppetri::motion
