// SPDX-License-Identifier: MIT
#include "puppetri/proof/supervisor.h"

#include <doctest/doctest.h>

#include <set>

#include "small_nets.h"

using namespace puppetri::proof;
using namespace puppetri::proof::test;

namespace {

std::int64_t value_of(const LinearSum& sum, const Marking& m) {
    std::int64_t value = 0;
    for (const auto& t : sum.terms) {
        value += t.factor * std::int64_t{m[t.place]};
    }
    return value;
}

// What is reachable without ever passing the limit: the least that any control has to forbid.
std::set<Marking> within_limit(const PlainNet& net, const LinearSum& sum, std::int64_t limit) {
    std::set<Marking> seen;
    std::vector<Marking> open;
    if (value_of(sum, net.initial) <= limit) {
        seen.insert(net.initial);
        open.push_back(net.initial);
    }
    while (!open.empty()) {
        const Marking m = open.back();
        open.pop_back();
        for (std::uint32_t t = 0; t < net.transition_count(); ++t) {
            Marking next = m;
            if (net.enabled(next, t) && net.fire(next, t) && value_of(sum, next) <= limit &&
                seen.insert(next).second) {
                open.push_back(next);
            }
        }
    }
    return seen;
}

LinearSum random_sum(Chance& chance, const PlainNet& net) {
    LinearSum sum;
    for (std::uint32_t p = 0; p < net.place_count(); ++p) {
        if (chance.one_in(2)) {
            sum.terms.push_back({p, chance.one_in(5) ? std::int64_t{-1} : 1 + chance.below(2)});
        }
    }
    return sum;
}

}  // namespace

TEST_CASE(
    "a supervisor forbids exactly the markings beyond the limit, if it may hold back everybody "
    "[law]") {
    Chance chance(71);
    int made = 0;
    for (int round = 0; round < 2000; ++round) {
        const PlainNet net =
            small_net(chance, {.weights = true, .reads = true, .inhibitors = true});
        const LinearSum sum = random_sum(chance, net);
        const std::int64_t limit = chance.below(4);
        const SupervisorAnswer answer = supervise(net, sum, limit);
        CHECK(answer.possible == (value_of(sum, net.initial) <= limit));
        if (!answer.possible) {
            continue;
        }
        ++made;
        std::set<Marking> seen;
        for (Marking m : whole_space(with_monitor(net, answer.place), 20000, 1000).markings) {
            CHECK(value_of(sum, m) + m.back() == limit);
            m.pop_back();
            seen.insert(m);
        }
        CHECK(seen == within_limit(net, sum, limit));
    }
    CHECK(made > 500);
}

TEST_CASE(
    "with transitions that nobody may hold back the limit holds all the same, and none of them is "
    "held back [law]") {
    Chance chance(72);
    int made = 0, strengthened = 0;
    for (int round = 0; round < 4000; ++round) {
        const PlainNet net = small_net(chance, {.weights = true});
        const LinearSum sum = random_sum(chance, net);
        const std::int64_t limit = 1 + chance.below(4);
        std::vector<std::uint8_t> outside;
        for (std::uint32_t t = 0; t < net.transition_count(); ++t) {
            outside.push_back(chance.one_in(3) ? 1 : 0);
        }
        const SupervisorAnswer answer = supervise(net, sum, limit, outside);
        if (!answer.possible) {
            CHECK_FALSE(answer.reason.empty());
            continue;
        }
        ++made;
        strengthened += answer.sum == sum ? 0 : 1;
        for (const MonitorPlace::Arc& arc : answer.place.takes) {
            CHECK(outside[arc.transition] == 0);
        }
        const Space space = whole_space(with_monitor(net, answer.place), 20000, 1000);
        for (const Marking& m : space.markings) {
            CHECK(value_of(sum, m) <= limit);
        }
    }
    CHECK(made > 500);
    CHECK(strengthened > 50);
}

TEST_CASE(
    "two philosophers freeze; the empty siphon says why, and its monitor prevents it [unit]") {
    // 0 fork, 1 fork, 2 left of ana, 3 left of rui; each takes one fork, then the other, then both
    // back.
    PlainNet net;
    net.initial = {1, 1, 0, 0};
    add_transition(net, {{0, 1}}, {{2, 1}});
    add_transition(net, {{2, 1}, {1, 1}}, {{0, 1}, {1, 1}});
    add_transition(net, {{1, 1}}, {{3, 1}});
    add_transition(net, {{3, 1}, {0, 1}}, {{0, 1}, {1, 1}});
    const Marking dead = {0, 0, 1, 1};
    const PlaceSet siphon = siphon_of_deadlock(net, dead);
    CHECK(siphon == PlaceSet{0, 1});
    const SupervisorAnswer answer = monitor_siphon(net, siphon);
    REQUIRE(answer.possible);
    CHECK(answer.place.tokens == 1);
    const PlainNet repaired = with_monitor(net, answer.place);
    const Space space = whole_space(repaired);
    for (std::uint32_t s = 0; s < space.markings.size(); ++s) {
        CHECK_FALSE(space.edges[s].empty());
    }
}
