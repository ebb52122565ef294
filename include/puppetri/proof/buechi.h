// SPDX-License-Identifier: MIT
// Automata over infinite sequences of states: what a formula of linear time is translated to.
// Generalized, with acceptance on edges: a run is accepted if it takes edges of every acceptance
// set again and again. Guards are conjunctions of atoms and negated atoms.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "puppetri/net/net.h"
#include "puppetri/proof/temporal.h"

namespace puppetri::proof {

struct Buechi {
    struct Edge {
        std::uint32_t target = 0;
        std::uint64_t positive = 0, negative = 0;  // atoms that must hold, that must not
        std::uint64_t accepts = 0;                 // bit a: it belongs to acceptance set a
        bool operator==(const Edge&) const = default;
        auto operator<=>(const Edge&) const = default;
        bool open(std::uint64_t atoms) const {
            return (positive & ~atoms) == 0 && (negative & atoms) == 0;
        }
    };
    net::Rows<Edge> edges;
    std::vector<std::uint32_t> initial;  // a run begins in any of them; none: accepts nothing
    std::uint32_t acceptance_sets = 0;   // 0: every infinite run is accepted
    std::uint64_t all_sets() const {
        return acceptance_sets == 64 ? ~std::uint64_t{0}
                                     : (std::uint64_t{1} << acceptance_sets) - 1;
    }
    std::uint32_t size() const { return edges.size(); }
};

// Sequences of states (sets of atoms) that satisfy the formula; `negated`: those that do not.
// Needs  logic kLtl or kState.
// Gives  nothing for more than 64 atoms or untils, or when the automaton outgrows `max_states`
//        or the work of so many (about a second for 4096; counted in steps, not by a clock).
//        States from which nothing is accepted are left out; equal ones are merged.
// Source P. Gastin, D. Oddoux, Fast LTL to Büchi automata translation (CAV 2001): very weak
//        alternating automaton, then generalized Büchi automaton with dominated edges removed;
//        untils are accepted on edges as there.
std::optional<Buechi> automaton_of(const Temporal& formula, bool negated,
                                   std::uint32_t max_states = 4096);

// Whether the automaton accepts stem loop loop loop ... (sets of atoms). Needs a loop.
bool accepts(const Buechi& automaton, std::span<const std::uint64_t> stem,
             std::span<const std::uint64_t> loop);

}  // namespace puppetri::proof
