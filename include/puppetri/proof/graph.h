// SPDX-License-Identifier: MIT
// A finite graph of states, as every explicit method makes it (plain untimed, readiness, timed
// exact, state classes) and as rules and logics read it. Flat: one row of edges per state, one bit
// per state and atom. What a state was is its maker's business; it can tell one in words.
#pragma once
#include <cstdint>
#include <vector>

#include "puppetri/base/index.h"
#include "puppetri/net/net.h"
#include "puppetri/proof/budget.h"

namespace puppetri::proof {

struct Edge {
    // A transition that fires; or kPass: time passes or tokens become ready (the settled instant
    // ends); or kEvent | event: an outside event occurs.
    static constexpr std::uint32_t kPass = ~std::uint32_t{0};
    static constexpr std::uint32_t kEvent = 1u << 31;
    std::uint32_t label = kPass;
    std::uint32_t target = 0;
};

// What is true in a state as far as the method can tell: on exact graphs may == must.
struct AtomBits {
    std::uint32_t atoms = 0;               // per state
    std::vector<std::uint64_t> may, must;  // rows of (atoms + 63) / 64 words
    bool may_hold(std::uint32_t state, std::uint32_t atom) const {
        const std::uint64_t i = std::uint64_t{state} * ((atoms + 63) / 64) + atom / 64;
        return ((may[i] >> (atom & 63)) & 1) != 0;
    }
    bool must_hold(std::uint32_t state, std::uint32_t atom) const {
        const std::uint64_t i = std::uint64_t{state} * ((atoms + 63) / 64) + atom / 64;
        return ((must[i] >> (atom & 63)) & 1) != 0;
    }
};

struct Graph {
    enum Flag : std::uint8_t {
        kSettled = 1,   // nothing can fire any more in this instant: time passes here
        kFinal = 2,     // a declared final marking
        kOptional = 4,  // all its edges may fail to happen for ever (outside events, free guards,
                        // unbounded delays): dead for those who ask about death
        kCut = 8,       // not expanded: the budget ended, or a datum left its range here
    };
    std::uint32_t initial = 0;
    net::Rows<Edge> edges;
    std::vector<std::uint8_t> flags;  // per state
    // Ticks that pass along each edge of exact timed graphs: [low, high]; empty: not known. Same
    // order as edges.items.
    std::vector<std::int64_t> low_ticks, high_ticks;
    AtomBits atoms;
    // Every run of the net is a path (over), every path is a run of the net (exact).
    bool over = true, exact = false;
    Ended ended = Ended::kDone;

    std::uint32_t size() const { return edges.size(); }
    bool dead(std::uint32_t s) const { return edges.starts[s] == edges.starts[s + 1]; }
    // Time may pass along this edge, as far as edges show it.
    bool lets_time_pass(std::uint32_t edge) const {
        return edges.items[edge].label == Edge::kPass ||
               (!high_ticks.empty() && high_ticks[edge] > 0);
    }
};

}  // namespace puppetri::proof
