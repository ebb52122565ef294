// SPDX-License-Identifier: MIT
// Branching time over graphs: which states satisfy a formula, by labelling, linear in graph times
// formula. Paths are maximal: they are infinite or end where paths may end (a dead state, or one
// whose edges are all optional). In a dead state EX is false, AX true, EG a holds if a does.
//
// Three-valued: `must` are states where the formula holds for certain, `may` those where it is not
// excluded. On exact graphs without cuts both are one set. On over-approximations no path is known
// to be a run, so E-formulas are certain only where the A-formula is (every state has some run),
// and A-formulas are never excluded but by what holds at once: PROVED and REFUTED stay sound for
// every mixture of quantifiers.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "puppetri/proof/budget.h"
#include "puppetri/proof/graph.h"
#include "puppetri/proof/graph_algorithms.h"
#include "puppetri/proof/temporal.h"
#include "puppetri/proof/timed_graph.h"

namespace puppetri::proof {

// A checker for many formulas over one graph: who leads where is computed once, when needed.
// Source  E. M. Clarke, E. A. Emerson, A. P. Sistla, Automatic verification of finite-state
//         concurrent systems using temporal logic (1986); three values: G. Bruns, P. Godefroid,
//         Model checking partial state spaces (CAV 1999).
class CtlChecker {
 public:
    // The graph must live longer.
    // waits: paths that wait for ever for what is over after a finite time, or on which events come
    // without end in one instant, are none (null: nothing is known of that).
    explicit CtlChecker(const Graph& graph, const Waits* waits = nullptr);
    // With the predecessors of the graph, made by somebody else for several checkers.
    CtlChecker(const Graph& graph, const net::Rows<std::uint32_t>& backwards)
        : graph_(graph), given_(&backwards) {}

    struct Labels {
        StateBits must, may;
    };
    // The states of the graph, by the value of the formula.
    // Needs  logic kState or kCtl. Atom i of the formula is atom atoms[i] of the graph.
    // Gives  nothing when the budget ends (time or cancellation).
    // Cost   O(formula * (states + edges)); 4 bytes per edge for all formulas together, 4 per state
    //        and 1/8 per state and node of the formula (1/4 where must and may differ).
    std::optional<Labels> label(const Temporal& formula, std::span<const std::uint32_t> atoms,
                                const Budget& budget);
    // In the initial state.
    Truth holds(const Temporal& formula, std::span<const std::uint32_t> atoms,
                const Budget& budget);

    // A path that shows the truth of an E-formula, or the falsity of an A-formula, in the initial
    // state; through nested operators as far as one path can go.
    // Gives  nothing where no one path shows it, or the answer is unknown.
    std::optional<Lasso> evidence(const Temporal& formula, std::span<const std::uint32_t> atoms,
                                  const Budget& budget);

 private:
    std::optional<std::vector<Labels>> all_labels(const Temporal& formula,
                                                  std::span<const std::uint32_t> atoms,
                                                  bool keep_all, const Budget& budget);
    const net::Rows<std::uint32_t>& backwards();
    bool cut(std::uint32_t state) const;
    StateBits some_next(const StateBits& a);
    StateBits some_globally(const StateBits& a, bool past_cuts);
    StateBits just_globally(const StateBits& a, const StateBits& cuts);

    const Graph& graph_;
    const Waits* waits_ = nullptr;
    const net::Rows<std::uint32_t>* given_ = nullptr;
    net::Rows<std::uint32_t> predecessors_;  // empty until needed, or given
};

}  // namespace puppetri::proof
