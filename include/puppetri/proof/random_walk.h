// SPDX-License-Identifier: MIT
// Walking at random through the markings of a plain net: the cheapest way to meet what is met
// easily. What was met is certain; what was not means nothing.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "puppetri/proof/budget.h"
#include "puppetri/proof/plain_net.h"
#include "puppetri/proof/predicate.h"

namespace puppetri::proof {

struct WalkOptions {
    std::span<const Predicate> goals;
    std::span<const LinearSum> sums;   // the largest value met of each
    std::uint64_t steps = 100'000;     // firings, all walks together
    std::uint64_t walk_length = 2000;  // then a new walk begins
    std::uint64_t seed = 1;
    bool stop_when_found = true;  // all goals, and a dead marking if `find_dead`
    bool find_dead = false;
};

struct WalkOutcome {
    std::vector<std::uint8_t> met;       // per goal
    std::vector<std::int64_t> greatest;  // per sum
    bool met_dead = false;               // no transition enabled that is not optional
    std::uint64_t steps = 0;
};

// The same for every run with the same options. Nets with levels are not walked: nothing but the
// initial marking is met.
// Cost   O(arcs + goals) per step.
WalkOutcome walk_at_random(const PlainNet& net, const WalkOptions& options, const Budget& budget);

}  // namespace puppetri::proof
