// SPDX-License-Identifier: MIT
// Pruning and merging of Büchi automata.
#include "buechi_cleanup.h"

#include <algorithm>
#include <map>
#include <utility>

#include "puppetri/proof/graph_algorithms.h"

namespace puppetri::proof {

namespace {

using Edges = std::vector<std::vector<Buechi::Edge>>;

StrongComponents components_of(const Edges& edges) {
    Graph graph;
    for (const auto& row : edges) {
        for (const Buechi::Edge& e : row) {
            graph.edges.items.push_back({0, e.target});
        }
        graph.edges.starts.push_back(static_cast<std::uint32_t>(graph.edges.items.size()));
    }
    return strong_components(graph);
}

// Marks outside of accepting components are taken away; edges to states from which no accepting
// component is reached too.
void prune(Edges& edges, std::uint64_t all) {
    const StrongComponents components = components_of(edges);
    std::vector<std::uint64_t> marks(components.count, 0);
    std::vector<std::uint8_t> cyclic(components.count, 0), useful(components.count, 0);
    for (std::uint32_t q = 0; q < edges.size(); ++q) {
        for (const Buechi::Edge& e : edges[q]) {
            if (components.of[e.target] == components.of[q]) {
                cyclic[components.of[q]] = 1;
                marks[components.of[q]] |= e.accepts;
            }
        }
    }
    const auto accepting = [&](std::uint32_t c) { return cyclic[c] != 0 && marks[c] == all; };
    // Edges never lead to a greater component: by ascending numbers successors are known.
    std::vector<std::vector<std::uint32_t>> members(components.count);
    for (std::uint32_t q = 0; q < edges.size(); ++q) {
        members[components.of[q]].push_back(q);
    }
    for (std::uint32_t c = 0; c < components.count; ++c) {
        useful[c] = accepting(c) ? 1 : 0;
        for (const std::uint32_t q : members[c]) {
            for (const Buechi::Edge& e : edges[q]) {
                useful[c] |= useful[components.of[e.target]];
            }
        }
    }
    for (std::uint32_t q = 0; q < edges.size(); ++q) {
        auto& row = edges[q];
        row.erase(std::remove_if(
                      row.begin(), row.end(),
                      [&](const Buechi::Edge& e) { return useful[components.of[e.target]] == 0; }),
                  row.end());
        for (Buechi::Edge& e : row) {
            if (components.of[e.target] != components.of[q] || !accepting(components.of[q])) {
                e.accepts = 0;
            }
        }
    }
}

void remove_dominated(std::vector<Buechi::Edge>& row) {
    std::sort(row.begin(), row.end());
    row.erase(std::unique(row.begin(), row.end()), row.end());
    const auto dominates = [](const Buechi::Edge& a, const Buechi::Edge& b) {
        return a.target == b.target && (a.positive & ~b.positive) == 0 &&
               (a.negative & ~b.negative) == 0 && (b.accepts & ~a.accepts) == 0;
    };
    std::vector<Buechi::Edge> kept;
    for (const Buechi::Edge& e : row) {
        if (std::none_of(row.begin(), row.end(), [&](const Buechi::Edge& other) {
                return other != e && dominates(other, e);
            })) {
            kept.push_back(e);
        }
    }
    row = std::move(kept);
}

// States with equal rows are one: edges and initial states are led to the first of them.
// Gives  whether anything was led elsewhere.
bool merge_equal(Edges& edges, std::vector<std::uint32_t>& initial) {
    std::map<std::vector<Buechi::Edge>, std::uint32_t> first;
    std::vector<std::uint32_t> into(edges.size());
    for (std::uint32_t q = 0; q < edges.size(); ++q) {
        into[q] = first.emplace(edges[q], q).first->second;
    }
    bool changed = false;
    const auto lead = [&](std::uint32_t& q) {
        changed = changed || into[q] != q;
        q = into[q];
    };
    for (auto& row : edges) {
        for (Buechi::Edge& e : row) {
            lead(e.target);
        }
    }
    for (std::uint32_t& q : initial) {
        lead(q);
    }
    return changed;
}

}  // namespace

void clean_up(Buechi& automaton) {
    Edges edges;
    for (std::uint32_t q = 0; q < automaton.size(); ++q) {
        const auto row = automaton.edges.row(q);
        edges.emplace_back(row.begin(), row.end());
    }
    do {
        prune(edges, automaton.all_sets());
        for (auto& row : edges) {
            remove_dominated(row);
        }
    } while (merge_equal(edges, automaton.initial));

    // An acceptance set that belongs to every edge that has any mark, or that is implied by
    // another, decides nothing.
    std::vector<std::uint32_t> kept_sets;
    const auto implied = [&](std::uint32_t set, std::uint32_t by) {
        for (const auto& row : edges) {
            for (const Buechi::Edge& e : row) {
                if ((e.accepts >> by & 1) != 0 && (e.accepts >> set & 1) == 0) {
                    return false;
                }
            }
        }
        return true;
    };
    std::vector<std::uint8_t> dropped(automaton.acceptance_sets, 0);
    for (std::uint32_t a = 0; a < automaton.acceptance_sets; ++a) {
        for (std::uint32_t b = 0; b < automaton.acceptance_sets && dropped[a] == 0; ++b) {
            if (a != b && dropped[b] == 0 && implied(a, b)) {
                dropped[a] = 1;
            }
        }
        if (dropped[a] == 0) {
            kept_sets.push_back(a);
        }
    }

    // What is reached, renumbered; initial states from which nothing is accepted have no edges.
    std::vector<std::uint32_t> number(edges.size(), ~0u), order;
    const auto meet = [&](std::uint32_t q) {
        if (number[q] == ~0u) {
            number[q] = static_cast<std::uint32_t>(order.size());
            order.push_back(q);
        }
    };
    std::sort(automaton.initial.begin(), automaton.initial.end());
    automaton.initial.erase(std::unique(automaton.initial.begin(), automaton.initial.end()),
                            automaton.initial.end());
    std::erase_if(automaton.initial, [&](std::uint32_t q) { return edges[q].empty(); });
    for (std::uint32_t& q : automaton.initial) {
        meet(q);
        q = number[q];
    }
    automaton.edges = {};
    for (std::uint32_t i = 0; i < order.size(); ++i) {
        for (Buechi::Edge e : edges[order[i]]) {
            meet(e.target);
            e.target = number[e.target];
            std::uint64_t accepts = 0;
            for (std::size_t k = 0; k < kept_sets.size(); ++k) {
                accepts |= (e.accepts >> kept_sets[k] & 1) << k;
            }
            e.accepts = accepts;
            automaton.edges.items.push_back(e);
        }
        automaton.edges.starts.push_back(static_cast<std::uint32_t>(automaton.edges.items.size()));
    }
    automaton.acceptance_sets = static_cast<std::uint32_t>(kept_sets.size());
}

}  // namespace puppetri::proof
