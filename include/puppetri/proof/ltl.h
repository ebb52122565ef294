// SPDX-License-Identifier: MIT
// Linear time over graphs: does every maximal path from the initial state satisfy a formula? A path
// that ends stands in its last state for ever (so `next a` in the last state means a).
#pragma once
#include <cstdint>
#include <optional>
#include <span>

#include "puppetri/proof/budget.h"
#include "puppetri/proof/buechi.h"
#include "puppetri/proof/graph.h"
#include "puppetri/proof/graph_algorithms.h"

namespace puppetri::proof {

// Is there a path that the automaton accepts?
struct Emptiness {
    // kTrue: none, for certain. kFalse: there is one, and it is a run. kUnknown: only a path of an
    // over-approximation, or one that may be (atoms that may hold, states that were not expanded),
    // or the budget ended.
    Truth empty = Truth::kUnknown;
    Ended ended = Ended::kDone;
    // Where asked for: of kFalse; of kUnknown what was found, if anything.
    std::optional<Lasso> lasso;
    std::uint64_t states = 0, edges = 0;  // of the product, as far as it was made
};

// Atom i of the automaton is atom atoms[i] of the graph.
// Cost   O(product), made as far as needed: 4 bytes per state of the graph and of the automaton
//        touched, and the depth of the search. The product stops growing at the first accepted
//        component.
// Source J.-M. Couvreur, On-the-fly verification of linear temporal logic (FM 1999).
Emptiness check_emptiness(const Graph& graph, const Buechi& automaton,
                          std::span<const std::uint32_t> atoms, const Budget& budget,
                          bool with_lasso = true);

struct LtlAnswer {
    Truth holds = Truth::kUnknown;
    Ended ended = Ended::kDone;
    std::optional<Lasso> counterexample;
    std::uint64_t states = 0, edges = 0;
};
// On all paths from the initial state.
// Needs  logic kLtl or kState.
LtlAnswer check_ltl(const Graph& graph, const Temporal& formula,
                    std::span<const std::uint32_t> atoms, const Budget& budget,
                    bool with_lasso = true);

}  // namespace puppetri::proof
