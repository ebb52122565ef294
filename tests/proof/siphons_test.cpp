// SPDX-License-Identifier: MIT
#include "puppetri/proof/siphons.h"

#include <doctest/doctest.h>

#include "small_nets.h"

using namespace puppetri::proof;
using namespace puppetri::proof::test;

namespace {

// The definition, word for word: whoever gives to the set takes from it or reads it.
bool siphon_by_definition(const PlainNet& net, std::uint32_t set) {
    for (std::uint32_t t = 0; t < net.transition_count(); ++t) {
        bool gives = false, needs = false;
        for (const auto& w : net.gives.row(t)) {
            gives = gives || ((set >> w.place) & 1) != 0;
        }
        for (const auto* rows : {&net.takes, &net.reads}) {
            for (const auto& w : rows->row(t)) {
                needs = needs || ((set >> w.place) & 1) != 0;
            }
        }
        if (gives && !needs) {
            return false;
        }
    }
    return true;
}

// Whoever takes from the set leaves a token in it, if it has fired.
bool trap_by_definition(const PlainNet& net, std::uint32_t set) {
    for (std::uint32_t t = 0; t < net.transition_count(); ++t) {
        bool takes = false, leaves = false;
        for (const auto& w : net.takes.row(t)) {
            takes = takes || ((set >> w.place) & 1) != 0;
        }
        for (const auto& w : net.gives.row(t)) {
            leaves = leaves || ((set >> w.place) & 1) != 0;
        }
        for (const auto& r : net.reads.row(t)) {
            std::uint32_t taken = 0;
            for (const auto& w : net.takes.row(t)) {
                taken = w.place == r.place ? w.weight : taken;
            }
            leaves = leaves || (((set >> r.place) & 1) != 0 && taken < r.weight);
        }
        if (takes && !leaves) {
            return false;
        }
    }
    return true;
}

PlaceSet listed(std::uint32_t set) {
    PlaceSet out;
    for (std::uint32_t p = 0; p < 32; ++p) {
        if (((set >> p) & 1) != 0) {
            out.push_back(p);
        }
    }
    return out;
}

template <class Is>
std::vector<PlaceSet> minimal_by_enumeration(std::uint32_t places, Is is) {
    std::vector<std::uint32_t> found;
    std::vector<PlaceSet> out;
    for (std::uint32_t set = 1; set < 1u << places; ++set) {
        if (!is(set)) {
            continue;
        }
        bool minimal = true;
        for (std::uint32_t less = (set - 1) & set; less != 0; less = (less - 1) & set) {
            minimal = minimal && !is(less);
        }
        if (minimal) {
            out.push_back(listed(set));
        }
    }
    std::sort(out.begin(), out.end());
    return out;
}

}  // namespace

TEST_CASE("minimal siphons and traps are those of enumerating all sets of places [oracle]") {
    Chance chance(31);
    for (int round = 0; round < 1500; ++round) {
        const PlainNet net = small_net(chance, {.places = 7,
                                                .transitions = 6,
                                                .weights = true,
                                                .reads = true,
                                                .conservative = round % 2 == 0});
        CAPTURE(text(net));
        const auto siphons = minimal_by_enumeration(
            net.place_count(), [&](std::uint32_t s) { return siphon_by_definition(net, s); });
        const auto traps = minimal_by_enumeration(
            net.place_count(), [&](std::uint32_t s) { return trap_by_definition(net, s); });
        CHECK(minimal_siphons(net, {}).sets == siphons);
        CHECK(minimal_traps(net, {}).sets == traps);
    }
}

TEST_CASE("an empty siphon stays empty, a marked trap stays marked [law]") {
    Chance chance(32);
    for (int round = 0; round < 1500; ++round) {
        const PlainNet net =
            small_net(chance, {.places = 6, .weights = true, .reads = true, .inhibitors = true});
        const Space space = whole_space(net);
        const auto marked = [&](const PlaceSet& set, const Marking& m) {
            return std::any_of(set.begin(), set.end(), [&](std::uint32_t p) { return m[p] > 0; });
        };
        const auto siphons = minimal_siphons(net, {}).sets;
        const auto traps = minimal_traps(net, {}).sets;
        for (std::uint32_t s = 0; s < space.edges.size(); ++s) {
            for (const auto& [t, target] : space.edges[s]) {
                for (const PlaceSet& siphon : siphons) {
                    CHECK((marked(siphon, space.markings[s]) ||
                           !marked(siphon, space.markings[target])));
                }
                for (const PlaceSet& trap : traps) {
                    CHECK(
                        (!marked(trap, space.markings[s]) || marked(trap, space.markings[target])));
                }
            }
        }
    }
}

TEST_CASE(
    "Commoner's property holds iff each siphon's greatest trap is marked, by enumeration "
    "[oracle]") {
    Chance chance(33);
    int holds = 0, fails = 0;
    for (int round = 0; round < 1000; ++round) {
        const PlainNet net = small_net(chance, {.places = 6, .transitions = 6});
        const SiphonAnswer answer = commoner(net, {});
        bool all = true;
        for (std::uint32_t set = 1; set < 1u << net.place_count(); ++set) {
            if (!siphon_by_definition(net, set)) {
                continue;
            }
            bool good = false;
            for (std::uint32_t part = set; part != 0; part = (part - 1) & set) {
                const PlaceSet places = listed(part);
                good = good || (trap_by_definition(net, part) &&
                                std::any_of(places.begin(), places.end(),
                                            [&](std::uint32_t p) { return net.initial[p] > 0; }));
            }
            all = all && good;
        }
        CHECK((answer.kind == SiphonAnswer::kHolds) == all);
        CHECK((answer.kind == SiphonAnswer::kFails) == !all);
        (all ? holds : fails)++;
    }
    CHECK(holds > 20);
    CHECK(fails > 100);
}
