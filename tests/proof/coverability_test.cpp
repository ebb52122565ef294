// SPDX-License-Identifier: MIT
#include "puppetri/proof/coverability.h"

#include <doctest/doctest.h>

#include "small_nets.h"

using namespace puppetri::proof;
using namespace puppetri::proof::test;

TEST_CASE(
    "bounded nets are finite, and the pump of an unbounded one can be repeated and grows [law]") {
    Chance chance(81);
    int bounded = 0, unbounded = 0;
    for (int round = 0; round < 4000; ++round) {
        const PlainNet net = small_net(chance, {.weights = round % 2 == 0,
                                                .reads = true,
                                                .inhibitors = round % 4 == 0,
                                                .conservative = round % 3 == 0});
        CAPTURE(text(net));
        const BoundednessAnswer answer = boundedness(net, {.seconds = 5, .states = 3000});
        const Space space = whole_space(net, 3000, 1u << 20);
        if (answer.kind == BoundednessAnswer::kBounded) {
            ++bounded;
            CHECK(space.complete);
        } else if (answer.kind == BoundednessAnswer::kUnbounded) {
            ++unbounded;
            CHECK_FALSE(space.complete);
            Marking m = net.initial;
            const auto fire = [&](const std::vector<std::uint32_t>& sequence) {
                for (const std::uint32_t t : sequence) {
                    REQUIRE(net.enabled(m, t));
                    net.fire(m, t);
                }
            };
            fire(answer.prefix);
            REQUIRE_FALSE(answer.pump.empty());
            for (int i = 0; i < 5; ++i) {
                const std::uint32_t before = m[answer.place];
                fire(answer.pump);
                CHECK(m[answer.place] > before);
            }
        } else {
            CHECK((net.has_inhibitors() || !space.complete));
        }
    }
    CHECK(bounded > 1000);
    CHECK(unbounded > 500);
}

TEST_CASE("with levels nothing is called unbounded [unit]") {
    PlainNet net;
    net.initial = {1, 0};
    add_transition(net, {{0, 1}}, {{0, 1}, {1, 1}});
    CHECK(boundedness(net, {}).kind == BoundednessAnswer::kUnbounded);
    CHECK(boundedness(net, {}).place == 1);
    net.has_levels = true;
    CHECK(boundedness(net, {}).kind == BoundednessAnswer::kUnknown);
}
