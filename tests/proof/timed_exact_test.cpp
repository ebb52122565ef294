// SPDX-License-Identifier: MIT
// All behaviours with exact time, against the reference nets and against runs of the engine.
#include "puppetri/proof/timed_exact.h"

#include <doctest/doctest.h>

#include "puppetri/proof/readiness.h"
#include "timed_nets.h"

using namespace puppetri;
using namespace puppetri::proof;
using namespace puppetri::test;
using net::Formula;
using net::Maker;

namespace {

const Budget kBudget;

TEST_CASE("the walk of three steps has 11 states, with exact time and without [oracle]") {
    const net::Net net = walk_net(3);
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
}

TEST_CASE("every shortest path of the ball game is a script that the engine plays [witness]") {
    const net::Net net = ball_net();
    const TimedGraph timed = timed_exact_graph({.net = net, .budget = kBudget});
    CHECK(timed.graph.exact);
    for (std::uint32_t s = 0; s < timed.graph.size(); ++s) {
        std::string trouble;
        CHECK_MESSAGE(timed.script(timed.path_to(s), &trouble).has_value(), trouble);
        CHECK_FALSE(timed.graph.dead(s));
    }
}

}  // namespace
