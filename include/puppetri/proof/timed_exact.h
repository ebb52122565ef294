// SPDX-License-Identifier: MIT
// All behaviours with exact time: net::Engine itself under every answer to every choice. A state is
// what decides the future (net/state.h, canonical), its times counted from now. Exact where all
// durations are single numbers; of intervals and distributions only some points are tried, so the
// graph misses runs, but whatever it has is a run.
#pragma once
#include "puppetri/proof/timed_graph.h"

namespace puppetri::proof {

// Gives  a graph that is `exact`; `over` unless something lasts an interval or a distribution, or
//        events come from outside at any time: these occur only at instants in which something
//        else has happened.
// Cost   some microseconds per edge.
TimedGraph timed_exact_graph(const GraphRequest& request);

// The shortest and the longest time from the initial state until a state of the set is entered
// first, and whether it can be avoided for ever. From the ticks on the edges of an exact timed
// graph. Needs  graph.low_ticks; `wanted` has one entry per state.
struct TimeToReach {
    bool reachable = false;
    bool avoidable = false;  // some run never gets there (it ends before, or goes round for ever)
    std::int64_t shortest = 0;
    std::int64_t longest = 0;                                // never: without bound (avoidable)
    std::vector<std::uint32_t> shortest_path, longest_path;  // edges
};
TimeToReach time_to_reach(const Graph& graph, const std::vector<bool>& wanted);

// The least and the greatest mean time per visit of the states of the set, over all cycles through
// one: how long a round takes. Nothing if no cycle goes through one.
// Source  R. M. Karp, A characterization of the minimum cycle mean in a digraph (1978), for the
//         cycle ratio by binary search with Bellman-Ford (Lawler 1976).
struct CycleTime {
    double least = 0, greatest = 0;  // ticks per visit
};
std::optional<CycleTime> cycle_time(const Graph& graph, const std::vector<bool>& visits);

}  // namespace puppetri::proof
