// SPDX-License-Identifier: MIT
#include "puppetri/proof/symmetry.h"

#include <doctest/doctest.h>

#include <set>
#include <string>

#include "small_nets.h"

using namespace puppetri::proof;
using namespace puppetri::proof::test;

namespace {

// `count` copies of a random module around shared places; `odd` breaks one copy.
struct Copies {
    PlainNet net;
    std::vector<std::string> places, transitions;
    std::vector<std::string_view> place_views, transition_views;
};

Copies copies(Chance& chance, std::uint32_t count, bool odd) {
    Copies out;
    const std::uint32_t shared = 2, width = 2, width_t = 2;
    for (std::uint32_t p = 0; p < shared; ++p) {
        out.net.initial.push_back(chance.below(3));
        out.places.push_back("shared" + std::to_string(p));
    }
    std::vector<std::uint32_t> in, to;
    for (std::uint32_t t = 0; t < width_t; ++t) {
        in.push_back(chance.below(shared + width));
        to.push_back(chance.below(shared + width));
        in.push_back(chance.below(shared + width));
        to.push_back(chance.below(shared + width));
    }
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::string name = "m" + std::to_string(i) + ".";
        for (std::uint32_t k = 0; k < width; ++k) {
            out.net.initial.push_back(chance.below(2));
            out.places.push_back(name + "p" + std::to_string(k));
        }
        const auto place = [&](std::uint32_t local) {
            return local < shared ? local : shared + i * width + local - shared;
        };
        for (std::uint32_t t = 0; t < width_t; ++t) {
            std::map<std::uint32_t, std::uint32_t> takes, gives;
            takes[place(in[2 * t])] = 1;
            takes[place(in[2 * t + 1])] = 1;
            gives[place(to[2 * t])] = 1;
            if (gives.size() < takes.size()) {
                gives[place(to[2 * t + 1])] = odd && i == 1 && t == 0 ? 2 : 1;
            }
            add_transition(out.net, takes, gives);
            out.transitions.push_back(name + "t" + std::to_string(t));
        }
    }
    out.place_views.assign(out.places.begin(), out.places.end());
    out.transition_views.assign(out.transitions.begin(), out.transitions.end());
    return out;
}

}  // namespace

TEST_CASE(
    "exploring representatives visits exactly the representatives of all reachable markings "
    "[law]") {
    Chance chance(91);
    int found = 0;
    for (int round = 0; round < 800; ++round) {
        const Copies c = copies(chance, 3, round % 4 == 0);
        const Symmetry symmetry =
            interchangeable_instances(c.net, c.place_views, c.transition_views);
        found += symmetry.none() ? 0 : 1;
        const Space full = whole_space(c.net);
        if (!full.complete) {
            continue;
        }
        std::set<Marking> want;
        for (Marking m : full.markings) {
            make_canonical(symmetry, m);
            want.insert(m);
        }
        std::set<Marking> seen;
        Marking first = c.net.initial;
        make_canonical(symmetry, first);
        std::vector<Marking> open = {first};
        seen.insert(first);
        while (!open.empty()) {
            const Marking m = open.back();
            open.pop_back();
            for (std::uint32_t t = 0; t < c.net.transition_count(); ++t) {
                Marking next = m;
                if (c.net.enabled(next, t) && c.net.fire(next, t)) {
                    make_canonical(symmetry, next);
                    if (seen.insert(next).second) {
                        open.push_back(next);
                    }
                }
            }
        }
        CHECK(seen == want);
    }
    CHECK(found > 500);
}

TEST_CASE("only swaps that leave a predicate as it is respect it [unit]") {
    Chance chance(92);
    Copies c;
    do {
        c = copies(chance, 3, false);
    } while (interchangeable_instances(c.net, c.place_views, c.transition_views).none());
    const Symmetry symmetry = interchangeable_instances(c.net, c.place_views, c.transition_views);
    REQUIRE(symmetry.groups.size() == 1);
    REQUIRE(symmetry.groups[0].count == 3);
    const auto marked = [&](std::uint32_t i) {
        return Predicate::at_least({{{symmetry.groups[0].places[i * symmetry.groups[0].width], 1}}},
                                   1);
    };
    CHECK(respecting(symmetry,
                     Predicate::any_of(std::vector<Predicate>{marked(0), marked(1), marked(2)}))
              .groups.size() == 1);
    CHECK(respecting(symmetry, marked(0)).none());
    CHECK(respecting(symmetry, Predicate::at_least({{{0, 1}}}, 1)).groups.size() == 1);
    CHECK(respecting(symmetry, Predicate::enabled({0})).none());
}
