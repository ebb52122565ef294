// SPDX-License-Identifier: MIT
// Rules as small automata that watch moments: a state, the firing that led to it, the state before.
// The same automaton watches the paths of a graph, where it branches as far as the atoms are not
// known, and concrete runs, where nothing is unknown.
#pragma once
#include <cstdint>
#include <vector>

#include "puppetri/verdict/obligation.h"

namespace puppetri::verdict {

struct Moment {
    AtomRow before, now;  // before: of the start, the same as now
    std::uint32_t label = Operand::kNoFiring;
    bool settled = false;  // time passes here
    bool start = false;
};

class Monitor {
 public:
    static constexpr std::uint32_t kBad = ~std::uint32_t{0};  // the rule is broken

    // The obligation outlives the monitor. Needs watches(kind).
    explicit Monitor(const Obligation& obligation);
    // Whether moments alone decide the rule: those of death, freezing, liveness and logics are
    // decided on graphs as a whole.
    static bool watches(net::RuleKind kind);

    std::uint32_t start() const { return 0; }
    // All states that it may be in after this moment, kBad among them if it may be broken now.
    void step(std::uint32_t state, const Moment& moment, std::vector<std::uint32_t>& out) const;
    // Something is owed: the rule is broken by a run that stays so for ever (leads to, ends), or
    // for longer than `within` (takes at most: while it holds).
    bool owes(std::uint32_t state) const;
    // The state says nothing but whether something is owed or armed: the monitor has one state.
    bool stateless() const { return stateless_; }
    // It looks only where time passes.
    bool when_settled() const;

 private:
    bool may_be_broken(const Moment& moment) const;

    const Obligation& o_;
    bool stateless_ = false;
};

}  // namespace puppetri::verdict
