// SPDX-License-Identifier: MIT
// A graph of states watched by a monitor: every path of the graph with every state that the monitor
// can be in. What is asked of it: is something broken reachable, can something be owed for ever,
// for how long at most, from where is something out of reach.
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "puppetri/proof/graph.h"
#include "puppetri/proof/timed_graph.h"
#include "puppetri/verdict/monitor.h"

namespace puppetri::verdict {

struct Product {
    const proof::Graph* graph = nullptr;
    std::vector<std::uint32_t> state, monitor;  // per node; monitor == Monitor::kBad: broken here
    std::vector<std::uint32_t> first;           // the nodes of the start
    std::vector<std::uint64_t> starts;          // of the edges of each node, and one more
    std::vector<std::uint32_t> targets;
    std::vector<std::uint32_t> edge;  // the number of the graph's edge
    std::vector<std::uint8_t> stop;   // per state of the graph, empty: none
    bool complete = true;             // false: the graph was cut, or the budget ended

    std::uint32_t size() const { return static_cast<std::uint32_t>(state.size()); }
    std::uint32_t label(std::uint64_t e) const { return graph->edges.items[edge[e]].label; }
    bool broken(std::uint32_t node) const { return monitor[node] == Monitor::kBad; }
    AtomRow row(std::uint32_t node) const { return row_of(*graph, state[node]); }
    static AtomRow row_of(const proof::Graph& graph, std::uint32_t state);
    // Nothing has to happen here any more: dead, or all that could is optional, or the run stops.
    bool rests(std::uint32_t node) const {
        const std::uint32_t s = state[node];
        return stops(node) ||
               (!cut(node) && (graph->dead(s) || (graph->flags[s] & proof::Graph::kOptional) != 0));
    }
    // The run may stop here with a fault.
    bool stops(std::uint32_t node) const { return !stop.empty() && stop[state[node]] != 0; }
    bool final_marking(std::uint32_t node) const {
        return (graph->flags[state[node]] & proof::Graph::kFinal) != 0;
    }
    // What follows is not known.
    bool cut(std::uint32_t node) const {
        return (graph->flags[state[node]] & proof::Graph::kCut) != 0 && !stops(node);
    }
};

// Without a monitor: the graph itself. Broken nodes have no edges.
// paced: a beat passes after each firing, also after one that leads back to the start.
// Cost    one step of the monitor per edge.
Product make_product(const proof::Graph& graph, const Monitor* monitor, std::uint64_t most_edges,
                     const std::vector<proof::Stop>& stops = {}, bool paced = false);

using Nodes = std::vector<std::uint8_t>;  // per node: in the set or not

// Nodes of cycles that stay in `open`, without edges in `left_out` (per product edge; may be
// empty). Cycles on which something of one kind waits for ever, though its time is finite, or on
// which events come without end in one instant, are none (`waits` may be null: then nothing is
// known of that).
// Gives  one strongly connected component, or nothing.
std::optional<std::vector<std::uint32_t>> endless(const Product& product, const Nodes& open,
                                                  const std::vector<std::uint8_t>& left_out,
                                                  const proof::Waits* waits);

// How long a wait of each kind lasts at most, in ticks; kNoLimit: nobody knows.
inline constexpr std::int64_t kNoLimit = SimTime::never().ticks;

// How many ticks at most a path stays in `open` from a node of `from` on; nothing: no bound is
// known (it may stay for ever). By the ticks of the edges where the graph has them and `by_ticks`,
// else by what waits: while something of a kind waits, no more time passes than that kind takes.
// Cost   what waits: O(nodes * edges) for each kind in the worst case, ended where it grows.
std::optional<std::int64_t> longest_stay(const Product& product, const Nodes& open,
                                         const std::vector<std::uint32_t>& from, bool by_ticks,
                                         const proof::Waits* waits,
                                         const std::vector<std::int64_t>& at_most);

// The number of edges from each node to the nearest node of the set, or kFar.
inline constexpr std::uint32_t kFar = ~std::uint32_t{0};
std::vector<std::uint32_t> distances(const Product& product, const Nodes& targets,
                                     const std::vector<std::uint8_t>& left_out = {});
// The same to edges of a set; left_out and such are per product edge.
std::vector<std::uint32_t> distances_to_edges(const Product& product,
                                              const std::vector<std::uint8_t>& edges,
                                              const Nodes& targets,
                                              const std::vector<std::uint8_t>& left_out = {});

}  // namespace puppetri::verdict
