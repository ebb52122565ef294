// SPDX-License-Identifier: MIT
// Symbolic state spaces against closed forms, and what they do when the budget or the net is not
// made for them. Sets of huge spaces are told by laws that hold whatever the numbers are.
#include "puppetri/proof/symbolic.h"

#include <doctest/doctest.h>

#include "proof/classic_nets.h"

namespace puppetri::proof {
namespace {

using test::add_transition;

Natural power(std::uint32_t base, std::uint32_t exponent) {
    Natural result = 1;
    for (; exponent > 0; --exponent) {
        result *= base;
    }
    return result;
}

LinearSum sum_of(std::vector<LinearSum::Term> terms) { return {.terms = std::move(terms)}; }

TEST_CASE("philosophers and referendum have their closed forms up to 100 [oracle]") {
    for (const std::uint32_t n : {2u, 3u, 5u, 10u, 20u, 50u, 100u}) {
        CAPTURE(n);
        SymbolicSpace space(test::philosophers(n), {});
        REQUIRE(space.ended() == Ended::kDone);
        const auto facts = space.facts();
        REQUIRE(facts.has_value());
        CHECK(facts->states == power(3, n));
        Natural edges = power(3, n - 2);
        edges *= 7 * n;
        CHECK(facts->edges == edges);
        CHECK(facts->max_in_place == 1);
        CHECK(facts->max_in_marking == 2 * n);
        CHECK(facts->dead_reachable);
        CHECK(space.count(space.dead()) == Natural(2));
        CHECK(space.peak_bytes() < 100'000'000);

        SymbolicSpace vote(test::referendum(n), {});
        const auto counted = vote.facts();
        REQUIRE(counted.has_value());
        CHECK(counted->states == power(3, n) + 1);
        edges = power(3, n - 1);
        edges *= 2 * n;
        CHECK(counted->edges == edges + 1);
        CHECK(counted->max_in_marking == n);
        CHECK(vote.count(vote.dead()) == power(2, n));
    }
}

TEST_CASE("tokens that hop in a ring are counted by a binomial coefficient [oracle]") {
    // binomial(tokens + 4, 4) for five places
    for (const std::uint32_t tokens : {0u, 1u, 7u, 40u}) {
        SymbolicSpace space(test::ring(5, tokens), {});
        const std::uint64_t n = tokens;
        CHECK(space.count(space.all()) ==
              Natural((n + 4) * (n + 3) / 2 * (n + 2) / 3 * (n + 1) / 4));
        CHECK(space.max_of(sum_of({{0, 1}, {1, 1}, {2, 1}, {3, 1}, {4, 1}}), space.all()) ==
              std::int64_t{tokens});
        CHECK(space.max_of(sum_of({{0, 2}, {3, -1}}), space.all()) == 2 * std::int64_t{tokens});
        CHECK(space.min_of(sum_of({{0, 2}, {3, -1}}), space.all()) == -std::int64_t{tokens});
        CHECK(space.reversible() == true);
        CHECK(space.live(2) == (tokens > 0));
        CHECK(space.stable(3) == (tokens == 0));
    }
}

TEST_CASE("100 players pass 10 balls: each ball in one place, nobody freezes [oracle]") {
    const std::uint32_t players = 100, balls = 10;
    SymbolicSpace space(test::balls_in_a_ring(players, balls), {});
    REQUIRE(space.ended() == Ended::kDone);
    CHECK(space.count(space.all()) == Natural(173'103'094'564'400));  // 10 * binomial(100, 10)
    CHECK(space.empty(space.dead()) == true);
    for (std::uint32_t ball = 0; ball < balls; ++ball) {
        LinearSum holders;
        for (std::uint32_t p = 0; p < players; ++p) {
            holders.terms.push_back({ball * players + p, 1});
        }
        CHECK(space.min_of(holders, space.all()) == 1);
        CHECK(space.max_of(holders, space.all()) == 1);
    }
    for (std::uint32_t p = 0; p < players; p += 9) {
        std::vector<std::uint32_t> passes;  // of player p, in the order of the net's making
        for (std::uint32_t ball = 0; ball < balls; ++ball) {
            passes.push_back(ball * players + p);
        }
        const StateSet moves = space.satisfying(Predicate::enabled(passes));
        CHECK(space.equal(space.ef(moves), space.all()) == true);
    }
}

TEST_CASE("an empty net has one marking, a net without arcs as many edges as transitions [unit]") {
    SymbolicSpace nothing(PlainNet{}, {});
    CHECK(nothing.count(nothing.all()) == Natural(1));
    CHECK(nothing.count(nothing.dead()) == Natural(1));
    CHECK(nothing.holds_initially(nothing.eg(nothing.all())) == true);
    PlainNet loops;
    add_transition(loops, {}, {});
    add_transition(loops, {}, {});
    SymbolicSpace idle(loops, {});
    CHECK(idle.count(idle.all()) == Natural(1));
    CHECK(idle.edges(idle.all()) == Natural(2));
    CHECK(idle.empty(idle.dead()) == true);
    CHECK(idle.holds_initially(idle.ex(idle.all())) == true);
}

TEST_CASE("an unbounded net ends with its budget, and then nothing is claimed of it [unit]") {
    PlainNet net;
    net.initial = {0};
    add_transition(net, {}, {{0, 1}});
    Budget budget;
    budget.seconds = 0.3;
    budget.bytes = std::uint64_t{64} << 20;
    SymbolicSpace space(net, budget);
    CHECK(space.ended() != Ended::kDone);
    CHECK(space.peak_bytes() < budget.bytes * 2);
    CHECK_FALSE(space.all().known());
    CHECK_FALSE(space.none().known());
    CHECK_FALSE(space.count(space.all()).has_value());
    CHECK_FALSE(space.facts().has_value());
    CHECK_FALSE(space.empty(space.ag(space.all())).has_value());
    CHECK_FALSE(space.live(0).has_value());
    CHECK_FALSE(space.path_to(space.dead()).has_value());
}

TEST_CASE("a count beyond 2^31 is not wrapped: the space is unbounded [unit]") {
    PlainNet net;
    net.initial = {1};
    add_transition(net, {{0, 1}}, {{0, 1'000'000'000}});
    SymbolicSpace space(net, {});
    CHECK(space.ended() == Ended::kUnbounded);
    CHECK_FALSE(space.count(space.all()).has_value());
}

TEST_CASE("levels of priority are refused, not ignored [unit]") {
    PlainNet net = test::philosophers(3);
    net.has_levels = true;
    SymbolicSpace space(net, {});
    CHECK_FALSE(space.supported());
    CHECK_FALSE(space.all().known());
}

TEST_CASE(
    "little memory gives the right count or none, and never passes its budget by much [law]") {
    const PlainNet net = test::ring(9, 14);
    std::uint32_t known = 0;
    for (std::uint64_t bytes = 1 << 20; bytes <= std::uint64_t{64} << 20; bytes *= 2) {
        CAPTURE(bytes);
        Budget budget;
        budget.bytes = bytes;
        SymbolicSpace space(net, budget);
        CHECK(space.peak_bytes() <= bytes + (2u << 20));
        const auto states = space.count(space.all());
        if (states.has_value()) {
            ++known;
            CHECK(*states == Natural(319770));  // binomial(22, 8)
            const auto later = space.count(space.ex(space.ex(space.all())));
            CHECK((!later.has_value() || *later == Natural(319770)));
        } else {
            CHECK(space.ended() == Ended::kMemory);
        }
    }
    CHECK(known > 0);
}

TEST_CASE(
    "sets made in little memory, swept while they are made, are the right ones or unknown "
    "[agree]") {
    const auto results = [](SymbolicSpace& space) {
        const auto at_least = [&](std::vector<LinearSum::Term> terms, std::int64_t limit) {
            return space.satisfying(Predicate::at_least(sum_of(std::move(terms)), limit));
        };
        std::vector<LinearSum::Term> spread;
        for (std::uint32_t p = 0; p < space.net().place_count(); ++p) {
            spread.push_back({p, static_cast<std::int64_t>(p * 7 % 5) - 2});
        }
        const StateSet a = at_least(spread, 1), b = at_least({{0, 1}, {1, 1}}, 1);
        const StateSet fair[] = {a, b};
        std::vector<std::optional<Natural>> counts;
        for (const StateSet& set :
             {a, space.eg(a), space.eu(a, b), space.ex(space.ex(a)), space.au(b, a),
              space.ag(space.ef(space.complement(a))), space.fair_eg(space.all(), fair),
              space.successors(a), space.reached(space.initial(), b)}) {
            counts.push_back(space.count(set));
        }
        return counts;
    };
    std::uint32_t known = 0, unknown = 0;
    for (const PlainNet& net : {test::philosophers(9), test::ring(6, 7)}) {
        SymbolicSpace roomy(net, {});
        const auto wanted = results(roomy);
        for (std::uint64_t bytes = 1'100'000; bytes < 12'000'000; bytes += bytes / 5) {
            CAPTURE(bytes);
            Budget budget;
            budget.bytes = bytes;
            SymbolicSpace space(net, budget);
            const auto found = results(space);
            for (std::size_t i = 0; i < wanted.size(); ++i) {
                REQUIRE(wanted[i].has_value());
                CHECK((!found[i].has_value() || *found[i] == *wanted[i]));
                ++(found[i].has_value() ? known : unknown);
            }
        }
    }
    CHECK(known > 50);
    CHECK(unknown > 0);
}

TEST_CASE("a cancelled or timed out operation leaves its set unknown until the budget is renewed") {
    SymbolicSpace space(test::philosophers(12), {});
    REQUIRE(space.ended() == Ended::kDone);
    const StateSet all = space.all();
    const std::atomic<bool> cancelled = true;
    Budget budget;
    budget.cancelled = &cancelled;
    space.renew(budget);
    const StateSet eating = space.satisfying(Predicate::at_least(sum_of({{48, 1}, {51, 1}}), 1));
    const StateSet never = space.eg(space.complement(eating));
    CHECK_FALSE(never.known());
    CHECK(space.ended() == Ended::kCancelled);
    CHECK_FALSE(space.count(never).has_value());
    CHECK_FALSE(space.both(never, all).known());
    CHECK_FALSE(space.contains(never, space.net().initial).has_value());
    CHECK(space.count(all) == power(3, 12));  // what is known stays known
    space.renew({});
    CHECK(space.eg(space.all()).known());
}

TEST_CASE("laws of sets and paths hold on 3^20 markings [law]") {
    const std::uint32_t n = 20;
    SymbolicSpace space(test::philosophers(n), {});
    const StateSet all = space.all(), dead = space.dead();
    const StateSet eats = space.satisfying(Predicate::at_least(sum_of({{4 * n, 1}}), 1));
    const StateSet thinks = space.satisfying(Predicate::at_least(sum_of({{0, 1}}), 1));
    // One philosopher's forks decide what he does: eats with both, thinks with none of them.
    CHECK(space.count(eats) == power(3, n - 2));
    Natural four = power(3, n - 2);
    four *= 4;
    CHECK(space.count(thinks) == four);
    CHECK(space.equal(space.complement(space.complement(eats)), eats) == true);
    CHECK(space.equal(space.either(space.both(eats, thinks), space.without(eats, thinks)), eats) ==
          true);
    // Somebody can always eat unless all are stuck; everything but the dead leads back.
    CHECK(space.equal(space.ef(eats), space.complement(dead)) == true);
    CHECK(space.equal(space.complement(space.ex(all)), dead) == true);
    CHECK(space.equal(space.ef(space.initial()), space.complement(dead)) == true);
    CHECK(space.reversible() == false);
    CHECK(space.live(0) == false);
    CHECK(space.quasi_live(0) == true);
    CHECK(space.stable(0) == false);
    // Expansion laws.
    const StateSet eg = space.eg(thinks);
    CHECK(space.equal(eg, space.both(thinks, space.either(space.ex(eg), dead))) == true);
    const StateSet eu = space.eu(thinks, eats);
    CHECK(space.equal(eu, space.either(eats, space.both(thinks, space.ex(eu)))) == true);
    const StateSet au = space.au(thinks, eats);
    CHECK(space.equal(au, space.either(eats, space.both(thinks, space.without(space.ax(au),
                                                                              dead)))) == true);
    CHECK(space.equal(space.af(eats), space.au(all, eats)) == true);
    // The nearest dead marking is n firings away.
    const auto path = space.path_to(dead);
    REQUIRE(path.has_value());
    CHECK(path->size() == n);
    Marking marking = space.net().initial;
    for (const std::uint32_t t : *path) {
        REQUIRE(space.net().enabled(marking, t));
        space.net().fire(marking, t);
    }
    CHECK(space.contains(dead, marking) == true);
}

TEST_CASE("an automaton over 3^20 markings: what recurs, what may starve [oracle]") {
    const std::uint32_t n = 20;
    SymbolicSpace space(test::philosophers(n), {});
    const StateSet eats = space.satisfying(Predicate::at_least(sum_of({{4 * n, 1}}), 1));
    const auto forever_often = [](const StateSet& often, const StateSet& forever) {
        // F G forever and G F often: leave state 0 at a guess, then stay.
        SymbolicAutomaton a;
        a.states = 2;
        a.acceptance_sets = 1;
        a.initial = {0};
        return std::pair(a, std::vector{often, forever});
    };
    const auto build = [&](const StateSet& often, const StateSet& forever) {
        auto [a, sets] = forever_often(often, forever);
        a.edges = {{0, 0, space.all(), 0},
                   {0, 1, space.all(), 0},
                   {1, 1, sets[1], 0},
                   {1, 1, space.both(sets[0], sets[1]), 1}};
        return a;
    };
    const StateSet all = space.all(), none = space.none(), dead = space.dead();
    CHECK(space.accepts(build(eats, all)) == true);
    CHECK(space.accepts(build(eats, space.complement(eats))) == false);
    CHECK(space.accepts(build(all, space.complement(eats))) == true);
    CHECK(space.accepts(build(all, none)) == false);
    CHECK(space.accepts(build(dead, all)) == true);  // a path that ends stands for ever
    CHECK(space.accepts(build(dead, eats)) == false);
    SymbolicAutomaton unknown = build(eats, all);
    unknown.edges[1].guard = StateSet();
    CHECK_FALSE(space.accepts(unknown).has_value());
}

}  // namespace
}  // namespace puppetri::proof
