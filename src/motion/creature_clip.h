// SPDX-License-Identifier: MIT
// Clips on figures that are no humanoids: joint by joint, by their names.
#pragma once
#include <memory>
#include <string>

#include "puppetri/motion/clip.h"
#include "puppetri/motion/posed.h"

namespace puppetri::motion {

struct CreatureClip {
    PosedSpec spec;  // drives nothing where the figure has none of the clip's joints and DOFs
    std::shared_ptr<const PoseSource> source;
};

// The clip for this figure. Joints of the same name take the same turn against their parents; where
// the figure has joints that the clip's skeleton lacks, or the other way round, the turn against
// the nearest joint that both have. The topmost joint stands where the clip has it, heights over
// the floor and shifts of joints scaled by how long the figure's bones are. What the clip travels
// (beyond a twentieth of the figure's size, or five degrees) the figure travels, from where it
// stands; a clip that stays in place does so, but for advances_m_s, which is ahead.
// `skeleton`  of the clip's file; without joints the figure's own is meant.
CreatureClip make_creature_clip(const std::string& name, std::shared_ptr<const Clip> clip,
                                const figure::Skeleton& skeleton, const figure::Figure& figure,
                                double speed, double advances_m_s);

}  // namespace puppetri::motion
