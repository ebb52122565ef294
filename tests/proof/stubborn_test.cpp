// SPDX-License-Identifier: MIT
// Reduced = full: stubborn sets answer as the whole graph does, on thousands of random nets with
// weights, read arcs, inhibitors and transitions that do not count as alive, for deaths, for single
// goals and for several at a time. PUPPETRI_PROOF_TIMES multiplies the number of nets.
#include <doctest/doctest.h>

#include <cstdlib>

#include "puppetri/base/hash.h"
#include "puppetri/proof/explorer.h"
#include "support/random_plain_net.h"
#include "support/tiny_pnml.h"

namespace puppetri::proof {
namespace {

std::uint64_t times() {
    const char* text = std::getenv("PUPPETRI_PROOF_TIMES");
    return text != nullptr ? std::strtoull(text, nullptr, 10) : 1;
}

Marking played(const PlainNet& net, const std::vector<std::uint32_t>& firings) {
    Marking m = net.initial;
    for (const std::uint32_t t : firings) {
        REQUIRE(t < net.transition_count());
        REQUIRE(net.enabled(m, t));
        REQUIRE(net.fire(m, t));
    }
    return m;
}

bool is_dead(const PlainNet& net, const Marking& m) {
    for (std::uint32_t t = 0; t < net.transition_count(); ++t) {
        if (net.enabled(m, t) && net.optional[t] == 0) {
            return false;
        }
    }
    return true;
}

TEST_CASE("reduced = full on random nets [agree]") {
    std::uint64_t compared = 0, full_states = 0, reduced_states = 0, yes = 0, no = 0;
    for (std::uint64_t i = 0; i < 4000 * times(); ++i) {
        RandomStream stream{.key = Hash64(0x57B).add_u64(i).value(), .count = 0};
        const PlainNet net = test::random_plain_net(
            stream, {.weights = i % 3 == 0, .levels = false, .conserving = i % 2 == 0});
        Budget budget;
        budget.states = 2500;
        std::vector<Predicate> goals;
        for (std::uint64_t k = 0; k < i % 4; ++k) {
            goals.push_back(test::random_predicate(stream, net));
        }
        ExploreOptions options{.goals = goals, .find_dead = i % 4 == 0 || i % 7 == 0};
        options.witnesses = true;
        const Exploration full = explore(net, options, budget);
        if (!full.complete) {
            continue;
        }
        options.reduce = true;
        const Exploration reduced = explore(net, options, budget);
        INFO("net " << i);
        REQUIRE(reduced.complete);
        CHECK(reduced.reduced);
        CHECK(reduced.states <= full.states);
        ++compared;
        full_states += full.states;
        reduced_states += reduced.states;
        CHECK(reduced.dead.found == full.dead.found);
        if (reduced.dead.found) {
            CHECK(is_dead(net, played(net, reduced.dead.firings)));
        }
        for (std::size_t g = 0; g < goals.size(); ++g) {
            CHECK(reduced.goals[g].found == full.goals[g].found);
            (full.goals[g].found ? yes : no) += 1;
            if (reduced.goals[g].found) {
                CHECK(goals[g].holds(net, played(net, reduced.goals[g].firings)));
            }
        }
        const Exploration sought = seek(net, options, budget);
        CHECK(sought.dead.found == full.dead.found);
        for (std::size_t g = 0; g < goals.size(); ++g) {
            CHECK(sought.goals[g].found == full.goals[g].found);
        }
        if (sought.dead.found) {
            CHECK(is_dead(net, played(net, sought.dead.firings)));
        }
    }
    CHECK(compared > 1500);
    CHECK(yes > 500);
    CHECK(no > 500);
    CHECK(reduced_states * 3 < full_states * 2);
}

TEST_CASE("final markings are no deaths, reduced or not [agree]") {
    std::uint64_t compared = 0;
    for (std::uint64_t i = 0; i < 1500 * times(); ++i) {
        RandomStream stream{.key = Hash64(0x57C).add_u64(i).value(), .count = 0};
        const PlainNet net = test::random_plain_net(stream, {.levels = false});
        const Predicate final = test::random_predicate(stream, net);
        Budget budget;
        budget.states = 2500;
        ExploreOptions options{.find_dead = true, .final = &final};
        const Exploration full = explore(net, options, budget);
        if (!full.complete) {
            continue;
        }
        ++compared;
        INFO("net " << i);
        options.reduce = true;
        CHECK(explore(net, options, budget).dead.found == full.dead.found);
        CHECK(seek(net, options, budget).dead.found == full.dead.found);
    }
    CHECK(compared > 400);
}

TEST_CASE("priorities are never reduced [unit]") {
    RandomStream stream{.key = 1, .count = 0};
    PlainNet net = test::random_plain_net(stream, {.levels = false});
    net.level[0] = 1;
    net.has_levels = true;
    Budget budget;
    budget.states = 1000;
    CHECK_FALSE(explore(net, {.find_dead = true, .reduce = true}, budget).reduced);
}

TEST_CASE("independent cycles are gone through one after the other, not all together [law]") {
    // n rings of three places: 3^n states; reduced, the first may go round alone.
    PlainNet net;
    constexpr std::uint32_t kRings = 12;
    for (std::uint32_t t = 0; t < 3 * kRings; ++t) {
        net.initial.push_back(t % 3 == 0 ? 1 : 0);
        net.takes.items.push_back({t, 1});
        net.gives.items.push_back({t % 3 == 2 ? t - 2 : t + 1, 1});
        net.takes.starts.push_back(t + 1);
        net.gives.starts.push_back(t + 1);
        net.reads.starts.push_back(0);
        net.unless.starts.push_back(0);
        net.level.push_back(0);
        net.optional.push_back(0);
    }
    const Exploration e = explore(net, {.find_dead = true, .reduce = true}, {});
    CHECK(e.complete);
    CHECK_FALSE(e.dead.found);
    CHECK(e.states == 3);
}

TEST_CASE("deadlocks of all contest models are decided with default options [oracle]") {
    const std::string nets = PUP_SOURCE_DIR "/../shared/nets/mcc/";
    std::istringstream text(test::text_of_file(nets + "answers.tsv"));
    std::string line;
    if (!std::getline(text, line)) {
        MESSAGE("skipped: no ../shared/nets/mcc");
        return;
    }
    const char* all = std::getenv("PUPPETRI_PROOF_MODELS");
    while (std::getline(text, line)) {
        std::istringstream cells(line);
        std::vector<std::string> row;
        for (std::string cell; std::getline(cells, cell, '\t');) {
            row.push_back(cell);
        }
        const bool large = row[0] == "LamportFastMutEx-PT-4" || row[0] == "Dekker-PT-015";
        if (large && all == nullptr) {
            continue;
        }
        INFO(row[0]);
        const PlainNet net = test::tiny_pnml(nets + row[0] + "/model.pnml");
        const Exploration e = seek(net, {.find_dead = true, .witnesses = true}, {});
        CHECK((e.complete || e.dead.found));
        CHECK(e.dead.found == (row[8] == "TRUE"));
        if (e.dead.found) {
            CHECK(is_dead(net, played(net, e.dead.firings)));
        }
    }
}

}  // namespace
}  // namespace puppetri::proof
