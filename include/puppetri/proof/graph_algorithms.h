// SPDX-License-Identifier: MIT
// What rules and logics ask of a graph of states: sets of states, who leads here, strongly
// connected components, shortest paths, lassos. Everything is iterative and linear in states and
// edges: no stack grows with the depth of a graph.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "puppetri/proof/graph.h"

namespace puppetri::proof {

// A set of states, a bit each.
class StateBits {
 public:
    StateBits() = default;
    explicit StateBits(std::uint32_t size, bool value = false);
    std::uint32_t size() const { return size_; }
    bool operator[](std::uint32_t s) const { return ((words_[s / 64] >> (s % 64)) & 1) != 0; }
    void add(std::uint32_t s) { words_[s / 64] |= std::uint64_t{1} << (s % 64); }
    void remove(std::uint32_t s) { words_[s / 64] &= ~(std::uint64_t{1} << (s % 64)); }
    // Of equal sizes.
    StateBits& operator&=(const StateBits& other);
    StateBits& operator|=(const StateBits& other);
    void complement();
    std::uint32_t count() const;
    bool empty() const;
    // Calls visit(state) for each member, ascending.
    template <class Visit>
    void for_each(Visit&& visit) const {
        for (std::uint32_t i = 0; i < words_.size(); ++i) {
            for (std::uint64_t word = words_[i]; word != 0; word &= word - 1) {
                visit(i * 64 + static_cast<std::uint32_t>(__builtin_ctzll(word)));
            }
        }
    }
    bool operator==(const StateBits&) const = default;

 private:
    std::uint32_t size_ = 0;
    std::vector<std::uint64_t> words_;
};

StateBits states_where_atom_may(const Graph& graph, std::uint32_t atom);
StateBits states_where_atom_must(const Graph& graph, std::uint32_t atom);
// A maximal path may end here: no edge leaves, or those that do need never be taken (kOptional).
// Not where the graph was cut: nobody knows.
bool may_end(const Graph& graph, std::uint32_t state);

// Row s: the sources of the edges into s. Cost: 4 bytes per edge and state.
net::Rows<std::uint32_t> predecessors(const Graph& graph);

struct StrongComponents {
    static constexpr std::uint32_t kNone = ~std::uint32_t{0};  // a state that was left out
    // Per state its component. An edge never leads to a greater number: bottoms come early, and
    // going through states by descending components is a topological order.
    std::vector<std::uint32_t> of;
    std::uint32_t count = 0;
};
// Of the part of the graph that lies in `within` (null: all), also of what is not reachable.
// Source  R. Tarjan, Depth-first search and linear graph algorithms (1972); iterative.
StrongComponents strong_components(const Graph& graph, const StateBits* within = nullptr);
// StrongComponents that no edge of the graph leaves. One bit per component.
StateBits bottom_components(const Graph& graph, const StrongComponents& components);
// StrongComponents that have an edge inside: a path may stay in them for ever. Edges into states
// that were left out do not count. One bit per component.
StateBits cyclic_components(const Graph& graph, const StrongComponents& components);

// All states that paths through `within` (null: all) lead to, from members of `from` that lie in
// it.
StateBits reached_from(const Graph& graph, const StateBits& from,
                       const StateBits* within = nullptr);
// All states from which a path leads to a member of `goal`; every state of it but the goal lies in
// `within` (null: all).
StateBits leading_to(const net::Rows<std::uint32_t>& predecessors, const StateBits& goal,
                     const StateBits* within = nullptr);

// A path: edges as indices of graph.edges.items. From where it starts is told apart.
using Path = std::vector<std::uint32_t>;
struct Lasso {
    Path stem;
    Path loop;  // goes round for ever; empty: the path ends after the stem
};
// The states of a path, `from` included.
std::vector<std::uint32_t> states_along(const Graph& graph, std::uint32_t from, const Path& path);

// A shortest path to a member of `goal`, empty if `from` is one. All states before the goal lie in
// `within` (null: all).
// Gives  nothing when there is none.
std::optional<Path> shortest_path(const Graph& graph, std::uint32_t from, const StateBits& goal,
                                  const StateBits* within = nullptr);
// A short path in `within` that never leaves it and goes on for ever, or ends where paths may end.
// Gives  nothing when there is none; also when `from` does not lie in `within`.
std::optional<Lasso> lasso_within(const Graph& graph, std::uint32_t from, const StateBits& within);
// A shortest way round: from `state` back to it by at least one edge, within `within` (null: all).
std::optional<Path> shortest_cycle(const Graph& graph, std::uint32_t state,
                                   const StateBits* within = nullptr);

}  // namespace puppetri::proof
