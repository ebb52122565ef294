// SPDX-License-Identifier: MIT
// A net while it is reduced: per transition one list of arcs, in which what a transition needs,
// what it changes and what inhibits it stand side by side. A place that is taken and given back is
// a need without a change, so equal behaviour looks equal.
#pragma once
#include <cstdint>
#include <vector>

#include "puppetri/proof/reductions.h"

namespace puppetri::proof {

struct ReductionArc {
    static constexpr std::uint32_t kNoLimit = ~std::uint32_t{0};
    std::uint32_t place = 0;
    std::uint32_t need = 0;          // at least so many tokens
    std::int64_t change = 0;         // need + change >= 0
    std::uint32_t limit = kNoLimit;  // fewer tokens than this
    bool tests() const { return need > 0 || limit != kNoLimit; }
    bool empty() const { return !tests() && change == 0; }
    bool operator==(const ReductionArc&) const = default;
};

struct ReductionTransition {
    std::vector<ReductionArc> arcs;  // in order of places, none empty
    std::vector<std::uint32_t> sequence;
    bool optional = false;
    bool alive = true;
};

class ReductionNet {
 public:
    // The budget outlives it.
    ReductionNet(const PlainNet& net, const ReductionGoal& goal, const Budget& budget);

    std::vector<ReductionTransition> transitions;
    std::vector<std::uint32_t> initial;
    std::vector<std::uint8_t> place_alive, keep;
    Preserves preserves = Preserves::kReachability;
    std::vector<std::uint32_t> prefix;
    std::vector<std::vector<std::uint32_t>> rest;  // the latest last
    std::uint32_t applied = 0;

    bool out_of_budget() { return meter_.look(applied, 0, 0, 0) != Ended::kDone; }
    bool has_limits() const { return has_limits_; }

    std::uint32_t place_count() const { return static_cast<std::uint32_t>(initial.size()); }
    // Living transitions with an arc at the place, ascending.
    const std::vector<std::uint32_t>& at(std::uint32_t place);
    const ReductionArc& arc(std::uint32_t transition, std::uint32_t place) const;
    void add(ReductionTransition t);
    void remove_transition(std::uint32_t t);
    // With all its arcs.
    void remove_place(std::uint32_t p);
    // Leaves the change, takes the tests away where they always hold.
    void drop_need(std::uint32_t t, std::uint32_t p);
    void drop_limit(std::uint32_t t, std::uint32_t p);
    bool visible(const ReductionTransition& t) const;
    Reduction finish(const PlainNet& original) const;

 private:
    ReductionArc* find(std::uint32_t transition, std::uint32_t place);
    void drop_if_empty(std::uint32_t t, std::uint32_t p);
    std::vector<std::vector<std::uint32_t>> at_;
    std::vector<std::uint8_t> stale_;  // per place: `at_` may hold transitions that left it
    bool has_limits_ = false;
    Meter meter_;
};

// The rules; each applies itself wherever it can and says whether it did anything.
bool remove_never_enabled(ReductionNet& net);
bool remove_untested_places(ReductionNet& net);
bool simplify_monotone_places(ReductionNet& net);
bool remove_implied_places(ReductionNet& net);
bool remove_dominated_transitions(ReductionNet& net);
bool remove_eaters(ReductionNet& net);
bool remove_beside_always_enabled(ReductionNet& net);
bool agglomerate_after(ReductionNet& net);
bool agglomerate_before(ReductionNet& net);

}  // namespace puppetri::proof
