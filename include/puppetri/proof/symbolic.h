// SPDX-License-Identifier: MIT
// The reachable markings of a plain net as one decision diagram, and questions about sets of them:
// counts, bounds, linear predicates, CTL, LTL by a product with an automaton. It never looks at one
// state at a time: Philosophers-100 has 3^100 markings and takes milliseconds.
//
// The one idea to hold: every answer may be missing. A set that a used-up budget kept from being
// computed is *unknown*; whatever is made of an unknown set is unknown, and whoever asks it for a
// fact gets nothing. So a forgotten check of the budget can make an answer UNKNOWN, never wrong.
//
// Source  multi-valued decision diagrams with saturation: G. Ciardo, R. Marmorstein,
//         R. Siminiceanu, "Saturation Unbound" (TACAS 2003); constrained saturation: Y. Zhao,
//         G. Ciardo, "Symbolic CTL Model Checking of Asynchronous Systems Using Constrained
//         Saturation" (ATVA 2009).
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "puppetri/base/natural.h"
#include "puppetri/proof/budget.h"
#include "puppetri/proof/plain_net.h"
#include "puppetri/proof/predicate.h"

namespace puppetri::proof {

class SymbolicSpace;
struct SymbolicTables;

// A set of reachable markings, or *unknown*. A value: copies share the diagram. Its space must live
// longer.
class StateSet {
 public:
    StateSet() = default;  // unknown
    StateSet(const StateSet& other);
    StateSet(StateSet&& other) noexcept;
    StateSet& operator=(StateSet other) noexcept;
    ~StateSet();
    bool known() const { return tables_ != nullptr; }

 private:
    friend class SymbolicSpace;
    StateSet(SymbolicTables* tables, std::uint32_t root);
    SymbolicTables* tables_ = nullptr;
    std::uint32_t root_ = 0;
};

// A generalized Büchi automaton over the reachable markings, for SymbolicSpace::lasso. Few states,
// each edge with the markings it can be taken in: the automaton is explicit, the net symbolic.
// A run reads the markings of a path one by one: in marking i it takes an edge whose guard holds in
// marking i. A path that ends stands in its last marking for ever. A path is accepted if a run
// takes edges of each acceptance set again and again.
struct SymbolicAutomaton {
    struct Edge {
        std::uint32_t from = 0, to = 0;
        StateSet guard;
        std::uint64_t accepts = 0;  // bit a: the edge belongs to acceptance set a
    };
    std::uint32_t states = 0;
    std::uint32_t acceptance_sets = 0;  // at most 64; 0: every infinite run is accepted
    std::vector<std::uint32_t> initial;
    std::vector<Edge> edges;
};

// A path to a marking from which `loop` leads back to it; an empty loop: the path may end there.
struct SymbolicLasso {
    std::vector<std::uint32_t> stem, loop;  // transitions
};

struct SymbolicFacts {
    Natural states, edges;
    std::uint32_t max_in_place = 0;
    std::uint64_t max_in_marking = 0;
    bool dead_reachable = false;  // a marking without successor
};

class SymbolicSpace {
 public:
    // Explores: several orders of the places are tried with growing shares of the budget.
    // Gives  ended() == kDone, or why not: kUnbounded when a count passes 2^31; a net that is not
    //        bounded otherwise ends in kMemory or kTime. Then every set is unknown.
    // Needs  net.has_levels false; else supported() is false and every set is unknown.
    // Cost   memory is the larger of the diagram's peak and its caches, within budget.bytes.
    SymbolicSpace(const PlainNet& net, const Budget& budget);
    ~SymbolicSpace();
    SymbolicSpace(const SymbolicSpace&) = delete;
    SymbolicSpace& operator=(const SymbolicSpace&) = delete;

    bool supported() const;
    Ended ended() const;  // how the last operation ended; of an unknown set, why it is
    // A new budget, its clock starting now, for the operations that follow.
    void renew(const Budget& budget);
    const PlainNet& net() const;
    std::uint64_t bytes() const;       // held now
    std::uint64_t peak_bytes() const;  // held at most, so far

    // Sets. Complements are taken within the reachable markings.
    StateSet all() const;
    StateSet none() const;
    StateSet initial() const;
    // Of one marking; empty if it is not reachable.
    StateSet singleton(std::span<const std::uint32_t> marking) const;
    StateSet both(const StateSet& a, const StateSet& b);
    StateSet either(const StateSet& a, const StateSet& b);
    StateSet without(const StateSet& a, const StateSet& b);
    StateSet complement(const StateSet& a);
    // Markings of `within` that satisfy the predicate.
    StateSet satisfying(const Predicate& predicate, const StateSet& within);
    StateSet satisfying(const Predicate& predicate) { return satisfying(predicate, all()); }
    StateSet enabled(std::uint32_t transition, const StateSet& within);
    // No transition is enabled.
    StateSet dead();
    // A path may end here: no transition is enabled but optional ones. Equals dead() where the net
    // has no optional transitions.
    StateSet stuck();

    // Facts. Nothing: the set is unknown, or the budget ended while the question was answered.
    std::optional<bool> empty(const StateSet& a) const;
    std::optional<bool> equal(const StateSet& a, const StateSet& b) const;
    std::optional<bool> holds_initially(const StateSet& a) const;
    std::optional<bool> contains(const StateSet& a, std::span<const std::uint32_t> marking) const;
    std::optional<Natural> count(const StateSet& a);
    // Firings: the sum over all transitions of the markings that enable them.
    std::optional<Natural> edges(const StateSet& a);
    std::optional<std::vector<std::uint32_t>> max_tokens(const StateSet& a);  // per place
    // Nothing also for the empty set, and where 64 bits do not hold the sum.
    std::optional<std::int64_t> max_of(const LinearSum& sum, const StateSet& a);
    std::optional<std::int64_t> min_of(const LinearSum& sum, const StateSet& a);
    std::optional<SymbolicFacts> facts();
    std::optional<Marking> some_marking(const StateSet& a);  // nothing also for the empty set

    // CTL over maximal paths: a path that ends does so in a stuck marking. There EX and AX(false)
    // are as no successor makes them, EG a holds if a does.
    StateSet ex(const StateSet& a);
    StateSet eu(const StateSet& hold, const StateSet& until);
    StateSet eg(const StateSet& a);
    StateSet ef(const StateSet& a) { return eu(all(), a); }
    StateSet ax(const StateSet& a) { return complement(ex(complement(a))); }
    StateSet af(const StateSet& a) { return complement(eg(complement(a))); }
    StateSet ag(const StateSet& a) { return complement(ef(complement(a))); }
    StateSet au(const StateSet& hold, const StateSet& until);
    // Successors; what is reached from `from` through markings of `within` (from included).
    StateSet successors(const StateSet& a);
    StateSet reached(const StateSet& from, const StateSet& within);
    // Markings from which some infinite or ended path stays in `a` and visits each of `fair` again
    // and again (an ended path: its last marking is in all of them).
    StateSet fair_eg(const StateSet& a, std::span<const StateSet> fair);

    // Rules over all markings. true: it holds.
    std::optional<bool> live(std::uint32_t transition);        // AG EF enabled
    std::optional<bool> quasi_live(std::uint32_t transition);  // EF enabled
    std::optional<bool> stable(std::uint32_t place);           // the same count in every marking
    std::optional<bool> reversible();                          // AG EF initial

    // A path of firings from a marking to a member of `to`, through markings of `within` (its first
    // and last marking may lie outside): a shortest one, or any, where a shortest one costs
    // millions of nodes. Gives  nothing when there is none (then ended() is kDone), or when the
    // budget ended.
    std::optional<std::vector<std::uint32_t>> path(std::span<const std::uint32_t> from,
                                                   const StateSet& to, const StateSet& within);
    std::optional<std::vector<std::uint32_t>> path_to(const StateSet& to) {
        return path(net().initial, to, all());
    }

    // Whether some maximal path from the initial marking is accepted; nothing: unknown.
    // Source  explicit automaton, symbolic net: R. Sebastiani, S. Tonetta, M. Vardi, "Symbolic
    //         Systems, Explicit Properties" (CAV 2005); fair hull: E. A. Emerson, C.-L. Lei (1986).
    std::optional<bool> accepts(const SymbolicAutomaton& automaton);
    // A witness of accepts() == true.
    std::optional<SymbolicLasso> lasso(const SymbolicAutomaton& automaton);

 private:
    StateSet wrap(std::uint32_t root) const;
    bool ready(const StateSet& a) const;
    StateSet at_most(const LinearSum& sum, std::int64_t limit, const StateSet& within);
    StateSet satisfying(const Predicate& predicate, std::uint32_t index, const StateSet& within);
    StateSet enabled_any(std::span<const std::uint32_t> transitions, const StateSet& within);
    StateSet before(const StateSet& a, const StateSet& within);
    StateSet after(const StateSet& a, const StateSet& within);
    static constexpr std::uint32_t kAnyTransition = ~std::uint32_t{0};
    struct Ball {
        StateSet set;
        std::uint32_t by = kAnyTransition;  // that one firing of this leads into the set before
    };
    std::vector<Ball> balls_around(const StateSet& to, std::span<const std::uint32_t> from,
                                   const StateSet& room, bool shortest);

    std::unique_ptr<SymbolicTables> tables_;
};

}  // namespace puppetri::proof
