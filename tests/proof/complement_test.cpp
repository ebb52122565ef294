// SPDX-License-Identifier: MIT
#include "puppetri/proof/complement.h"

#include <doctest/doctest.h>

#include "small_nets.h"

using namespace puppetri::proof;
using namespace puppetri::proof::test;

TEST_CASE("a net without inhibitors has the same markings and edges as with them [law]") {
    Chance chance(121);
    int made = 0;
    for (int round = 0; round < 3000; ++round) {
        const PlainNet net = small_net(chance, {.weights = round % 2 == 0,
                                                .reads = true,
                                                .inhibitors = true,
                                                .conservative = round % 4 != 0});
        const auto same = without_inhibitors(net, {});
        if (!same || !net.has_inhibitors()) {
            continue;
        }
        ++made;
        CHECK_FALSE(same->has_inhibitors());
        const Space a = whole_space(net), b = whole_space(*same);
        if (!a.complete) {
            continue;
        }
        REQUIRE(b.complete);
        REQUIRE(a.markings.size() == b.markings.size());
        for (std::uint32_t s = 0; s < a.markings.size(); ++s) {
            CHECK(std::equal(a.markings[s].begin(), a.markings[s].end(), b.markings[s].begin()));
            CHECK(a.edges[s] == b.edges[s]);
        }
    }
    CHECK(made > 500);
}

TEST_CASE("a limit makes a place bounded, and the net with its complement ordinary [unit]") {
    PlainNet net;
    net.initial = {0};
    add_transition(net, {}, {{0, 1}}, {}, {{0, 3}});
    add_transition(net, {{0, 1}}, {});
    const auto same = without_inhibitors(net, {});
    REQUIRE(same);
    CHECK(same->initial == Marking{0, 3});
    CHECK(same->reads.items.empty());
    CHECK(same->takes.items == std::vector<puppetri::net::Weighted>{{1, 1}, {0, 1}});
    // Without the limit nothing is known.
    net.unless.starts.assign(3, 0);
    net.unless.items.clear();
    add_transition(net, {{0, 2}}, {{0, 2}}, {}, {{0, 5}});
    CHECK_FALSE(without_inhibitors(net, {}));
}
