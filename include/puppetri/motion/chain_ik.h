// SPDX-License-Identifier: MIT
// Chains of any number of joints: spines, tails, necks, tentacles, robot arms. A chain lists joints
// of a skeleton from its root to its tip, each the parent or an ancestor of the next; limits are
// the figure's, one per joint of the skeleton.
#pragma once
#include <span>

#include "puppetri/figure/limits.h"

namespace puppetri::motion {

inline constexpr int kMaxChainJoints = 64;

struct ChainView {
    const figure::Skeleton& skeleton;
    std::span<const figure::JointLimit> limits;  // one per joint of the skeleton, or empty
    std::span<const figure::JointIndex> joints;  // 1 to kMaxChainJoints
};

struct ChainGoal {
    Vec3 target_model;
    Vec3 tip_joint;  // what goes there, in the space of the last joint
    double tolerance_m = 1e-4;
    int rounds = 64;
    // How much of the turn that it could make each joint makes per round, in (0, 1]: less spreads
    // the bend more evenly and takes more rounds.
    double share = 1;
};
struct ChainOutcome {
    double residual_m = 0;
    int rounds = 0;
};

// Brings the tip to the target; joints start from the pose, so that small changes of the target
// make small changes of the pose. Gives   joints within their limits; a target that is out of reach
// is approached. Cost    joints times rounds times about 0.1 us; no allocation. Source  cyclic
// coordinate descent (Wang and Chen, IEEE Trans. Robotics and Automation 7 (1991)
//         489-499), each joint turned by the shortest arc and then into its limit. Changed: the
//         joint keeps the turn only if it brings the tip nearer.
ChainOutcome solve_chain(const ChainView& chain, const ChainGoal& goal, figure::Pose& pose);

struct LookAt {
    Vec3 target_model;
    Vec3 eye_joint;             // in the space of the last joint
    Vec3 ahead_joint{0, 0, 1};  // where it looks, unit, in that space
    // What part of the turn that is left each joint takes, from the first on; the last takes all.
    // One per joint, in [0, 1].
    std::span<const double> shares;
    double weight = 1;  // in [0, 1]: how far towards the target
};
struct LookAtOutcome {
    double residual_rad = 0;  // between where it looks and the target
};

// Turns the chain (spine, neck, head, an eye) so that its last joint looks at the target. What one
// joint's limit refuses, the others take over.
// Gives   joints within their limits. A target on the eye leaves the pose as it is.
// Cost    a few microseconds; no allocation.
LookAtOutcome look_at(const ChainView& chain, const LookAt& goal, figure::Pose& pose);

}  // namespace puppetri::motion
