// SPDX-License-Identifier: MIT
#include "puppetri/proof/state_equation.h"

#include <doctest/doctest.h>

#include "small_nets.h"

using namespace puppetri::proof;
using namespace puppetri::proof::test;

namespace {

bool invariant_holds(const Invariant& i, const Marking& m) {
    std::int64_t value = 0;
    for (const LinearSum::Term& t : i.sum.terms) {
        value += t.factor * std::int64_t{m[t.place]};
    }
    return i.kind == Invariant::kEqual    ? value == i.limit
           : i.kind == Invariant::kAtMost ? value <= i.limit
                                          : value >= i.limit;
}

}  // namespace

TEST_CASE(
    "what the state equation calls impossible is reachable in no net, and its invariants hold "
    "everywhere [law]") {
    Chance chance(21);
    int impossible = 0, possible = 0, candidates_reached = 0;
    for (int round = 0; round < 6000; ++round) {
        const PlainNet net = small_net(chance, {.places = 5,
                                                .transitions = 5,
                                                .weights = round % 3 == 0,
                                                .reads = round % 2 == 0,
                                                .inhibitors = round % 4 == 0,
                                                .conservative = round % 5 != 0});
        const Predicate predicate =
            round % 7 == 0 ? Predicate::no_successor(net) : small_predicate(chance, net);
        CAPTURE(text(net));
        const Space space = whole_space(net, 2000);
        const bool reached = std::any_of(space.markings.begin(), space.markings.end(),
                                         [&](const Marking& m) { return predicate.holds(net, m); });
        StateEquationOptions options;
        options.integers = round % 2 == 0;
        options.traps = round % 3 != 1;
        const StateEquationAnswer answer = solve_state_equation(net, predicate, {}, options);
        if (answer.kind == StateEquationAnswer::kImpossible) {
            ++impossible;
            CHECK_FALSE(reached);
            for (const Invariant& i : answer.used) {
                for (const Marking& m : space.markings) {
                    CHECK(invariant_holds(i, m));
                }
            }
        } else {
            possible += reached ? 1 : 0;
            if (answer.kind == StateEquationAnswer::kCandidate && options.integers) {
                REQUIRE(answer.marking.size() == net.place_count());
                CHECK(predicate.holds(net, answer.marking));
                candidates_reached += space.number.count(answer.marking) != 0 ? 1 : 0;
            }
        }
    }
    CHECK(impossible > 1000);
    CHECK(possible > 1000);
    CHECK(candidates_reached > 1000);
}

TEST_CASE("upper bounds of sums hold in every reachable marking [law]") {
    Chance chance(22);
    int tight = 0;
    for (int round = 0; round < 2000; ++round) {
        const PlainNet net =
            small_net(chance, {.weights = true, .reads = true, .inhibitors = true});
        LinearSum sum;
        for (std::uint32_t p = 0; p < net.place_count(); ++p) {
            if (chance.one_in(2)) {
                sum.terms.push_back({p, 1 + chance.below(2)});
            }
        }
        const auto bound = upper_bound(net, sum, {});
        if (!bound) {
            continue;
        }
        std::int64_t most = 0;
        for (const Marking& m : whole_space(net).markings) {
            std::int64_t value = 0;
            for (const auto& t : sum.terms) {
                value += t.factor * m[t.place];
            }
            most = std::max(most, value);
        }
        CHECK(most <= *bound);
        tight += most == *bound ? 1 : 0;
    }
    CHECK(tight > 1000);
}

TEST_CASE("a mutex is proved by the invariant that a lock gives, and told by names [unit]") {
    // 0 idle_a, 1 in_a, 2 idle_b, 3 in_b, 4 lock
    PlainNet net;
    net.initial = {1, 0, 1, 0, 1};
    add_transition(net, {{0, 1}, {4, 1}}, {{1, 1}});
    add_transition(net, {{1, 1}}, {{0, 1}, {4, 1}});
    add_transition(net, {{2, 1}, {4, 1}}, {{3, 1}});
    add_transition(net, {{3, 1}}, {{2, 1}, {4, 1}});
    const Predicate both = Predicate::all_of(std::vector<Predicate>{
        Predicate::at_least({{{1, 1}}}, 1), Predicate::at_least({{{3, 1}}}, 1)});
    const auto used = prove_by_invariants(net, both, {});
    REQUIRE(used);
    REQUIRE(used->size() == 1);
    const std::vector<std::string_view> names = {"idle_a", "in_a", "idle_b", "in_b", "lock"};
    CHECK(text(used->front(), names) == "in_a + in_b + lock = 1");
    // Of a lock that an arc may empty nothing is known.
    CHECK_FALSE(prove_by_invariants(net, both, {}, std::vector<std::uint8_t>{0, 0, 0, 0, 1}));
}

TEST_CASE("a trap excludes what the state equation alone allows [unit]") {
    // The token can leave neither p nor q, but firing counts alone do not see that r takes both.
    PlainNet net;
    net.initial = {1, 0};
    add_transition(net, {{0, 1}}, {{0, 1}, {1, 1}});
    add_transition(net, {{1, 1}, {0, 1}}, {{1, 1}});
    const Predicate none = Predicate::all_of(std::vector<Predicate>{
        Predicate::at_most({{{0, 1}}}, 0), Predicate::at_most({{{1, 1}}}, 0)});
    StateEquationOptions without;
    without.traps = false;
    CHECK(solve_state_equation(net, none, {}, without).kind == StateEquationAnswer::kCandidate);
    const StateEquationAnswer with = solve_state_equation(net, none, {});
    CHECK(with.kind == StateEquationAnswer::kImpossible);
    REQUIRE_FALSE(with.used.empty());
    CHECK(with.used.front().trap);
}

TEST_CASE("a budget that is used up makes the answer unknown [unit]") {
    Chance chance(5);
    const PlainNet net = small_net(chance, {});
    StateEquationOptions none;
    none.cases = 0;
    CHECK(solve_state_equation(net, Predicate::no_successor(net), {.seconds = 0}, none).kind !=
          StateEquationAnswer::kCandidate);
}
