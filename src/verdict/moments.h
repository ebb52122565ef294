// SPDX-License-Identifier: MIT
// What temporal formulas are read on: the states of a graph, each together with what has just
// happened, as far as the formula asks. "T fires" is true in the state that a firing of T leads to,
// and no longer when anything else happens or time passes; so it is true at one moment of a run per
// firing, also where a run ends: there one more step follows, in which nothing has happened.
#pragma once
#include <cstdint>
#include <vector>

#include "puppetri/proof/timed_graph.h"
#include "puppetri/verdict/check_graph.h"

namespace puppetri::verdict {

struct Moments {
    static constexpr std::uint32_t kStands = ~std::uint32_t{0};

    // Atom i is atom i of the formula. `over`, `exact` and `ended` as in the graph of the states.
    proof::Graph graph;
    proof::Waits waits;                 // the same of states and edges as there
    std::vector<std::uint32_t> state;   // of the other graph
    std::vector<std::uint32_t> origin;  // per edge, that of the other graph; kStands: time goes on
};

// stands_for_ever: also where nothing has just happened, a path that may end goes on, to the same
// state: all paths are infinite.
// Needs  obligation.temporal.
// Cost   the graph once for each firing and occurrence that the formula asks for, at most.
Moments moments_of(const proof::TimedGraph& timed, const Obligation& obligation,
                   bool stands_for_ever);

}  // namespace puppetri::verdict
