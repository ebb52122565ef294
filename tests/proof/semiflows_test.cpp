// SPDX-License-Identifier: MIT
#include "puppetri/proof/semiflows.h"

#include <doctest/doctest.h>

#include "small_nets.h"

using namespace puppetri::proof;
using namespace puppetri::proof::test;

namespace {

std::int64_t product(const Flow& y, const Flow& effect) {
    std::int64_t sum = 0;
    for (const Flow::Term& a : y.terms) {
        for (const Flow::Term& b : effect.terms) {
            sum += a.index == b.index ? a.factor * b.factor : 0;
        }
    }
    return sum;
}

std::vector<std::uint32_t> support(const Flow& y) {
    std::vector<std::uint32_t> s;
    for (const Flow::Term& t : y.terms) {
        s.push_back(t.index);
    }
    return s;
}

}  // namespace

TEST_CASE(
    "minimal place semiflows are exactly the flows of minimal support that exhaustive search finds "
    "[oracle]") {
    Chance chance(11);
    for (int round = 0; round < 1500; ++round) {
        const PlainNet net = small_net(
            chance,
            {.places = 5, .transitions = 4, .weights = true, .conservative = round % 2 == 0});
        CAPTURE(text(net));
        const Flows flows = place_semiflows(net, {});
        REQUIRE(flows.complete);
        const std::vector<Flow> columns = effects(net);
        for (const Flow& y : flows.flows) {
            for (const Flow::Term& term : y.terms) {
                CHECK(term.factor > 0);
            }
            for (const Flow& column : columns) {
                CHECK(product(y, column) == 0);
            }
            for (const Flow& other : flows.flows) {
                const auto a = support(y), b = support(other);
                CHECK((&y == &other || !std::includes(b.begin(), b.end(), a.begin(), a.end())));
            }
        }
        // Every non-negative flow with factors up to 4 has the support of a minimal one inside.
        const std::uint32_t places = net.place_count();
        std::vector<std::int64_t> y(places, 0);
        for (;;) {
            std::uint32_t i = 0;
            while (i < places && y[i] == 4) {
                y[i++] = 0;
            }
            if (i == places) {
                break;
            }
            ++y[i];
            Flow flow;
            for (std::uint32_t p = 0; p < places; ++p) {
                if (y[p] != 0) {
                    flow.terms.push_back({p, y[p]});
                }
            }
            if (!std::all_of(columns.begin(), columns.end(),
                             [&](const Flow& c) { return product(flow, c) == 0; })) {
                continue;
            }
            const auto whole = support(flow);
            CHECK(std::any_of(flows.flows.begin(), flows.flows.end(), [&](const Flow& f) {
                const auto part = support(f);
                return std::includes(whole.begin(), whole.end(), part.begin(), part.end());
            }));
        }
    }
}

TEST_CASE("bounds by semiflows hold in every reachable marking, and weighted sums stay [law]") {
    Chance chance(12);
    for (int round = 0; round < 1500; ++round) {
        const PlainNet net =
            small_net(chance, {.weights = true, .reads = true, .inhibitors = true});
        const Flows flows = place_semiflows(net, {});
        const Flows basis = place_flow_basis(net, {});
        REQUIRE(basis.complete);
        const auto bounds = bounds_by_semiflows(net, flows);
        for (const Marking& m : whole_space(net).markings) {
            for (std::uint32_t p = 0; p < net.place_count(); ++p) {
                CHECK(m[p] <= bounds[p]);
            }
            for (const auto* list : {&flows.flows, &basis.flows}) {
                for (const Flow& y : *list) {
                    CHECK(weighted_tokens(y, m) == weighted_tokens(y, net.initial));
                }
            }
        }
    }
}

TEST_CASE("firing a transition semiflow's counts changes nothing [law]") {
    Chance chance(13);
    for (int round = 0; round < 1000; ++round) {
        const PlainNet net = small_net(chance, {.weights = true, .conservative = false});
        const std::vector<Flow> columns = effects(net);
        for (const Flow& x : transition_semiflows(net, {}).flows) {
            std::vector<std::int64_t> change(net.place_count(), 0);
            for (const Flow::Term& t : x.terms) {
                CHECK(t.factor > 0);
                for (const Flow::Term& e : columns[t.index].terms) {
                    change[e.index] += t.factor * e.factor;
                }
            }
            CHECK(std::count(change.begin(), change.end(), 0) == net.place_count());
        }
    }
}

TEST_CASE("no flow stands on a place that an arc empties [unit]") {
    PlainNet net;
    net.initial = {1, 0};
    add_transition(net, {{0, 1}}, {{1, 1}});
    add_transition(net, {{1, 1}}, {{0, 1}});
    CHECK(place_semiflows(net, {}).flows.size() == 1);
    CHECK(place_semiflows(net, {}, std::vector<std::uint8_t>{0, 1}).flows.empty());
    CHECK(place_flow_basis(net, {}, std::vector<std::uint8_t>{0, 1}).flows.empty());
}

TEST_CASE("numbers that pass 63 bits make the answer incomplete, never wrong [unit]") {
    PlainNet net;  // p(i) -> 2^31 p(i+1): the flow needs factors up to 2^93
    net.initial = {1, 0, 0, 0};
    for (std::uint32_t i = 0; i < 3; ++i) {
        add_transition(net, {{i, 1}}, {{i + 1, 1u << 31}});
    }
    const Flows flows = place_semiflows(net, {});
    CHECK_FALSE(flows.complete);
    CHECK(flows.flows.empty());
}

TEST_CASE("invariants are told by the names of places [unit]") {
    const std::vector<std::string_view> names = {"ana.has", "rui.has", "air"};
    CHECK(invariant_text({{{0, 1}, {1, 1}, {2, 2}}}, 1, names) == "ana.has + rui.has + 2*air = 1");
    CHECK(invariant_text({{{0, -1}, {2, -3}}}, 0, names) == "-ana.has - 3*air = 0");
}
