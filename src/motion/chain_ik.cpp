// SPDX-License-Identifier: MIT
// Cyclic coordinate descent for chains.
#include "puppetri/motion/chain_ik.h"

#include "chain_state.h"

namespace puppetri::motion {

ChainOutcome solve_chain(const ChainView& chain, const ChainGoal& goal, figure::Pose& pose) {
    PUP_REQUIRE(goal.share > 0 && goal.share <= 1);
    ChainState state(chain, pose);
    const auto tip = [&] { return state.model_from_joint(state.count() - 1) * goal.tip_joint; };
    ChainOutcome outcome;
    outcome.residual_m = length(tip() - goal.target_model);
    while (outcome.residual_m > goal.tolerance_m && outcome.rounds < goal.rounds) {
        const double before = outcome.residual_m;
        for (int i = state.count() - 1; i >= 0; --i) {
            const Vec3 at = state.model_from_joint(i).translation, to_tip = tip() - at,
                       to_target = goal.target_model - at;
            if (length(to_tip) < 1e-9 || length(to_target) < 1e-9) {
                continue;  // it cannot move the tip, or knows no direction
            }
            const Quat arc = shortest_arc(normalized(to_tip), normalized(to_target), {0, 0, 1});
            const Quat old = state.rotation(i);
            state.turn(i, goal.share < 1 ? slerp({}, arc, goal.share) : arc);
            const double now = length(tip() - goal.target_model);
            if (now <= outcome.residual_m) {
                outcome.residual_m = now;
            } else {
                state.set_rotation(i, old);  // its limit turned it elsewhere
            }
        }
        ++outcome.rounds;
        // A straight chain that points at its target, or away, can be stuck; so can one at its
        // limits.
        if (before - outcome.residual_m < 1e-12 + 1e-9 * before) {
            break;
        }
    }
    return outcome;
}

}  // namespace puppetri::motion
