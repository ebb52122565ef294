// SPDX-License-Identifier: MIT
// From a pose back to controls: the handles that a humanoid's joints amount to, so that whatever
// moves next starts from where pelvis, chest, feet and hands are, whoever put them there. The
// inverse of solve_controls.h up to a residual: controls know neither how a bend is spread over the
// joints of the trunk, nor collar bones or single fingers.
#pragma once
#include <vector>

#include "puppetri/figure/mannequin.h"
#include "puppetri/motion/controls.h"

namespace puppetri::motion {

// Writes the controls of `limbs` that come nearest to the pose; the others, the breath, and the
// hand's point in the world are left as they are (a hand that is written hangs from the chest).
// Needs   a pose of this figure.
// Gives   controls whose solution has hips, ankles, feet, toes and hands exactly where the pose has
//         them, as long as no limb is stretched beyond 99.8 % and no joint is outside its limits;
//         the chest turned exactly, knees and elbows in the plane that the pose has. Of controls
//         that can be reached the solution gives back those controls. Fingers become the nearest
//         weights of the hand poses.
// Cost    about a microsecond, no allocation.
void controls_from_pose(const figure::Figure& figure, const figure::Pose& pose, LimbSet limbs,
                        Controls& out);

// The joints that a limb of a humanoid poses, from the trunk outwards: pelvis the hips; body spine
// to head; legs hip to toes; arms collar bone to finger tips. Of a creature all joints belong to
// its body.
std::vector<figure::JointIndex> joints_of(const figure::Figure& figure, Limb limb);

}  // namespace puppetri::motion
