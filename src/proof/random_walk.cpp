// SPDX-License-Identifier: MIT
// Random walks, each step uniform among the enabled transitions.
#include "puppetri/proof/random_walk.h"

#include <algorithm>

#include "puppetri/base/hash.h"

namespace puppetri::proof {

namespace {

bool has_enabled_that_counts(const PlainNet& net, std::span<const std::uint32_t> enabled) {
    return std::any_of(enabled.begin(), enabled.end(), [&](std::uint32_t t) {
        return net.optional.empty() || net.optional[t] == 0;
    });
}

}  // namespace

WalkOutcome walk_at_random(const PlainNet& net, const WalkOptions& options, const Budget& budget) {
    WalkOutcome outcome;
    outcome.met.assign(options.goals.size(), 0);
    outcome.greatest.assign(options.sums.size(), std::int64_t{-1} << 62);
    std::vector<CompiledPredicate> goals;
    for (const Predicate& goal : options.goals) {
        goals.emplace_back(net, goal);
    }
    std::vector<std::uint32_t> open(goals.size()), enabled;
    for (std::uint32_t i = 0; i < open.size(); ++i) {
        open[i] = i;
    }
    Meter meter(budget, "random walk");
    Marking marking = net.initial;
    std::uint64_t length = 0;
    for (;;) {
        open.erase(std::remove_if(open.begin(), open.end(),
                                  [&](std::uint32_t i) {
                                      outcome.met[i] = goals[i].holds(marking) ? 1 : 0;
                                      return outcome.met[i] != 0;
                                  }),
                   open.end());
        for (std::size_t i = 0; i < options.sums.size(); ++i) {
            std::int64_t value = 0;
            for (const LinearSum::Term& term : options.sums[i].terms) {
                value += term.factor * std::int64_t{marking[term.place]};
            }
            outcome.greatest[i] = std::max(outcome.greatest[i], value);
        }
        enabled.clear();
        for (std::uint32_t t = 0; t < net.transition_count(); ++t) {
            if (net.enabled(marking, t)) {
                enabled.push_back(t);
            }
        }
        outcome.met_dead = outcome.met_dead || !has_enabled_that_counts(net, enabled);
        if (net.has_levels || outcome.steps >= options.steps ||
            (options.stop_when_found && options.sums.empty() && open.empty() &&
             (!options.find_dead || outcome.met_dead)) ||
            ((outcome.steps & 0xFF) == 0 &&
             meter.look(outcome.steps, outcome.steps, 0, 0) != Ended::kDone)) {
            return outcome;
        }
        ++outcome.steps;
        const std::uint64_t draw = mix64(mix64(options.seed) ^ outcome.steps);
        if (enabled.empty() || ++length > options.walk_length ||
            !net.fire(marking, enabled[static_cast<std::size_t>(draw % enabled.size())])) {
            marking = net.initial;
            length = 0;
        }
    }
}

}  // namespace puppetri::proof
