// SPDX-License-Identifier: MIT
// A smaller net that answers the same question. Each rule stands with its preconditions, its reason
// and its source in src/proof/reduction_rules.cpp; a sequence of the reduced net is told as a
// sequence of the original one.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "puppetri/proof/budget.h"
#include "puppetri/proof/plain_net.h"

namespace puppetri::proof {

// What must stay true. Never for next, CTL, liveness; never where levels block (a net with levels
// comes back as it is).
enum class Preserves : std::uint8_t {
    kDeadlock,      // "a dead marking is reachable" (optional transitions as PlainNet says)
    kReachability,  // the set of reachable markings, seen through the kept places
    kStutter,       // the runs, seen through the kept places, up to repetition: LTL without next.
                    // Maximal finite runs stay (their last marking repeats for ever)
};

struct ReductionGoal {
    Preserves preserves = Preserves::kReachability;
    // Per place: its tokens are read by the question; empty: none. A question about the enabledness
    // of a transition keeps all places that it tests (keep_presets).
    std::vector<std::uint8_t> keep;
};
void keep_presets(const PlainNet& net, std::span<const std::uint32_t> transitions,
                  ReductionGoal& goal);

struct Reduction {
    static constexpr std::uint32_t kGone = ~std::uint32_t{0};
    PlainNet net;
    std::vector<std::uint32_t> place_of;  // reduced place -> original place
    std::vector<std::uint32_t> now;       // original place -> reduced place, or kGone; kept: never
    net::Rows<std::uint32_t> sequences;   // reduced transition -> original transitions in order
    // What has to be fired first: it leads to the reduced initial marking.
    std::vector<std::uint32_t> prefix;
    // kDeadlock, kStutter: what may still fire, unseen, where the reduced net is dead; to be fired
    // in this order, each as often as it goes.
    std::vector<std::vector<std::uint32_t>> rest;
    std::uint32_t rules_applied = 0;

    // A firing sequence of the reduced net as one of the original net, from its initial marking.
    // A dead end of the reduced net becomes a dead end (`dead`: fires the rest too).
    std::vector<std::uint32_t> original(const PlainNet& whole,
                                        std::span<const std::uint32_t> reduced, bool dead) const;
};

// Applies all rules that preserve the goal until none applies or the budget ends (what is reduced
// by then is right).
Reduction reduce(const PlainNet& net, const ReductionGoal& goal, const Budget& budget);

}  // namespace puppetri::proof
