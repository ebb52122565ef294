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
    // Inequalities are brought to one form: factors without a common divisor, the first one
    // positive; what holds for all counts, or for none, becomes a constant. No limit may be within
    // one of the ends of the range of 64 bits.
    static Predicate at_most(LinearSum sum, std::int64_t limit);
    static Predicate at_least(LinearSum sum, std::int64_t limit);
    static Predicate enabled(std::vector<std::uint32_t> transitions);
    // Dead: none is enabled of the transitions that count when death is decided (not optional).
    static Predicate no_successor(const PlainNet& net);
    // Simplified: constants vanish, nested ones are flattened, lists of transitions are merged.
    static Predicate all_of(std::span<const Predicate> parts);
    static Predicate any_of(std::span<const Predicate> parts);
    Predicate negated() const;

    bool is_constant(bool value) const {
        return nodes.back().op == (value ? Op::kTrue : Op::kFalse);
    }
    // Cost  O(nodes + arcs). Who asks often compiles (CompiledPredicate).
    bool holds(const PlainNet& net, std::span<const std::uint32_t> marking) const;
};

// The same predicate where each place is known to hold at most `upper[place]` tokens: inequalities
// that this decides become constants.
Predicate simplified(const Predicate& predicate, const PlainNet& net,
                     std::span<const std::uint32_t> upper);

// The same predicate with the enabledness of transitions told in tokens (levels are not looked at),
// and with places renamed: `place_to` of those of `net`, empty: none.
Predicate told_in_tokens(const Predicate& predicate, const PlainNet& net,
                         std::span<const std::uint32_t> place_to = {});
// All places that the truth of the predicate depends on, ascending.
std::vector<std::uint32_t> places_of(const Predicate& predicate, const PlainNet& net);

// A predicate as a program of tests with two targets each, without stack and without state: enough
// to be asked in every state of millions. Enabledness becomes tests of counts; the net need not
// outlive it.
// Source  jumping code of Boolean expressions, Aho, Lam, Sethi, Ullman: Compilers, section 6.6.
class CompiledPredicate {
 public:
    CompiledPredicate() = default;  // false
    CompiledPredicate(const PlainNet& net, const Predicate& predicate);

    bool holds(std::span<const std::uint32_t> marking) const {
        return holds_by([&](std::uint32_t place) { return marking[place]; });
    }
    // The same where a functor gives the tokens of a place: for packed states.
    template <class Count>
    bool holds_by(Count&& count) const {
        std::uint32_t at = entry_;
        while (at < kFalse) {
            const Test& test = tests_[at];
            bool yes = false;
            if ((test.place & kSum) == 0) {
                yes = count(test.place) >= test.threshold;
            } else {
                std::int64_t sum = 0;
                const Sum& s = sums_[test.place & ~kSum];
                for (std::uint32_t i = s.first; i < s.first + s.count; ++i) {
                    sum += terms_[i].factor * std::int64_t{count(terms_[i].place)};
                }
                yes = sum >= s.limit;
            }
            at = yes ? test.yes : test.no;
        }
        return at == kTrue;
    }
    bool is_constant(bool value) const { return entry_ == (value ? kTrue : kFalse); }
    // All places that it may look at, ascending.
    std::vector<std::uint32_t> places() const;

 private:
    static constexpr std::uint32_t kFalse = ~std::uint32_t{1}, kTrue = ~std::uint32_t{0};
    static constexpr std::uint32_t kSum = 1u << 31;
    struct Test {
        std::uint32_t place = 0;  // at least `threshold` tokens; or kSum | index of a sum
        std::uint32_t threshold = 0;
        std::uint32_t yes = 0, no = 0;  // the next test, or kTrue, kFalse
    };
    struct Sum {
        std::uint32_t first = 0, count = 0;  // of terms_
        std::int64_t limit = 0;              // at least this
    };
    std::uint32_t entry_ = kFalse;
    std::vector<Test> tests_;
    std::vector<Sum> sums_;
    std::vector<LinearSum::Term> terms_;
};

// A state formula (no temporal operator) as a predicate.
// Gives  nothing if an atom speaks of data, events, firings, readiness of timed places, the host,
// or
//        counts in a way that is not linear; or of the fireability of a transition that is more
//        than its arcs: with a guard, delay or event, timed places, or beside other priorities.
std::optional<Predicate> predicate_of(const net::Net& net, const net::Formula& formula);
// Where the net may end; nothing if a declared end speaks of more than counts.
std::optional<Predicate> final_markings(const net::Net& net);
// An int expression without a constant part.
std::optional<LinearSum> linear_sum_of(const net::Net& net, const Expr& expression);

}  // namespace puppetri::proof
