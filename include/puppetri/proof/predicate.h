// SPDX-License-Identifier: MIT
// Predicates over markings of a plain net: and, or, not over linear inequalities of token counts
// and the enabledness of transitions. What reachability, bounds and the atoms of logics come down
// to.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "puppetri/net/formula.h"
#include "puppetri/proof/plain_net.h"

namespace puppetri::proof {

// sum of factor * tokens(place)
struct LinearSum {
    struct Term {
        std::uint32_t place = 0;
        std::int64_t factor = 1;
        bool operator==(const Term&) const = default;
    };
    std::vector<Term> terms;  // in order of places, no zero factors
    bool operator==(const LinearSum&) const = default;
};

// In negation normal form: `not` is pushed into the atoms.
struct Predicate {
    enum class Op : std::uint8_t {
        kFalse,
        kTrue,
        kAtMost,       // sums[index] <= limit
        kAtLeast,      // sums[index] >= limit
        kEnabled,      // one of the transitions in the list
        kNoneEnabled,  // none of them
        kAnd,
        kOr,
    };
    struct Node {
        Op op = Op::kTrue;
        std::uint32_t first = 0, count = 0;  // of kAnd, kOr: children; of (none) enabled:
                                             // transitions; ranges of `list`
        std::uint32_t index = 0;
        std::int64_t limit = 0;
    };
    std::vector<Node> nodes;  // children before parents; the root is last
    std::vector<std::uint32_t> list;
    std::vector<LinearSum> sums;

    static Predicate constant(bool value);
    static Predicate at_most(LinearSum sum, std::int64_t limit);
    static Predicate at_least(LinearSum sum, std::int64_t limit);
    static Predicate enabled(std::vector<std::uint32_t> transitions);
    static Predicate no_successor(const PlainNet& net);  // dead: none of all is enabled
    static Predicate all_of(std::span<const Predicate> parts);
    static Predicate any_of(std::span<const Predicate> parts);
    Predicate negated() const;

    bool holds(const PlainNet& net, std::span<const std::uint32_t> marking) const;
};

// A state formula (no temporal operator) as a predicate.
// Gives  nothing if an atom speaks of data, events, firings, readiness of timed places, the host,
// or
//        counts in a way that is not linear.
std::optional<Predicate> predicate_of(const net::Net& net, const net::Formula& formula);
std::optional<LinearSum> linear_sum_of(const net::Net& net, const Expr& expression);

}  // namespace puppetri::proof
