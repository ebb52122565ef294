// SPDX-License-Identifier: MIT
// A limb that follows a goal over time: each pose is the one within limits that moves least from
// the last, so that swivel, sign of the hinge and arc of swivels are kept as long as they exist,
// and no reference direction is needed that the limb could run through.
#pragma once
#include "puppetri/motion/limb_ik.h"

namespace puppetri::motion {

struct LimbTrack {
    LimbPose pose;     // the last one
    Vec3 line_parent;  // the direction from the first joint to the target, as it was last used
    bool started = false;
};

struct LimbStep {
    LimbSolution solution;
    double moved_rad = 0;  // the largest turn of a joint since the last pose
};

// Gives   a path of poses as continuous as its goals, also where the limb is straight, the target
//         out of reach, or on the first joint: a target nearer than the hinge allows is replaced by
//         the nearest point of the workspace, whose direction follows the target the later the
//         nearer the target is to the joint (at the joint not at all). Where the arc of swivels
//         that it is on ends for good it must jump, and moved_rad tells.
// Needs   track.pose within limits unless it has not started.
// Cost    as LimbIk::solve.
LimbStep follow(const LimbIk& ik, LimbGoal goal, LimbTrack& track);

}  // namespace puppetri::motion
