// SPDX-License-Identifier: MIT
// Looking with several joints: from the first to the last each takes its share of the turn that is
// left; then again, since the eye has moved and limits may have refused a part.
#include "chain_state.h"
#include "puppetri/base/elementary.h"

namespace puppetri::motion {

LookAtOutcome look_at(const ChainView& chain, const LookAt& goal, figure::Pose& pose) {
    PUP_REQUIRE(goal.shares.size() == chain.joints.size());
    ChainState state(chain, pose);
    const int last = state.count() - 1;
    const auto error = [&](Vec3& ahead, Vec3& wanted) {
        const Transform& head = state.model_from_joint(last);
        ahead = rotate(head.rotation, goal.ahead_joint);
        const Vec3 way = goal.target_model - head * goal.eye_joint;
        wanted = length(way) > 1e-9 ? normalized(way) : ahead;
        return puppetri::atan2(length(cross(ahead, wanted)), dot(ahead, wanted));
    };
    Vec3 ahead, wanted;
    LookAtOutcome outcome;
    constexpr int kRounds = 24;
    constexpr double kEnough_rad = 1e-7;
    const double at_first = error(ahead, wanted);
    outcome.residual_rad = at_first;
    // The part of the way that shall be left.
    const double aim_rad = (1 - goal.weight) * at_first;
    for (int round = 0; round < kRounds; ++round) {
        const double before = outcome.residual_rad;
        for (int i = 0; i <= last; ++i) {
            const double left = error(ahead, wanted);
            const double share = i == last ? 1 : goal.shares[i];
            if (left <= aim_rad + kEnough_rad || share == 0) {
                continue;
            }
            // The turn is about the axis across both directions; to look straight back, about the
            // vertical.
            const Quat arc = shortest_arc(ahead, wanted, {0, 1, 0});
            const Quat old = state.rotation(i);
            state.turn(i, slerp({}, arc, share * (left - aim_rad) / left));
            if (error(ahead, wanted) > left) {
                state.set_rotation(i, old);
            }
        }
        outcome.residual_rad = error(ahead, wanted);
        if (outcome.residual_rad <= aim_rad + kEnough_rad || before - outcome.residual_rad < 1e-9) {
            break;
        }
    }
    return outcome;
}

}  // namespace puppetri::motion
