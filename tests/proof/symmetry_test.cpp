// SPDX-License-Identifier: MIT
#include "puppetri/proof/symmetry.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstdlib>
#include <set>
#include <string>

#include "puppetri/proof/explorer.h"
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
    const Symmetry others = respecting(symmetry, marked(0));
    REQUIRE(others.groups.size() == 1);
    CHECK(others.groups[0].count == 2);
    CHECK(others.groups[0].places[0] == symmetry.groups[0].places[symmetry.groups[0].width]);
    CHECK(respecting(symmetry, Predicate::at_least({{{0, 1}}}, 1)).groups.size() == 1);
    CHECK(respecting(symmetry, Predicate::enabled({0})).none());
}

TEST_CASE("answers with symmetry are those without, and their witnesses lead there [agree]") {
    const bool many = std::getenv("PUPPETRI_LONG") != nullptr;
    const int rounds = many ? 10'000 : 1000;
    Chance chance(93);
    int used = 0, smaller = 0, dead = 0, reached = 0;
    for (int round = 0; round < rounds; ++round) {
        Copies c = copies(chance, 2 + chance.below(3), round % 5 == 0);
        if (round % 2 == 0) {  // all begin alike
            for (std::uint32_t p = 2; p < c.net.place_count(); ++p) {
                c.net.initial[p] = c.net.initial[2 + (p & 1)];
            }
        }
        const Space full = whole_space(c.net);
        if (!full.complete) {
            continue;
        }
        const Symmetry all = interchangeable_instances(c.net, c.place_views, c.transition_views);
        // Something about one or two places, and about the sum of a kind of place of all instances.
        std::vector<Predicate> parts;
        for (int k = 0; k < 2; ++k) {
            parts.push_back(Predicate::at_least({{{chance.below(c.net.place_count()), 1}}},
                                                1 + chance.below(2)));
        }
        LinearSum sum;
        for (std::uint32_t p = 2 + chance.below(2); p < c.net.place_count(); p += 2) {
            sum.terms.push_back({p, 1});
        }
        const std::uint32_t t = chance.below(c.net.transition_count());
        const Predicate goals[] = {Predicate::all_of(parts),
                                   Predicate::at_least(sum, 1 + chance.below(4)),
                                   told_in_tokens(Predicate::enabled({t}), c.net)};
        const Predicate& goal = goals[chance.below(3)];
        const Symmetry symmetry = respecting(all, goal);
        for (const bool stubborn : {false, true}) {
            ExploreOptions options;
            options.goals = {&goal, 1};
            options.find_dead = true;
            options.witnesses = true;
            options.reduce = stubborn;
            options.symmetry = &symmetry;
            const Exploration e = explore(c.net, options, {});
            REQUIRE(e.complete);
            const auto holds = [&](const Marking& m) { return goal.holds(c.net, m); };
            const auto is_dead = [&](const Marking& m) {
                return !Predicate::no_successor(c.net).negated().holds(c.net, m);
            };
            CHECK(e.goals[0].found ==
                  std::any_of(full.markings.begin(), full.markings.end(), holds));
            CHECK(e.dead.found == std::any_of(full.markings.begin(), full.markings.end(), is_dead));
            const auto leads = [&](const Finding& f) {
                Marking m = c.net.initial;
                for (const std::uint32_t u : f.firings) {
                    REQUIRE(u < c.net.transition_count());
                    REQUIRE(c.net.enabled(m, u));
                    c.net.fire(m, u);
                }
                CHECK(m == f.marking);
                return m;
            };
            if (e.goals[0].found) {
                CHECK(holds(leads(e.goals[0])));
                ++reached;
            }
            if (e.dead.found) {
                CHECK(is_dead(leads(e.dead)));
                ++dead;
            }
            used += e.symmetric ? 1 : 0;
            if (!stubborn) {
                std::set<Marking> orbits;
                Marking most(c.net.place_count(), 0);
                const Symmetry kept = keeping(symmetry, c.net.initial);
                for (Marking m : full.markings) {
                    for (std::uint32_t p = 0; p < most.size(); ++p) {
                        most[p] = std::max(most[p], m[p]);
                    }
                    if (e.symmetric) {
                        make_canonical(kept, m);
                    }
                    orbits.insert(m);
                }
                CHECK(e.states == orbits.size());
                CHECK(e.bounds == most);
                smaller += e.states < full.markings.size() ? 1 : 0;
            }
        }
    }
    MESSAGE(used << " with symmetry, " << smaller << " smaller, " << dead << " dead ends, "
                 << reached << " goals reached");
    CHECK(used > rounds / 2);
    CHECK(smaller > rounds / 20);
    CHECK(dead > rounds / 20);
    CHECK(reached > rounds / 20);
}

TEST_CASE("a hundred voters are as many states as there are counts of them [law]") {
    // One vote each, yes or no, after the start: of n voters any a have said yes and b no.
    constexpr std::uint32_t kVoters = 100;
    PlainNet net;
    std::vector<std::string> places = {"ready"}, transitions = {"start"};
    net.initial = {1};
    std::map<std::uint32_t, std::uint32_t> ask;
    for (std::uint32_t i = 0; i < kVoters; ++i) {
        ask[1 + 3 * i] = 1;
        for (const char* what : {"voting_", "yes_", "no_"}) {
            places.push_back(what + std::to_string(i));
            net.initial.push_back(0);
        }
    }
    add_transition(net, {{0, 1}}, ask);
    for (std::uint32_t i = 0; i < kVoters; ++i) {
        for (std::uint32_t vote : {1u, 2u}) {
            add_transition(net, {{1 + 3 * i, 1}}, {{1 + 3 * i + vote, 1}});
            transitions.push_back((vote == 1 ? "say_yes_" : "say_no_") + std::to_string(i));
        }
    }
    const std::vector<std::string_view> place_views(places.begin(), places.end()),
        transition_views(transitions.begin(), transitions.end());
    const Symmetry symmetry = interchangeable_instances(net, place_views, transition_views);
    REQUIRE(symmetry.groups.size() == 1);
    CHECK(symmetry.groups[0].count == kVoters);
    ExploreOptions options;
    options.symmetry = &symmetry;
    options.find_dead = true;
    const Exploration e = explore(net, options, {});
    CHECK(e.complete);
    CHECK(e.states == 1 + (kVoters + 1) * (kVoters + 2) / 2);
    CHECK(e.dead.found);
}
