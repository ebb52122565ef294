// SPDX-License-Identifier: MIT
// What can follow what: CTL over sets, shortest paths, rules over all markings.
#include <algorithm>

#include "puppetri/base/require.h"
#include "puppetri/proof/symbolic.h"
#include "symbolic_tables.h"

namespace puppetri::proof {

StateSet SymbolicSpace::before(const StateSet& a, const StateSet& within) {
    return ready(a) && ready(within) ? wrap(tables_->saturation->step(a.root_, within.root_, true))
                                     : StateSet();
}

StateSet SymbolicSpace::after(const StateSet& a, const StateSet& within) {
    return ready(a) && ready(within) ? wrap(tables_->saturation->step(a.root_, within.root_, false))
                                     : StateSet();
}

StateSet SymbolicSpace::ex(const StateSet& a) { return before(a, all()); }

StateSet SymbolicSpace::successors(const StateSet& a) { return after(a, all()); }

StateSet SymbolicSpace::eu(const StateSet& hold, const StateSet& until) {
    return ready(hold) && ready(until)
               ? wrap(tables_->saturation->closure(until.root_, hold.root_, true))
               : StateSet();
}

StateSet SymbolicSpace::reached(const StateSet& from, const StateSet& within) {
    return ready(from) && ready(within)
               ? wrap(tables_->saturation->closure(from.root_, within.root_, false))
               : StateSet();
}

StateSet SymbolicSpace::eg(const StateSet& a) { return fair_eg(a, {}); }

// E[hold U until] fails for all paths exactly where some path reaches, before any `until`, a
// marking that is neither, or never reaches `until` at all.
StateSet SymbolicSpace::au(const StateSet& hold, const StateSet& until) {
    const StateSet not_until = complement(until);
    return complement(either(eu(not_until, without(not_until, hold)), eg(not_until)));
}

// Markings with an infinite path in `a` that meets each fair set again and again: the largest Z in
// which every marking gets, by at least one firing within Z, to each of the sets in Z. Ended paths
// are added as what leads to their ends.
StateSet SymbolicSpace::fair_eg(const StateSet& a, std::span<const StateSet> fair) {
    StateSet ends = both(a, stuck());
    for (const StateSet& f : fair) {
        ends = both(ends, f);
    }
    StateSet hull = a;
    while (hull.known()) {
        StateSet next = fair.empty() ? before(hull, hull) : hull;
        for (const StateSet& f : fair) {
            next = before(eu(next, both(next, f)), next);
        }
        if (!next.known() || next.root_ == hull.root_) {
            hull = next;
            break;
        }
        hull = next;
    }
    return either(hull, eu(a, ends));
}

std::optional<bool> SymbolicSpace::live(std::uint32_t transition) {
    return equal(ef(enabled(transition, all())), all());
}

std::optional<bool> SymbolicSpace::quasi_live(std::uint32_t transition) {
    const std::optional<bool> never = empty(enabled(transition, all()));
    return never.has_value() ? std::optional<bool>(!*never) : std::nullopt;
}

std::optional<bool> SymbolicSpace::stable(std::uint32_t place) {
    PUP_REQUIRE(place < net().place_count());
    const LinearSum sum{.terms = {{place, 1}}};
    const auto least = min_of(sum, all()), most = max_of(sum, all());
    return least.has_value() && most.has_value() ? std::optional<bool>(*least == *most)
                                                 : std::nullopt;
}

std::optional<bool> SymbolicSpace::reversible() { return equal(ef(initial()), all()); }

std::optional<std::vector<std::uint32_t>> SymbolicSpace::path(std::span<const std::uint32_t> from,
                                                              const StateSet& to,
                                                              const StateSet& within) {
    PUP_REQUIRE(from.size() == net().place_count());
    if (!ready(to) || !ready(within)) {
        return std::nullopt;
    }
    StateSet room = without(either(within, singleton(from)), to);
    std::vector<StateSet> layers{to};  // layers[i]: i firings away
    while (contains(layers.back(), from) == false) {
        layers.push_back(before(layers.back(), room));
        room = without(room, layers.back());
        if (empty(layers.back()) != false) {
            return std::nullopt;  // none, or not known
        }
    }
    if (!layers.back().known()) {
        return std::nullopt;
    }
    Marking marking(from.begin(), from.end()), next;
    std::vector<std::uint32_t> firings;
    for (std::size_t distance = layers.size() - 1; distance-- > 0;) {
        for (std::uint32_t t = 0; t < net().transition_count(); ++t) {
            next = marking;
            if (net().enabled(marking, t) && net().fire(next, t) &&
                contains(layers[distance], next) == true) {
                firings.push_back(t);
                marking.swap(next);
                break;
            }
        }
    }
    PUP_REQUIRE(firings.size() == layers.size() - 1);
    return firings;
}

}  // namespace puppetri::proof
