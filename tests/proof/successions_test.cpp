// SPDX-License-Identifier: MIT
#include "puppetri/proof/successions.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <set>
#include <vector>

#include "puppetri/base/random.h"

using namespace puppetri;
using namespace puppetri::proof;

namespace {

struct Case {
    Graph graph;
    net::Rows<Begin> begins;
    std::vector<std::uint32_t> items;
    std::vector<Begin> initially;

    std::vector<Succession> found() const {
        return successions(
            {.graph = graph, .begins = begins, .items = items, .initially = initially});
    }
};

Case random_case(RandomStream& stream) {
    Case c;
    const auto below = [&](std::uint64_t n) { return static_cast<std::uint32_t>(stream.below(n)); };
    const std::uint32_t states = 1 + below(12), transitions = 1 + below(8), lanes = 1 + below(3);
    for (std::uint32_t l = 0; l < lanes; ++l) {
        c.items.push_back(below(20) == 0 ? 70 : 1 + below(4));
    }
    for (std::uint32_t t = 0; t < transitions; ++t) {
        for (std::uint32_t k = below(3); k > 0; --k) {
            const std::uint32_t lane = below(lanes);
            c.begins.items.push_back({lane, below(c.items[lane])});
        }
        c.begins.starts.push_back(static_cast<std::uint32_t>(c.begins.items.size()));
    }
    for (std::uint32_t s = 0; s < states; ++s) {
        for (std::uint32_t k = below(4); k > 0; --k) {
            const std::uint32_t kind = below(6);
            c.graph.edges.items.push_back({kind == 0   ? Edge::kPass
                                           : kind == 1 ? Edge::kEvent | 3
                                                       : below(transitions),
                                           below(states)});
        }
        c.graph.edges.starts.push_back(static_cast<std::uint32_t>(c.graph.edges.items.size()));
    }
    c.graph.initial = below(states);
    if (below(2) == 0) {
        const std::uint32_t lane = below(lanes);
        c.initially.push_back({lane, below(c.items[lane])});
    }
    return c;
}

// One lane, a path at a time: every pair (state, last begun) is a node of its own.
void brute_force(const Case& c, std::uint32_t lane, std::set<Succession>& out) {
    std::set<std::pair<std::uint32_t, std::uint32_t>> seen;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> open;
    const auto visit = [&](std::uint32_t state, std::uint32_t last) {
        if (seen.insert({state, last}).second) {
            open.push_back({state, last});
        }
    };
    bool any = false;
    for (const Begin& b : c.initially) {
        if (b.lane == lane) {
            visit(c.graph.initial, b.item);
            any = true;
        }
    }
    if (!any) {
        visit(c.graph.initial, c.items[lane]);
    }
    while (!open.empty()) {
        const auto [state, last] = open.back();
        open.pop_back();
        for (const Edge& e : c.graph.edges.row(state)) {
            std::vector<std::uint32_t> begun;
            if (e.label != Edge::kPass && (e.label & Edge::kEvent) == 0) {
                for (const Begin& b : c.begins.row(e.label)) {
                    if (b.lane == lane) {
                        begun.push_back(b.item);
                    }
                }
            }
            if (begun.empty()) {
                visit(e.target, last);
            }
            // In any order: each may be the first and the last.
            for (std::size_t i = 0; i < begun.size(); ++i) {
                out.insert({lane, last, e.label, begun[i]});
                for (std::size_t k = 0; k < begun.size(); ++k) {
                    if (k != i) {
                        out.insert({lane, begun[k], e.label, begun[i]});
                    }
                }
                visit(e.target, begun[i]);
            }
        }
    }
}

}  // namespace

TEST_CASE("successions are those of all paths, no more and no fewer [oracle]") {
    std::size_t total = 0;
    for (std::uint64_t seed = 0; seed < 2000; ++seed) {
        RandomStream stream{stream_key(seed, "successions", "graph"), 0};
        const Case c = random_case(stream);
        std::set<Succession> expected;
        for (std::uint32_t lane = 0; lane < c.items.size(); ++lane) {
            brute_force(c, lane, expected);
        }
        const std::vector<Succession> found = c.found();
        CAPTURE(seed);
        CHECK(std::is_sorted(found.begin(), found.end()));
        CHECK(found == std::vector<Succession>(expected.begin(), expected.end()));
        total += found.size();
    }
    CHECK(total > 5000);
}
