// SPDX-License-Identifier: MIT
// All behaviours with exact time: net::Engine itself under every answer to every choice. A state is
// what decides the future (net/state.h, canonical), its times counted from now. Exact where all
// durations are single numbers; of intervals and distributions only some points are tried, so the
// graph misses runs, but whatever it has is a run.
#pragma once
#include <cstdint>
#include <optional>

#include "puppetri/proof/graph_algorithms.h"
#include "puppetri/proof/timed_graph.h"

namespace puppetri::proof {

// Gives  a graph that is `exact`; `over` unless something lasts an interval or a distribution, or
//        events come from outside at any time: these occur only at instants in which something
//        else has happened.
// Cost   some microseconds per edge.
TimedGraph timed_exact_graph(const GraphRequest& request);

// The shortest and the longest time from the initial state until a state of the set is entered
// first, and whether it can be avoided for ever. From the ticks on the edges of an exact timed
// graph.
// Needs  ticks on the edges; all states expanded. Of a path that stops (graph.stops) it is said
//        that it avoids the set.
// Cost   O(edges log edges).
struct TimeToReach {
    bool reachable = false;
    bool avoidable = false;  // some run never gets there (it ends before, or goes round for ever)
    std::int64_t shortest = 0;
    std::int64_t longest = 0;  // never: without bound (avoidable)
    Path shortest_path, longest_path;
};
TimeToReach time_to_reach(const Graph& graph, const StateBits& wanted);

// So many ticks for so many visits, on the whole way round.
struct Round {
    std::int64_t ticks = 0;
    std::int64_t visits = 0;
    Path cycle;
};

// The least and the greatest mean time per visit, over all that goes round for ever and visits
// again and again: how long a round takes. The least counts the low ends of the edges' ticks, the
// greatest the high ends: where they differ these are bounds of what runs do.
// Needs   ticks on the edges; visits: 1 for the edges (in the order of edges.items) that are
//         visits.
// Gives   nothing if no cycle has a visit; no greatest if the visits may become ever rarer.
// Cost    O(states * edges) per improvement, few of them.
// Source  W. Dinkelbach, On nonlinear fractional programming (1967), for the ratio of cycles;
//         exact in whole numbers.
struct CycleTime {
    Round least;
    std::optional<Round> greatest;
};
std::optional<CycleTime> cycle_time(const Graph& graph, const std::vector<std::uint8_t>& visits);

}  // namespace puppetri::proof
