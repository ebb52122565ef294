// SPDX-License-Identifier: MIT
// What a walk says it met is met: against the whole state space of small nets.
#include "puppetri/proof/random_walk.h"

#include <doctest/doctest.h>

#include "proof/small_nets.h"

namespace puppetri::proof {

TEST_CASE("what a walk meets is reachable, and small nets are met whole [oracle]") {
    test::Chance chance(7);
    std::uint32_t met = 0, reachable_goals = 0;
    for (int i = 0; i < 300; ++i) {
        test::SmallNetShape shape;
        shape.inhibitors = shape.reads = shape.weights = true;
        const PlainNet net = test::small_net(chance, shape);
        const test::Space space = test::whole_space(net, 2000);
        if (!space.complete) {
            continue;
        }
        std::vector<Predicate> goals;
        std::vector<LinearSum> sums;
        for (std::uint32_t p = 0; p < net.place_count(); ++p) {
            goals.push_back(Predicate::at_least({{{p, 1}}}, net.initial[p] + std::int64_t{1}));
            sums.push_back({{{p, 1}}});
        }
        WalkOptions options;
        options.goals = goals;
        options.sums = sums;
        options.steps = 3000;
        options.walk_length = 50;
        const WalkOutcome outcome = walk_at_random(net, options, {});
        for (std::uint32_t p = 0; p < net.place_count(); ++p) {
            std::int64_t most = 0;
            for (const Marking& m : space.markings) {
                most = std::max(most, std::int64_t{m[p]});
            }
            const bool reachable = most > std::int64_t{net.initial[p]};
            CHECK((outcome.met[p] == 0 || reachable));
            CHECK(outcome.greatest[p] <= most);
            met += outcome.met[p];
            reachable_goals += reachable ? 1 : 0;
        }
        bool dead = false;
        for (std::uint32_t s = 0; s < space.markings.size(); ++s) {
            dead = dead || space.dead(net, s);
        }
        CHECK((!outcome.met_dead || dead));
        // The same walk again meets the same.
        CHECK(walk_at_random(net, options, {}).greatest == outcome.greatest);
    }
    CHECK(met > reachable_goals * 9 / 10);
    CHECK(reachable_goals > 100);
}

}  // namespace puppetri::proof
