// SPDX-License-Identifier: MIT
// StrongComponents, paths and lassos against the transitive closure of small random graphs.
#include "puppetri/proof/graph_algorithms.h"

#include "proof/random_graph.h"

namespace puppetri::proof {

namespace {

using Matrix = std::vector<std::vector<std::uint32_t>>;
constexpr std::uint32_t kFar = 1000;

// Lengths of shortest paths of at least one edge through `within` (ends included).
Matrix distances(const Graph& g, const StateBits& within) {
    const std::uint32_t n = g.size();
    Matrix d(n, std::vector<std::uint32_t>(n, kFar));
    for (std::uint32_t s = 0; s < n; ++s) {
        for (const Edge& e : g.edges.row(s)) {
            if (within[s] && within[e.target]) {
                d[s][e.target] = 1;
            }
        }
    }
    for (std::uint32_t k = 0; k < n; ++k) {
        for (std::uint32_t i = 0; i < n; ++i) {
            for (std::uint32_t j = 0; j < n; ++j) {
                d[i][j] = std::min(d[i][j], d[i][k] + d[k][j]);
            }
        }
    }
    return d;
}

StateBits random_bits(TestRandom& random, std::uint32_t size, std::uint32_t odds) {
    StateBits bits(size);
    for (std::uint32_t s = 0; s < size; ++s) {
        if (random.below(odds) != 0) {
            bits.add(s);
        }
    }
    return bits;
}

}  // namespace

TEST_CASE("components are the classes of mutual reachability, bottoms first [oracle]") {
    TestRandom random(21);
    for (int i = 0; i < 1000; ++i) {
        const Graph g = random_graph(random, 1 + random.below(12));
        const StateBits within = random_bits(random, g.size(), 5);
        const Matrix d = distances(g, within);
        const StrongComponents c = strong_components(g, &within);
        const StateBits cyclic = cyclic_components(g, c), bottom = bottom_components(g, c);
        for (std::uint32_t s = 0; s < g.size(); ++s) {
            REQUIRE((c.of[s] == StrongComponents::kNone) == !within[s]);
            if (!within[s]) {
                continue;
            }
            bool leaves = false;
            for (std::uint32_t t = 0; t < g.size(); ++t) {
                if (within[t]) {
                    const bool together = s == t || (d[s][t] < kFar && d[t][s] < kFar);
                    REQUIRE((c.of[s] == c.of[t]) == together);
                }
                if (c.of[s] == c.of[t]) {
                    for (const Edge& e : g.edges.row(t)) {
                        leaves = leaves || c.of[e.target] != c.of[s];
                    }
                }
            }
            for (const Edge& e : g.edges.row(s)) {
                REQUIRE((!within[e.target] || c.of[e.target] <= c.of[s]));
            }
            REQUIRE(cyclic[c.of[s]] == (d[s][s] < kFar));
            REQUIRE(bottom[c.of[s]] == !leaves);
        }
    }
}

TEST_CASE("paths and cycles are shortest ones, and found when there are any [oracle]") {
    TestRandom random(22);
    for (int i = 0; i < 1000; ++i) {
        const Graph g = random_graph(random, 2 + random.below(10));
        const StateBits within = random_bits(random, g.size(), 5);
        const Matrix d = distances(g, within);
        const std::uint32_t from = random.below(g.size()), to = random.below(g.size());
        StateBits goal(g.size());
        goal.add(to);
        const auto path = shortest_path(g, from, goal, &within);
        // The goal itself need not lie within.
        StateBits with_goal = within;
        with_goal.add(to);
        const std::uint32_t length = from == to     ? 0
                                     : within[from] ? distances(g, with_goal)[from][to]
                                                    : kFar;
        REQUIRE(path.has_value() == (length < kFar));
        if (path.has_value()) {
            REQUIRE(path->size() == length);
            REQUIRE(states_along(g, from, *path).back() == to);
        }
        const auto cycle = shortest_cycle(g, from, &within);
        REQUIRE(cycle.has_value() == (d[from][from] < kFar));
        if (cycle.has_value()) {
            REQUIRE(cycle->size() == d[from][from]);
            REQUIRE(states_along(g, from, *cycle).back() == from);
        }
        const auto lasso = lasso_within(g, from, within);
        bool goes_on = within[from] && may_end(g, from);
        for (std::uint32_t s = 0; s < g.size(); ++s) {
            if (within[s] && within[from] && (s == from || d[from][s] < kFar)) {
                goes_on = goes_on || may_end(g, s) || d[s][s] < kFar;
            }
        }
        REQUIRE(lasso.has_value() == goes_on);
    }
}

TEST_CASE("forwards and backwards reachability are mirror images [law]") {
    TestRandom random(23);
    for (int i = 0; i < 1000; ++i) {
        const Graph g = random_graph(random, 2 + random.below(10));
        const net::Rows<std::uint32_t> back = predecessors(g);
        REQUIRE(back.items.size() == g.edges.items.size());
        for (std::uint32_t s = 0; s < g.size(); ++s) {
            StateBits one(g.size());
            one.add(s);
            const StateBits forwards = reached_from(g, one);
            for (std::uint32_t t = 0; t < g.size(); ++t) {
                StateBits other(g.size());
                other.add(t);
                REQUIRE(forwards[t] == leading_to(back, other)[s]);
            }
        }
    }
}

TEST_CASE("sets of states count and complement within their size [unit]") {
    for (const std::uint32_t size : {0u, 1u, 63u, 64u, 65u, 200u}) {
        StateBits bits(size, true);
        CHECK(bits.count() == size);
        bits.complement();
        CHECK(bits.empty());
        bits.complement();
        CHECK(bits == StateBits(size, true));
    }
}

}  // namespace puppetri::proof
