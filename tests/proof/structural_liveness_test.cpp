// SPDX-License-Identifier: MIT
// Theorems against brute force. Longer: PUP_LIVENESS_ROUNDS=100000.
#include "puppetri/proof/structural_liveness.h"

#include <doctest/doctest.h>

#include <cstdlib>

#include "net/maker.h"
#include "puppetri/proof/net_class.h"
#include "small_nets.h"

using namespace puppetri::proof;
using namespace puppetri::proof::test;

namespace {

int rounds(int usual) {
    const char* text = std::getenv("PUP_LIVENESS_ROUNDS");
    return text != nullptr ? std::atoi(text) : usual;
}

// Marked graphs, free choice nets and others, some of them in two parts.
PlainNet random_net(Chance& chance, int round) {
    PlainNet net;
    const int kind = round % 4;
    if (kind == 0) {
        return small_net(chance, {.places = 6,
                                  .transitions = 6,
                                  .reads = round % 8 == 0,
                                  .conservative = round % 3 != 0});
    }
    const std::uint32_t transitions = 2 + chance.below(4);
    std::vector<std::map<std::uint32_t, std::uint32_t>> takes(transitions), gives(transitions);
    const std::uint32_t places = transitions + chance.below(4);
    if (kind == 1) {  // a marked graph: each place between two transitions
        for (std::uint32_t p = 0; p < places; ++p) {
            net.initial.push_back(chance.one_in(3) ? 1 + chance.below(2) : 0);
            gives[p < transitions ? p : chance.below(transitions)][p] = 1;
            takes[p < transitions ? (p + 1) % transitions : chance.below(transitions)][p] = 1;
        }
    } else {  // free choice: clusters of places, whose transitions need all of them
        std::uint32_t t = 0;
        while (t < transitions) {
            std::vector<std::uint32_t> cluster;
            const std::uint32_t size = 1 + chance.below(2), choices = 1 + chance.below(2);
            for (std::uint32_t i = 0; i < size; ++i) {
                cluster.push_back(static_cast<std::uint32_t>(net.initial.size()));
                net.initial.push_back(chance.one_in(2) ? 1 : 0);
            }
            for (std::uint32_t c = 0; c < choices && t < transitions; ++c, ++t) {
                for (const std::uint32_t p : cluster) {
                    takes[t][p] = 1;
                }
            }
        }
        for (std::uint32_t u = 0; u < transitions; ++u) {
            const std::uint32_t out = kind == 2 ? 1 : static_cast<std::uint32_t>(takes[u].size());
            for (std::uint32_t i = 0; i < out; ++i) {
                gives[u][chance.below(static_cast<std::uint32_t>(net.initial.size()))] = 1;
            }
        }
    }
    for (std::uint32_t t = 0; t < transitions; ++t) {
        add_transition(net, takes[t], gives[t]);
    }
    return net;
}

}  // namespace

TEST_CASE(
    "live, not live, deadlock-free and bounded by theorem are what the whole state space says "
    "[law]") {
    Chance chance(51);
    int live = 0, not_live = 0, free = 0, well_formed = 0;
    for (int round = 0; round < rounds(8000); ++round) {
        const PlainNet net = random_net(chance, round);
        const StructuralLiveness answer = structural_liveness(net, {});
        const Space space = whole_space(net, 3000, 30);
        CAPTURE(text(net));
        CAPTURE(answer.theorem);
        CHECK_FALSE((answer.live && answer.not_live));
        if (answer.live && answer.bounded) {
            REQUIRE(space.complete);
        }
        if (!space.complete) {
            continue;
        }
        const auto live_now = live_transitions(net, space);
        const bool all_live = std::find(live_now.begin(), live_now.end(), 0) == live_now.end();
        bool dead = false;
        for (std::uint32_t s = 0; s < space.markings.size(); ++s) {
            dead = dead || space.edges[s].empty();
        }
        if (answer.live) {
            CHECK(all_live);
            ++live;
        }
        if (answer.not_live) {
            CHECK_FALSE(all_live);
            CHECK_FALSE(answer.unmarked.empty());
            ++not_live;
        }
        if (answer.deadlock_free) {
            CHECK_FALSE(dead);
            ++free;
        }
        well_formed +=
            answer.live && std::string(answer.theorem).find("rank") != std::string::npos ? 1 : 0;
    }
    CHECK(live > 100);
    CHECK(not_live > 100);
    CHECK(free > 150);
    CHECK(well_formed > 20);
}

TEST_CASE("nothing is claimed with levels or transitions that need not fire [unit]") {
    PlainNet net;
    net.initial = {1};
    add_transition(net, {{0, 1}}, {{0, 1}}, {}, {}, true);
    CHECK_FALSE(structural_liveness(net, {}).live);
    net.optional[0] = 0;
    CHECK(structural_liveness(net, {}).live);
    net.has_levels = true;
    CHECK_FALSE(structural_liveness(net, {}).live);
}

TEST_CASE("a thousand pairs are live, component by component [unit]") {
    PlainNet net;
    for (std::uint32_t i = 0; i < 1000; ++i) {
        net.initial.insert(net.initial.end(), {1, 0});
        add_transition(net, {{2 * i, 1}}, {{2 * i + 1, 1}});
        add_transition(net, {{2 * i + 1, 1}}, {{2 * i, 1}});
    }
    const StructuralLiveness answer = structural_liveness(net, {});
    CHECK(answer.live);
    CHECK(answer.bounded);
}
