// SPDX-License-Identifier: MIT
// All behaviours with exact time, against the reference nets and against runs of the engine.
#include "puppetri/proof/timed_exact.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <limits>

#include "net/reference_nets.h"
#include "puppetri/proof/readiness.h"
#include "puppetri/proof/state_classes.h"

using namespace puppetri;
using namespace puppetri::proof;
using net::Formula;
using net::Maker;

namespace {

const Budget kBudget;

TEST_CASE("the walk of three steps has 11 states, with exact time and without [oracle]") {
    const net::Net net = net::walk_net(3);
    const TimedGraph timed = timed_exact_graph({.net = net, .budget = kBudget});
    const TimedGraph ready = readiness_graph({.net = net, .budget = kBudget});
    CHECK(timed.graph.size() == 11);
    CHECK(ready.graph.size() == 11);
    CHECK(timed.graph.exact);
    CHECK(timed.graph.over);
    CHECK(ready.graph.over);
    CHECK_FALSE(ready.graph.exact);
    // It ends in P5 and P9, which is declared.
    for (const TimedGraph* g : {&timed, &ready}) {
        for (std::uint32_t s = 0; s < 11; ++s) {
            CHECK(g->graph.dead(s) == (g->words(s) == "P5, P9"));
            CHECK(g->graph.dead(s) == ((g->graph.flags[s] & Graph::kFinal) != 0));
        }
    }
    CHECK(ready.words(3) == "P4 (not ready), 2 P3");
    CHECK(timed.words(5) == "P6 (not ready: 0.8333333333333334 s), 3 P3");
}

TEST_CASE("every shortest path of the ball game is a script that the engine plays [witness]") {
    const net::Net net = net::ball_game_maker().net();
    const TimedGraph timed = timed_exact_graph({.net = net, .budget = kBudget});
    CHECK(timed.graph.exact);
    for (std::uint32_t s = 0; s < timed.graph.size(); ++s) {
        std::string trouble;
        CHECK_MESSAGE(timed.script(timed.path_to(s), &trouble).has_value(), trouble);
        CHECK_FALSE(timed.graph.dead(s));
    }
}

std::uint32_t edges_labelled(const TimedGraph& g, std::uint32_t label) {
    return static_cast<std::uint32_t>(
        std::count_if(g.graph.edges.items.begin(), g.graph.edges.items.end(),
                      [label](const Edge& e) { return e.label == label; }));
}

TEST_CASE("a walk of k steps takes 20 k frames, the shortest and the longest way [law]") {
    for (int k = 1; k <= 5; ++k) {
        const net::Net net = net::walk_net(k);
        const Formula atoms[] = {Formula::marked(net.find_place("P9"))};
        const TimedGraph g = timed_exact_graph({.net = net, .atoms = atoms, .budget = kBudget});
        const TimeToReach t = time_to_reach(g.graph, states_where_atom_must(g.graph, 0));
        CHECK(t.reachable);
        CHECK_FALSE(t.avoidable);
        CHECK(t.shortest == net::seconds(20.0 / 24 * k).ticks);
        CHECK(t.longest == t.shortest);
        CHECK(g.script(t.shortest_path).has_value());
    }
}

// Every way into one of these states is a visit.
std::vector<std::uint8_t> edges_into(const Graph& g, const StateBits& states) {
    std::vector<std::uint8_t> edges;
    for (const Edge& e : g.edges.items) {
        edges.push_back(states[e.target] ? 1 : 0);
    }
    return edges;
}

double seconds_of(const Round& round) {
    return SimTime{round.ticks}.seconds() / static_cast<double>(round.visits);
}

TEST_CASE("a round of the ball game takes as long as its slowest player, by hand [oracle]") {
    // From log to log by hand: the ball is thrown and caught once per 6 s; both players move on
    // in the same rhythm, so the least and the greatest are the same.
    const net::Net net = net::ball_game_maker().net();
    const Formula atoms[] = {Formula::ready(net.find_place("P8"))};
    const TimedGraph g = timed_exact_graph({.net = net, .atoms = atoms, .budget = kBudget});
    const auto c = cycle_time(g.graph, edges_into(g.graph, states_where_atom_must(g.graph, 0)));
    REQUIRE(c.has_value());
    REQUIRE(c->greatest.has_value());
    // Each visit lasts one state: nobody ties with t8, so it fires at once.
    net::RandomChooser random;
    net::Engine engine(net, random);
    engine.start();
    std::vector<std::int64_t> rounds;
    while (rounds.size() < 6) {
        REQUIRE(engine.step() == net::Engine::Outcome::kFired);
        if (engine.state().last == net.find_transition("t8").value) {
            rounds.push_back(engine.state().now);
        }
    }
    const double round = SimTime{rounds[5] - rounds[4]}.seconds();
    CHECK(seconds_of(c->least) == doctest::Approx(round));
    CHECK(seconds_of(*c->greatest) == doctest::Approx(round));
}

TEST_CASE(
    "of two loops the cycle time says the shorter and the longer, and whether visits may "
    "cease [law]") {
    Maker m;
    m.place("A", 1, net::lasts(1));
    m.place("B", 0, net::lasts(4));
    m.place("C", 0, net::lasts(2));
    m.t("ab", {"A"}, {"B"});
    m.t("ac", {"A"}, {"C"});
    m.t("ba", {"B"}, {"A"});
    m.t("ca", {"C"}, {"A"});
    const Formula atoms[] = {Formula::ready(m.p("A")), Formula::ready(m.p("B"))};
    const net::Net net = m.net();
    const TimedGraph g = timed_exact_graph({.net = net, .atoms = atoms, .budget = kBudget});
    const auto a = cycle_time(g.graph, edges_into(g.graph, states_where_atom_must(g.graph, 0)));
    REQUIRE(a.has_value());
    REQUIRE(a->greatest.has_value());
    CHECK(seconds_of(a->least) == 3);
    CHECK(seconds_of(*a->greatest) == 5);
    const auto b = cycle_time(g.graph, edges_into(g.graph, states_where_atom_must(g.graph, 1)));
    REQUIRE(b.has_value());
    CHECK(seconds_of(b->least) == 5);
    CHECK_FALSE(b->greatest.has_value());
    // B can be avoided for ever, and be reached within 1 s.
    const TimeToReach t = time_to_reach(g.graph, states_where_atom_must(g.graph, 1));
    CHECK(t.reachable);
    CHECK(t.avoidable);
    CHECK(t.shortest == net::seconds(5).ticks);
}

TEST_CASE("a lower priority fires because the higher one's token is not ready [oracle]") {
    Maker m;
    m.place("P", 1);
    m.place("Q", 1, net::lasts(1));
    m.t("high", {"P", "Q"}, {"H"}).priority = 5;
    m.t("low", {"P"}, {"L"});
    const Formula atoms[] = {Formula::marked(m.p("H")), Formula::marked(m.p("L"))};
    const net::Net net = m.net();
    for (const bool exact : {true, false}) {
        const GraphRequest request{.net = net, .atoms = atoms, .budget = kBudget};
        const TimedGraph g = exact ? timed_exact_graph(request) : readiness_graph(request);
        CHECK(states_where_atom_may(g.graph, 0).empty());  // `high` is always too late
        CHECK_FALSE(states_where_atom_must(g.graph, 1).empty());
    }
}

TEST_CASE(
    "an untimed counterexample that no timed run has: only exact time knows who comes first "
    "[oracle]") {
    Maker m;
    m.place("A", 1, net::lasts(1));
    m.place("B", 1, net::lasts(2));
    m.t("a", {"A"}, {"Adone"});
    m.t("b", {"B", "unless Adone"}, {"Bfirst"});
    const Formula atoms[] = {Formula::marked(m.p("Bfirst"))};
    const net::Net net = m.net();
    const GraphRequest request{.net = net, .atoms = atoms, .budget = kBudget};
    CHECK_FALSE(states_where_atom_may(readiness_graph(request).graph, 0).empty());
    CHECK(states_where_atom_may(timed_exact_graph(request).graph, 0).empty());
}

TEST_CASE("an inhibitor sees tokens that are not ready, `unless ready` does not [oracle]") {
    for (const bool ready : {false, true}) {
        Maker m;
        m.place("A", 1);
        m.place("B", 1, net::lasts(2));
        m.t("a", {"A", ready ? "unless ready B" : "unless B"}, {"C"});
        const Formula atoms[] = {Formula::marked(m.p("C"))};
        const net::Net net = m.net();
        const GraphRequest request{.net = net, .atoms = atoms, .budget = kBudget};
        CHECK(states_where_atom_may(readiness_graph(request).graph, 0).empty() != ready);
        CHECK(states_where_atom_may(timed_exact_graph(request).graph, 0).empty() != ready);
    }
}

TEST_CASE("exact coincidence: two that take equally long meet, two that do not never do [oracle]") {
    for (const double b : {2.0, 2.5}) {
        Maker m;
        m.place("A", 1, net::lasts(2));
        m.place("B", 1, net::lasts(b));
        m.t("both", {"A", "B"}, {"Both"}).priority = 2;
        m.t("a", {"A"}, {});
        m.t("b", {"B"}, {});
        const Formula atoms[] = {Formula::marked(m.p("Both"))};
        const net::Net net = m.net();
        const GraphRequest request{.net = net, .atoms = atoms, .budget = kBudget};
        CHECK(states_where_atom_may(timed_exact_graph(request).graph, 0).empty() == (b != 2.0));
        CHECK_FALSE(states_where_atom_may(readiness_graph(request).graph, 0).empty());
    }
}

TEST_CASE("outside events may never come: what only they move is dead for those who ask [unit]") {
    Maker m;
    m.place("A", 1);
    const net::EventIndex e = m.event("kick");
    m.t("go", {"A"}, {"B"}).events = {e};
    const net::Net net = m.net();
    for (const bool exact : {true, false}) {
        const auto make = [&](std::uint32_t events) {
            const GraphRequest request{.net = net, .outside_events = events, .budget = kBudget};
            return exact ? timed_exact_graph(request) : readiness_graph(request);
        };
        const TimedGraph open = make(GraphRequest::kAnyNumber);
        CHECK((open.graph.flags[0] & Graph::kOptional) != 0);
        CHECK(may_end(open.graph, 0));
        CHECK(edges_labelled(open, net.find_transition("go").value) == 1);
        CHECK(open.graph.over == !exact);
        const TimedGraph once = make(1);
        CHECK(once.graph.size() == 3);  // before, while it is offered, after
        CHECK_FALSE(once.assumptions.empty());
        const TimedGraph closed = make(0);
        CHECK(closed.graph.size() == 1);
        CHECK(closed.graph.dead(0));
        if (exact) {
            std::string trouble;
            const auto script = once.script(once.path_to(2), &trouble);
            REQUIRE_MESSAGE(script.has_value(), trouble);
            CHECK(script->outside.size() == 1);
            CHECK(script->firings.size() == 1);
        }
    }
}

TEST_CASE("a sensor that no event sets is free: both its values are met [unit]") {
    Maker m;
    m.place("A", 1, net::lasts(1));
    const net::DatumIndex near = m.datum("near", {ValueKind::kBool, 0}, 0);
    m.draft.data.back().sensor = true;
    m.t("hit", {"A"}, {"Hit"}).guard = m.read(near);
    const Formula atoms[] = {Formula::marked(m.p("Hit"))};
    const net::Net net = m.net();
    const GraphRequest request{.net = net, .atoms = atoms, .budget = kBudget};
    const TimedGraph g = readiness_graph(request);
    CHECK(g.graph.over);
    CHECK_FALSE(states_where_atom_must(g.graph, 0).empty());
    // It may also be lost for ever: A waits ready, and nothing but the sensor moves.
    StateBits others = states_where_atom_may(g.graph, 0);
    others.complement();
    CHECK(lasso_within(g.graph, 0, others).has_value());
}

TEST_CASE("guards on reals are followed exactly [unit]") {
    Maker m;
    m.place("A", 1);
    const net::DatumIndex x = m.datum("x", {ValueKind::kReal, 0}, value_of_real(1));
    net::TransitionDraft& t = m.t("halve", {"A"}, {"A"});
    t.guard = net::expr(ExprOp::kGreater, m.read(x), Expr::real(0.1));
    net::AssignmentDraft halve;
    halve.datum = x;
    halve.value = net::expr(ExprOp::kDivide, m.read(x), Expr::real(2));
    t.assignments.push_back(halve);
    const net::Net net = m.net();
    const TimedGraph g = readiness_graph({.net = net, .budget = kBudget});
    CHECK(g.graph.exact);
    CHECK(g.graph.size() == 5);  // 1, 1/2, 1/4, 1/8, 1/16
}

TEST_CASE("a datum that leaves its range is a stop, not a state [unit]") {
    Maker m;
    m.place("A", 1);
    const net::DatumIndex x = m.integer("x", 0, 0, 2);
    net::AssignmentDraft more;
    more.datum = x;
    more.value = net::expr(ExprOp::kAdd, m.read(x), Expr::integer(1));
    m.t("more", {"A"}, {"A"}).assignments.push_back(more);
    const net::Net net = m.net();
    for (const bool exact : {true, false}) {
        const GraphRequest request{.net = net, .budget = kBudget};
        const TimedGraph g = exact ? timed_exact_graph(request) : readiness_graph(request);
        REQUIRE(g.stops.size() == 1);
        CHECK(g.stops[0].fault.code == "range-left");
        CHECK(g.stops[0].label == net.find_transition("more").value);
        CHECK(g.datum(g.stops[0].state, x) == 2);
        CHECK((g.graph.flags[g.stops[0].state] & Graph::kCut) != 0);
    }
}

TEST_CASE("a net that grows for ever ends by its budget, and says so [unit]") {
    Maker m;
    m.place("A", 1, net::lasts(1));
    m.t("grow", {"A"}, {"A", "B"});
    const net::Net net = m.net();
    const Budget small{.states = 100};
    for (const bool exact : {true, false}) {
        const GraphRequest request{.net = net, .budget = small};
        const TimedGraph g = exact ? timed_exact_graph(request) : readiness_graph(request);
        CHECK(g.graph.ended == Ended::kStates);
        CHECK(g.graph.size() >= 100);
        CHECK((g.graph.flags.back() & Graph::kCut) != 0);
    }
}

TEST_CASE("justice: what waits is over some day, so a loop beside it is no run [law]") {
    Maker m;
    m.place("A", 1, net::lasts(1));
    m.place("B", 1, net::lasts(50));
    m.t("a", {"A"}, {"A"});
    m.t("b", {"B"}, {"Bdone"});
    const net::Net net = m.net();
    const TimedGraph g = readiness_graph({.net = net, .budget = kBudget});
    const std::uint32_t b = net.find_place("B").value;
    // There is a cycle that never ends B; B waits in all its states, and no edge of it stirs B.
    bool found = false;
    for (std::uint32_t s = 0; s < g.graph.size(); ++s) {
        for (std::uint32_t e = g.graph.edges.starts[s]; e < g.graph.edges.starts[s + 1]; ++e) {
            const std::uint32_t t = g.graph.edges.items[e].target;
            if (g.waits.waits(s, b) && g.waits.waits(t, b)) {
                CHECK_FALSE(g.waits.stirs(e, b));
                found = true;
            }
            if (g.waits.waits(s, b) && !g.waits.waits(t, b)) {
                CHECK(g.waits.stirs(e, b));
            }
        }
    }
    CHECK(found);
}

TEST_CASE("movements last what they declare, and the script says how long they took [unit]") {
    Maker m;
    m.place("Go", 1);
    m.place("Move", 0).action = net::ActionIndex{0};
    m.t("begin", {"Go"}, {"Move"});
    m.t("end", {"Move"}, {"Done"});
    const net::Net net = m.net();
    const TickRange declared[] = {{.low = 2 * kTicksPerSecond, .high = 2 * kTicksPerSecond}};
    const TimedGraph g = timed_exact_graph({.net = net, .actions = declared, .budget = kBudget});
    CHECK(g.graph.over);
    const auto script = g.script(g.path_to(g.graph.size() - 1));
    REQUIRE(script.has_value());
    REQUIRE(script->movements.size() == 1);
    CHECK(script->movements[0].seconds() == 2);
    CHECK(script->until.seconds() == 2);
    // Nobody says how long: exact time is not available, readiness is.
    const GraphRequest unknown{.net = net, .budget = kBudget};
    CHECK_FALSE(timed_exact_graph(unknown).available());
    CHECK(readiness_graph(unknown).available());
    CHECK(class_graph(unknown).available());
}

TEST_CASE(
    "the event of a movement may occur though nothing comes from outside, and though a firing "
    "raises it, too [unit]") {
    for (const bool raised : {false, true}) {
        Maker m;
        m.place("Move", 1).action = net::ActionIndex{0};
        m.place("A", 1);
        const net::EventIndex e = m.event("Move.strike");
        m.draft.events[e.value].outside = false;
        m.t("hear", {"A"}, {"Heard"}).events = {e};
        if (raised) {
            m.t("raise", {"Never"}, {}).raises = {e};
        }
        const net::Net net = m.net();
        const Formula atoms[] = {Formula::marked(m.p("Heard"))};
        const TimedGraph g =
            readiness_graph({.net = net, .atoms = atoms, .outside_events = 0, .budget = kBudget});
        CHECK_FALSE(states_where_atom_must(g.graph, 0).empty());
        CHECK_FALSE(g.graph.exact);
    }
}

}  // namespace
