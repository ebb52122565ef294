// SPDX-License-Identifier: MIT
// State classes: dense time against closed forms, and paths that become runs.
#include "puppetri/proof/state_classes.h"

#include <doctest/doctest.h>

#include <algorithm>

#include "net/reference_nets.h"
#include "puppetri/proof/timed_exact.h"

using namespace puppetri;
using namespace puppetri::proof;
using net::Formula;
using net::Maker;

namespace {

const Budget kBudget;
constexpr std::int64_t kMs = kTicksPerMillisecond;

TEST_CASE("with single durations classes are the exact states [agree]") {
    for (const net::Net& net : {net::walk_net(3), net::walk_net(4), net::ball_game_maker().net()}) {
        const TimedGraph timed = timed_exact_graph({.net = net, .budget = kBudget});
        const TimedGraph classes = class_graph({.net = net, .budget = kBudget});
        CHECK(classes.graph.size() == timed.graph.size());
        CHECK(classes.graph.edges.items.size() == timed.graph.edges.items.size());
        CHECK(classes.graph.exact);
        CHECK(classes.graph.over);
        for (std::uint32_t s = 0; s < classes.graph.size(); ++s) {
            std::string trouble;
            CHECK_MESSAGE(classes.script(classes.path_to(s), &trouble).has_value(), trouble);
        }
    }
}

TEST_CASE(
    "two tokens race: the one of 1 .. 3 ms may win, tie with and lose to that of 2 .. 4 ms "
    "[oracle]") {
    Maker m;
    m.place("A", 1, net::between(1 * kMs, 3 * kMs));
    m.place("B", 1, net::between(2 * kMs, 4 * kMs));
    m.t("a", {"A", "unless ready B"}, {"Afirst"});
    m.t("b", {"B", "unless ready A"}, {"Bfirst"});
    m.t("both", {"A", "B"}, {"Both"});
    const net::Net net = m.net();
    const std::vector<Formula> atoms = {Formula::marked(m.p("Afirst")),
                                        Formula::marked(m.p("Bfirst")),
                                        Formula::marked(m.p("Both"))};
    const TimedGraph g = class_graph({.net = net, .atoms = atoms, .budget = kBudget});
    for (std::uint32_t a = 0; a < 3; ++a) {
        std::uint32_t found = 0;
        for (std::uint32_t s = 0; s < g.graph.size(); ++s) {
            if (g.graph.atoms.must_hold(s, a)) {
                ++found;
                std::string trouble;
                const auto script = g.script(g.path_to(s), &trouble);
                CHECK_MESSAGE(script.has_value(), trouble);
            }
        }
        CHECK(found > 0);
    }
    // A never wins when it lasts longer than B in every case.
    m.place("A").duration = net::between(5 * kMs, 6 * kMs);
    const net::Net late = m.net();
    const TimedGraph h = class_graph({.net = late, .atoms = atoms, .budget = kBudget});
    for (std::uint32_t s = 0; s < h.graph.size(); ++s) {
        CHECK_FALSE(h.graph.atoms.may_hold(s, 2));
    }
}

// Of the quickest or the slowest run, until the place has a token.
std::int64_t time_until(const net::Net& net, net::PlaceIndex place, bool quickest) {
    const Formula atoms[] = {Formula::marked(place)};
    const MomentTest marked{.may_hold = [](const void*, const std::uint64_t* may,
                                           const std::uint64_t*,
                                           std::uint32_t) { return (*may & 1) != 0; }};
    const auto e = extreme_time({.net = net, .atoms = atoms, .budget = kBudget}, marked, quickest);
    REQUIRE(e.has_value());
    CHECK(e->ended == Ended::kDone);
    CHECK(e->reached);
    return e->ticks;
}

TEST_CASE("a chain of three takes the sum of its ends [law]") {
    Maker m;
    m.place("A", 1, net::between(1 * kMs, 3 * kMs));
    m.place("B", 0, net::between(2 * kMs, 5 * kMs));
    m.place("C", 0, net::between(4 * kMs, 4 * kMs));
    m.t("ab", {"A"}, {"B"});
    m.t("bc", {"B"}, {"C"});
    m.t("cd", {"C"}, {"D"});
    const net::Net net = m.net();
    CHECK(time_until(net, m.p("D"), true) == 7 * kMs);
    CHECK(time_until(net, m.p("D"), false) == 12 * kMs);
}

TEST_CASE("waiting for both of two takes the later of each end [law]") {
    Maker m;
    m.place("A", 1, net::between(1 * kMs, 9 * kMs));
    m.place("B", 1, net::between(3 * kMs, 5 * kMs));
    m.t("both", {"A", "B"}, {"D"});
    const net::Net net = m.net();
    CHECK(time_until(net, m.p("D"), true) == 3 * kMs);
    CHECK(time_until(net, m.p("D"), false) == 9 * kMs);
}

TEST_CASE("a loop that may be left or not has a shortest time and no longest [law]") {
    Maker m;
    m.place("A", 1, net::between(2 * kMs, 3 * kMs));
    m.t("again", {"A"}, {"A"});
    m.t("out", {"A"}, {"D"});
    const net::Net net = m.net();
    CHECK(time_until(net, m.p("D"), true) == 2 * kMs);
    const Formula atoms[] = {Formula::marked(m.p("D"))};
    const TimedGraph g = class_graph({.net = net, .atoms = atoms, .budget = kBudget});
    CHECK(time_to_reach(g.graph, states_where_atom_must(g.graph, 0)).avoidable);
}

TEST_CASE(
    "two exponential durations that end at one instant are a coincidence, and said so "
    "[unit]") {
    Maker m;
    m.place("A", 1, net::exponential(1));
    m.place("B", 1, net::exponential(2));
    m.t("both", {"A", "B"}, {"Both"}).priority = 2;
    m.t("a", {"A"}, {});
    m.t("b", {"B"}, {});
    const net::Net net = m.net();
    const TimedGraph g = class_graph({.net = net, .budget = kBudget});
    const net::PlaceIndex both = net.find_place("Both");
    for (std::uint32_t s = 0; s < g.graph.size(); ++s) {
        if (g.tokens(s, both).total == 1) {
            const auto path = g.path_to(s);
            // Either both begin ready, within half a tick, or they end together.
            const bool at_once = g.graph.edges.items[path[0]].target != s && path.size() == 2;
            const bool lucky = std::any_of(path.begin(), path.end(),
                                           [&](std::uint32_t e) { return g.coincidental[e] != 0; });
            CHECK((lucky || at_once));
        }
    }
    for (std::uint32_t e = 0; e < g.graph.edges.items.size(); ++e) {
        CHECK((g.coincidental[e] == 0 || g.graph.edges.items[e].label == Edge::kPass));
    }
}

TEST_CASE("a zone is closed whichever way its bounds come [law]") {
    Maker m;
    // Three that wait; the middle one's bounds follow from the others' when all end in order.
    m.place("A", 1, net::between(500, 2000));
    m.place("B", 2, net::between(1000, 1000));
    m.t("x", {"A", "3*B"}, {});
    const net::Net net = m.net();
    const TimedGraph g = class_graph({.net = net, .budget = kBudget});
    // A first, with both, or after them; two equal ones never part.
    CHECK(g.graph.edges.row(g.graph.initial).size() == 3);
    for (std::uint32_t e = g.graph.edges.starts[0]; e < g.graph.edges.starts[1]; ++e) {
        CHECK(g.graph.high_ticks[e] <= 1000);
    }
}

}  // namespace
