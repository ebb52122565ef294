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

// The largest Z within `a` in which every marking may end or has a successor. Who loses its last
// successor is found among the predecessors of those who were lost before.
StateSet SymbolicSpace::eg(const StateSet& a) {
    const StateSet ends = both(a, stuck());
    StateSet hull = a, suspects = without(a, ends);
    while (empty(suspects) == false) {
        const StateSet lost = without(suspects, before(hull, suspects));
        hull = without(hull, lost);
        suspects = without(before(lost, hull), ends);
    }
    return suspects.known() ? hull : StateSet();
}

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
    if (fair.empty()) {
        return eg(a);
    }
    StateSet ends = both(a, stuck());
    for (const StateSet& f : fair) {
        ends = both(ends, f);
    }
    StateSet hull = a;
    while (hull.known()) {
        StateSet next = hull;
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

namespace {

// Nodes looked for until a shortest path is given up for any path.
constexpr std::uint64_t kShortestWork = 1u << 22;

}  // namespace

// Growing sets of markings that lead to `to`, until one holds `from`: all firings at once in each
// round (then set i holds what is at most i firings away), or one transition after the other, which
// takes far fewer rounds where firings are independent.
std::vector<SymbolicSpace::Ball> SymbolicSpace::balls_around(const StateSet& to,
                                                             std::span<const std::uint32_t> from,
                                                             const StateSet& room, bool shortest) {
    std::vector<Ball> balls{{to, kAnyTransition}};
    const std::uint32_t last = shortest ? 1 : net().transition_count();
    for (bool grown = true; grown && contains(balls.back().set, from) == false;) {
        grown = false;
        for (std::uint32_t t = 0; t < last && contains(balls.back().set, from) == false; ++t) {
            const StateSet& ball = balls.back().set;
            StateSet next = either(ball, shortest ? before(ball, room)
                                                  : wrap(tables_->saturation->step_by(
                                                        t, ball.root_, room.root_, true)));
            const std::optional<bool> same = equal(next, ball);
            if (!same.has_value()) {
                return {};
            }
            if (!*same) {
                balls.push_back({std::move(next), shortest ? kAnyTransition : t});
                grown = true;
            }
        }
    }
    return balls;
}

std::optional<std::vector<std::uint32_t>> SymbolicSpace::path(std::span<const std::uint32_t> from,
                                                              const StateSet& to,
                                                              const StateSet& within) {
    PUP_REQUIRE(from.size() == net().place_count());
    if (!ready(to) || !ready(within)) {
        return std::nullopt;
    }
    const StateSet room = either(within, singleton(from));
    tables_->store->limit_work(kShortestWork);
    std::vector<Ball> balls = balls_around(to, from, room, true);
    if (tables_->store->end_limit() && room.known()) {
        balls = balls_around(to, from, room, false);
    }
    if (balls.empty() || contains(balls.back().set, from) != true) {
        return std::nullopt;
    }
    Marking marking(from.begin(), from.end()), next;
    std::vector<std::uint32_t> firings;
    // From the first ball that holds the marking one firing leads into an earlier one.
    for (std::size_t ball = balls.size() - 1; ball > 0;) {
        if (contains(balls[ball - 1].set, marking) == true) {
            --ball;
            continue;
        }
        const std::uint32_t only = balls[ball].by;
        bool found = false;
        for (std::uint32_t t = 0; t < net().transition_count() && !found; ++t) {
            next = marking;
            found = (only == kAnyTransition || only == t) && net().enabled(marking, t) &&
                    net().fire(next, t) && contains(balls[ball - 1].set, next) == true;
            if (found) {
                firings.push_back(t);
            }
        }
        PUP_REQUIRE(found);
        marking.swap(next);
        --ball;
    }
    return firings;
}

}  // namespace puppetri::proof
