// SPDX-License-Identifier: MIT
// All 21 verdict files of the contest are compared in tests/io/contest_structure_test.cpp.
#include "puppetri/proof/net_class.h"

#include <doctest/doctest.h>

#include "small_nets.h"

using namespace puppetri::proof;
using namespace puppetri::proof::test;

TEST_CASE("a ring of one token is everything at once [unit]") {
    PlainNet net;
    net.initial = {1, 0};
    add_transition(net, {{0, 1}}, {{1, 1}});
    add_transition(net, {{1, 1}}, {{0, 1}});
    const NetClass c = classify(net);
    for (const auto& p :
         {c.ordinary, c.simple_free_choice, c.extended_free_choice, c.state_machine, c.marked_graph,
          c.connected, c.strongly_connected, c.loop_free, c.conservative, c.subconservative}) {
        CHECK(p.holds);
    }
    for (const auto& p : {c.source_place, c.sink_place, c.source_transition, c.sink_transition}) {
        CHECK_FALSE(p.holds);
    }
}

TEST_CASE("what does not hold names who breaks it [unit]") {
    PlainNet net;
    net.initial = {1, 0, 0};
    add_transition(net, {{0, 1}}, {{1, 1}});
    add_transition(net, {{0, 1}, {1, 2}}, {});
    const NetClass c = classify(net);
    CHECK(c.ordinary.breaker == 1);
    CHECK_FALSE(c.simple_free_choice.holds);
    CHECK(c.extended_free_choice.breaker == 1);
    CHECK(c.state_machine.breaker == 1);
    CHECK(c.connected.breaker == 2);
    CHECK(c.source_place.breaker == 0);
    CHECK(c.sink_place.breaker == 2);
    CHECK(c.sink_transition.breaker == 1);
    CHECK_FALSE(c.source_transition.holds);
    CHECK_FALSE(c.conservative.holds);
    CHECK(c.subconservative.holds);
}

TEST_CASE("a read is an arc in and an arc out [unit]") {
    PlainNet net;
    net.initial = {1, 1};
    add_transition(net, {{0, 1}}, {{0, 1}}, {{1, 1}});
    const NetClass c = classify(net);
    CHECK_FALSE(c.loop_free.holds);
    CHECK_FALSE(c.state_machine.holds);
    CHECK(c.conservative.holds);
    CHECK(c.strongly_connected.holds);
}
