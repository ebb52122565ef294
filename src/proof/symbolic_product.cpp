// SPDX-License-Identifier: MIT
// The product of the net with a Büchi automaton: one set of markings per state of the automaton.
//
// Source  R. Sebastiani, S. Tonetta, M. Vardi (CAV 2005) for the split; E. A. Emerson, C.-L. Lei
//         (1986) for the fair hull; saturating the loops of one automaton state is ours.
#include <algorithm>
#include <utility>

#include "puppetri/base/require.h"
#include "puppetri/proof/symbolic.h"
#include "symbolic_tables.h"

namespace puppetri::proof {
namespace {

using Edge = SymbolicAutomaton::Edge;
// Per automaton state. Pairs (marking, state): the run has read all markings before this one.
using Pairs = std::vector<StateSet>;

// How markings follow each other: by firings, or (after a path's end) each one itself for ever.
enum class Moves : std::uint8_t { kFire, kStand };

class Product {
 public:
    Product(SymbolicSpace& space, const SymbolicAutomaton& automaton)
        : space_(space), automaton_(automaton), loops_(automaton.states) {
        for (const Edge& edge : automaton.edges) {
            PUP_REQUIRE(edge.from < automaton.states && edge.to < automaton.states);
            known_ = known_ && edge.guard.known();
            if (edge.from == edge.to) {
                StateSet& loop = loops_[edge.from];
                loop = loop.known() ? space.either(loop, edge.guard) : edge.guard;
            }
        }
    }

    // Whatever was unknown on the way leaves everything unknown.
    bool known() const { return known_; }

    // Pairs that the runs from the initial marking visit.
    Pairs reachable() {
        Pairs pairs(automaton_.states, space_.none());
        for (const std::uint32_t q : automaton_.initial) {
            PUP_REQUIRE(q < automaton_.states);
            pairs[q] = space_.initial();
        }
        std::vector<std::uint8_t> waiting(automaton_.states, 1);
        for (bool any = true; any && known_;) {
            any = false;
            for (std::uint32_t q = 0; q < automaton_.states; ++q) {
                if (!waiting[q]) {
                    continue;
                }
                waiting[q] = 0;
                any = true;
                if (loops_[q].known()) {
                    pairs[q] = stay(pairs[q], loops_[q]);
                }
                for (const Edge& edge : automaton_.edges) {
                    if (edge.from == q && edge.to != q) {
                        const StateSet more = space_.either(
                            pairs[edge.to], space_.successors(space_.both(pairs[q], edge.guard)));
                        waiting[edge.to] |= differ(more, pairs[edge.to]) ? 1 : 0;
                        pairs[edge.to] = more;
                    }
                }
            }
        }
        check(pairs);
        return pairs;
    }

    // The largest part of `pairs` from every pair of which edges of each acceptance set are met,
    // again and again, within the part.
    Pairs fair_hull(Pairs pairs, Moves moves) {
        for (bool more = true; more && known_;) {
            const Pairs old = pairs;
            pairs = with_edge(pairs, kAnyEdge, moves);
            for (std::uint32_t set = 0; set < automaton_.acceptance_sets && known_; ++set) {
                pairs = leading_to(with_edge(pairs, set, moves), pairs, moves);
            }
            more = false;
            for (std::uint32_t q = 0; q < automaton_.states; ++q) {
                more = differ(pairs[q], old[q]) || more;
            }
        }
        return pairs;
    }

    static constexpr std::uint32_t kAnyEdge = ~std::uint32_t{0};
    bool belongs(const Edge& edge, std::uint32_t set) const {
        return set == kAnyEdge || ((edge.accepts >> set) & 1) != 0;
    }

    // Pairs of `within` with an edge of the acceptance set into it.
    Pairs with_edge(const Pairs& within, std::uint32_t set, Moves moves) {
        Pairs result(automaton_.states, space_.none());
        for (const Edge& edge : automaton_.edges) {
            if (belongs(edge, set)) {
                result[edge.from] = space_.either(
                    result[edge.from],
                    previous(within[edge.to], space_.both(within[edge.from], edge.guard), moves));
            }
        }
        check(result);
        return result;
    }

    bool some(const Pairs& pairs) {
        bool any = false;
        for (const StateSet& set : pairs) {
            const std::optional<bool> none = space_.empty(set);
            known_ = known_ && none.has_value();
            any = any || none == false;
        }
        return any;
    }

    void check(const Pairs& pairs) {
        for (const StateSet& set : pairs) {
            known_ = known_ && set.known();
        }
    }

 private:
    // Pairs of `within` from which a run within it gets to one of `targets` (these included).
    Pairs leading_to(Pairs targets, const Pairs& within, Moves moves) {
        std::vector<std::uint8_t> waiting(automaton_.states, 1);
        for (bool any = true; any && known_;) {
            any = false;
            for (std::uint32_t q = 0; q < automaton_.states; ++q) {
                if (!waiting[q]) {
                    continue;
                }
                waiting[q] = 0;
                any = true;
                if (moves == Moves::kFire && loops_[q].known()) {
                    targets[q] = space_.eu(space_.both(within[q], loops_[q]), targets[q]);
                }
                for (const Edge& edge : automaton_.edges) {
                    if (edge.to == q && edge.from != q) {
                        const StateSet more = space_.either(
                            targets[edge.from],
                            previous(targets[q], space_.both(within[edge.from], edge.guard),
                                     moves));
                        waiting[edge.from] |= differ(more, targets[edge.from]) ? 1 : 0;
                        targets[edge.from] = more;
                    }
                }
            }
        }
        check(targets);
        return targets;
    }

    // Markings of `within` with a next one in `a`.
    StateSet previous(const StateSet& a, const StateSet& within, Moves moves) {
        return space_.both(moves == Moves::kFire ? space_.ex(a) : a, within);
    }
    // What runs visit that stay in one state: its loop is read in the markings that are left.
    StateSet stay(const StateSet& from, const StateSet& loop) {
        const StateSet inside = space_.reached(space_.both(from, loop), loop);
        return space_.either(from, space_.either(inside, space_.successors(inside)));
    }
    bool differ(const StateSet& a, const StateSet& b) {
        const std::optional<bool> same = space_.equal(a, b);
        known_ = known_ && same.has_value();
        return same == false;
    }

    SymbolicSpace& space_;
    const SymbolicAutomaton& automaton_;
    Pairs loops_;  // guards of the loops at each state; unknown: none
    bool known_ = true;
};

// Where accepted runs end up: standing at the end of a path, or firing for ever.
struct Recurring {
    Pairs reachable, standing, firing;
};

std::optional<Recurring> recurring(SymbolicSpace& space, Product& product) {
    Recurring found;
    found.reachable = product.reachable();
    StateSet ends = space.none();
    for (const StateSet& set : found.reachable) {
        ends = space.either(ends, set);
    }
    ends = space.both(ends, space.stuck());
    // Who stands still goes on through states that nobody got to by firings.
    found.standing = product.fair_hull(Pairs(found.reachable.size(), ends), Moves::kStand);
    for (std::size_t q = 0; q < found.reachable.size(); ++q) {
        found.standing[q] = space.both(found.standing[q], found.reachable[q]);
    }
    found.firing = product.fair_hull(found.reachable, Moves::kFire);
    product.check(found.standing);
    product.check(found.firing);
    return product.known() ? std::optional<Recurring>(std::move(found)) : std::nullopt;
}

// One run, walked marking by marking along sets of pairs.
class Walk {
 public:
    Walk(SymbolicSpace& space, const SymbolicAutomaton& automaton, std::uint32_t state)
        : space_(space), automaton_(automaton), marking_(space.net().initial), state_(state) {}

    bool at_one_of(const Pairs& pairs) const {
        return space_.contains(pairs[state_], marking_) == true;
    }
    Pairs here() {
        Pairs pairs(automaton_.states, space_.none());
        pairs[state_] = space_.singleton(marking_);
        return pairs;
    }
    // A shortest way to `targets` through `within`.
    // Gives  false if there is none or it is not known; then nothing was walked.
    bool to(const Pairs& targets, const Pairs& within, Product& product,
            std::vector<std::uint32_t>& firings) {
        std::vector<Pairs> layers{targets};
        Pairs room = within;
        while (!at_one_of(layers.back())) {
            Pairs next(automaton_.states, space_.none());
            for (const Edge& edge : automaton_.edges) {
                const StateSet more = space_.both(space_.ex(layers.back()[edge.to]),
                                                  space_.both(room[edge.from], edge.guard));
                next[edge.from] = space_.either(next[edge.from], more);
            }
            for (std::uint32_t q = 0; q < automaton_.states; ++q) {
                room[q] = space_.without(room[q], next[q]);
            }
            product.check(next);
            if (!product.known() || !product.some(next)) {
                return false;
            }
            layers.push_back(std::move(next));
        }
        for (std::size_t distance = layers.size() - 1; distance-- > 0;) {
            if (!step(layers[distance], Product::kAnyEdge, product, firings)) {
                return false;
            }
        }
        return true;
    }
    // One firing along an edge of the acceptance set into `targets`.
    bool step(const Pairs& targets, std::uint32_t set, const Product& product,
              std::vector<std::uint32_t>& firings) {
        const PlainNet& net = space_.net();
        for (std::uint32_t t = 0; t < net.transition_count(); ++t) {
            Marking next = marking_;
            if (!net.enabled(marking_, t) || !net.fire(next, t)) {
                continue;
            }
            for (const Edge& edge : automaton_.edges) {
                if (edge.from == state_ && product.belongs(edge, set) &&
                    space_.contains(edge.guard, marking_) == true &&
                    space_.contains(targets[edge.to], next) == true) {
                    marking_ = next;
                    state_ = edge.to;
                    firings.push_back(t);
                    return true;
                }
            }
        }
        return false;
    }

 private:
    SymbolicSpace& space_;
    const SymbolicAutomaton& automaton_;
    Marking marking_;
    std::uint32_t state_;
};

// From a pair of the hull: round all acceptance sets and, if possible, back. Where there is no way
// back the walk has left a strongly connected part for good, so this ends.
bool close_lasso(Walk& walk, Product& product, const SymbolicAutomaton& automaton,
                 const Pairs& hull, SymbolicLasso& lasso) {
    std::vector<Pairs> sources;
    for (std::uint32_t set = 0; set < automaton.acceptance_sets; ++set) {
        sources.push_back(product.with_edge(hull, set, Moves::kFire));
    }
    while (product.known()) {
        const Pairs start = walk.here();
        std::vector<std::uint32_t> round;
        if (sources.empty() && !walk.step(hull, Product::kAnyEdge, product, round)) {
            return false;
        }
        for (std::uint32_t set = 0; set < sources.size(); ++set) {
            if (!walk.to(sources[set], hull, product, round) ||
                !walk.step(hull, set, product, round)) {
                return false;
            }
        }
        if (walk.to(start, hull, product, round)) {
            lasso.loop = std::move(round);
            return true;
        }
        lasso.stem.insert(lasso.stem.end(), round.begin(), round.end());
    }
    return false;
}

}  // namespace

std::optional<bool> SymbolicSpace::accepts(const SymbolicAutomaton& automaton) {
    PUP_REQUIRE(automaton.acceptance_sets <= 64);
    Product product(*this, automaton);
    const std::optional<Recurring> found = recurring(*this, product);
    if (!found.has_value()) {
        return std::nullopt;
    }
    const bool any = product.some(found->standing) || product.some(found->firing);
    return product.known() ? std::optional<bool>(any) : std::nullopt;
}

std::optional<SymbolicLasso> SymbolicSpace::lasso(const SymbolicAutomaton& automaton) {
    PUP_REQUIRE(automaton.acceptance_sets <= 64);
    Product product(*this, automaton);
    const std::optional<Recurring> found = recurring(*this, product);
    if (!found.has_value()) {
        return std::nullopt;
    }
    const bool stands = product.some(found->standing);
    if (!stands && !product.some(found->firing)) {
        return std::nullopt;
    }
    const Pairs& goal = stands ? found->standing : found->firing;
    for (const std::uint32_t q : automaton.initial) {
        SymbolicLasso lasso;
        Walk walk(*this, automaton, q);
        if (walk.to(goal, found->reachable, product, lasso.stem) &&
            (stands || close_lasso(walk, product, automaton, goal, lasso))) {
            return lasso;
        }
    }
    return std::nullopt;
}

}  // namespace puppetri::proof
