// SPDX-License-Identifier: MIT
// The explorer against the obvious exploration on random nets: the same states, edges, bounds,
// deaths, goals and graphs, on any number of threads, however fields grow. PUPPETRI_PROOF_TIMES
// multiplies the number of nets.
#include "puppetri/proof/explorer.h"

#include <doctest/doctest.h>

#include <cstdlib>

#include "puppetri/base/hash.h"
#include "support/random_plain_net.h"

namespace puppetri::proof {
namespace {

using test::naive_graph;
using test::NaiveGraph;

constexpr std::uint32_t kMostStates = 3000;

std::uint64_t times() {
    const char* text = std::getenv("PUPPETRI_PROOF_TIMES");
    return text != nullptr ? std::strtoull(text, nullptr, 10) : 1;
}

RandomStream stream_of(std::uint64_t purpose, std::uint64_t i) {
    return {.key = Hash64(purpose).add_u64(i).value(), .count = 0};
}

std::uint64_t edges_of(const NaiveGraph& g) {
    std::uint64_t edges = 0;
    for (const auto& row : g.edges) {
        edges += row.size();
    }
    return edges;
}

// The marking at the end of a firing sequence; fails if it is none.
Marking played(const PlainNet& net, const std::vector<std::uint32_t>& firings) {
    Marking m = net.initial;
    for (const std::uint32_t t : firings) {
        REQUIRE(t < net.transition_count());
        REQUIRE(net.enabled(m, t));
        for (std::uint32_t u = 0; u < net.transition_count(); ++u) {
            REQUIRE_FALSE((net.level[u] > net.level[t] && net.enabled(m, u)));
        }
        REQUIRE(net.fire(m, t));
    }
    return m;
}

void check_counts(const PlainNet& net, const NaiveGraph& g, const Exploration& e) {
    CHECK(e.ended == Ended::kDone);
    CHECK(e.complete);
    CHECK(e.states == g.markings.size());
    CHECK(e.edges == edges_of(g));
    Marking bounds(net.place_count(), 0);
    std::uint64_t most = 0;
    for (const Marking& m : g.markings) {
        std::uint64_t sum = 0;
        for (std::uint32_t p = 0; p < m.size(); ++p) {
            bounds[p] = std::max(bounds[p], m[p]);
            sum += m[p];
        }
        most = std::max(most, sum);
    }
    CHECK(e.bounds == bounds);
    CHECK(e.max_tokens_in_place == *std::max_element(bounds.begin(), bounds.end()));
    CHECK(e.max_tokens_per_marking == most);
}

TEST_CASE("counts, bounds, deaths and goals are those of the obvious exploration [oracle]") {
    std::uint64_t compared = 0, deaths = 0, reached = 0, missed = 0;
    for (std::uint64_t i = 0; i < 1500 * times(); ++i) {
        RandomStream stream = stream_of(0xE1, i);
        const PlainNet net = test::random_plain_net(stream, {.conserving = i % 3 == 0});
        const NaiveGraph g = naive_graph(net, kMostStates);
        if (!g.complete) {
            continue;
        }
        ++compared;
        INFO("net " << i);
        std::vector<Predicate> goals;
        for (int k = 0; k < 3; ++k) {
            goals.push_back(test::random_predicate(stream, net));
        }
        const Predicate final = test::random_predicate(stream, net);
        ExploreOptions options{.goals = goals, .find_dead = true, .witnesses = true};
        options.final = i % 2 == 0 ? &final : nullptr;
        const Exploration e = explore(net, options, {});
        check_counts(net, g, e);
        const auto is_dead = [&](const Marking& m) {
            for (std::uint32_t t = 0; t < net.transition_count(); ++t) {
                if (net.enabled(m, t) && net.optional[t] == 0) {
                    return false;
                }
            }
            return options.final == nullptr || !final.holds(net, m);
        };
        CHECK(e.dead.found == std::any_of(g.markings.begin(), g.markings.end(), is_dead));
        if (e.dead.found) {
            ++deaths;
            CHECK(is_dead(e.dead.marking));
            CHECK(played(net, e.dead.firings) == e.dead.marking);
        }
        for (std::size_t k = 0; k < goals.size(); ++k) {
            const auto holds = [&](const Marking& m) { return goals[k].holds(net, m); };
            REQUIRE(e.goals[k].found == std::any_of(g.markings.begin(), g.markings.end(), holds));
            (e.goals[k].found ? reached : missed) += 1;
            if (e.goals[k].found) {
                CHECK(holds(e.goals[k].marking));
                CHECK(played(net, e.goals[k].firings) == e.goals[k].marking);
            }
        }
        // The same answers when it may stop early, deep first.
        options.witnesses = false;
        options.stop_when_found = true;
        const Exploration early = explore(net, options, {});
        CHECK(early.ended == Ended::kDone);
        CHECK(early.dead.found == e.dead.found);
        for (std::size_t k = 0; k < goals.size(); ++k) {
            CHECK(early.goals[k].found == e.goals[k].found);
        }
    }
    CHECK(compared > 700);
    CHECK(deaths > 100);
    CHECK(reached > 300);
    CHECK(missed > 300);
}

TEST_CASE("the graph is the obvious graph, state for state and edge for edge [oracle]") {
    for (std::uint64_t i = 0; i < 500 * times(); ++i) {
        RandomStream stream = stream_of(0xE2, i);
        const PlainNet net = test::random_plain_net(stream, {});
        const NaiveGraph g = naive_graph(net, kMostStates);
        if (!g.complete) {
            continue;
        }
        INFO("net " << i);
        std::vector<Predicate> atoms;
        for (std::uint32_t k = 0; k < 1 + i % 70; k += 9) {
            atoms.push_back(test::random_predicate(stream, net));
        }
        const PlainGraph made = build_graph(net, atoms, &atoms[0], {});
        REQUIRE(made.graph.size() == g.markings.size());
        CHECK(made.graph.ended == Ended::kDone);
        for (std::uint32_t s = 0; s < g.markings.size(); ++s) {
            REQUIRE(made.marking(s) == g.markings[s]);
            const auto row = made.graph.edges.row(s);
            REQUIRE(row.size() == g.edges[s].size());
            bool alive = false;
            for (std::size_t k = 0; k < row.size(); ++k) {
                CHECK(row[k].label == g.edges[s][k].first);
                CHECK(row[k].target == g.edges[s][k].second);
            }
            for (std::uint32_t t = 0; t < net.transition_count(); ++t) {
                alive = alive || (net.optional[t] == 0 && net.enabled(g.markings[s], t));
            }
            CHECK(((made.graph.flags[s] & Graph::kOptional) != 0) == (!row.empty() && !alive));
            for (std::uint32_t a = 0; a < atoms.size(); ++a) {
                CHECK(made.graph.atoms.may_hold(s, a) == atoms[a].holds(net, g.markings[s]));
                CHECK(made.graph.atoms.must_hold(s, a) == made.graph.atoms.may_hold(s, a));
            }
            CHECK(((made.graph.flags[s] & Graph::kFinal) != 0) ==
                  atoms[0].holds(net, g.markings[s]));
            CHECK((made.graph.flags[s] & Graph::kCut) == 0);
        }
        const auto last = static_cast<std::uint32_t>(g.markings.size() - 1);
        CHECK(played(net, made.firings_to(last)) == g.markings[last]);
    }
}

// Tokens that walk on rings of places independently of each other: (size choose) closed forms.
PlainNet rings(std::uint32_t count, std::uint32_t size, std::uint32_t tokens) {
    PlainNet net;
    for (std::uint32_t r = 0; r < count; ++r) {
        for (std::uint32_t i = 0; i < size; ++i) {
            const std::uint32_t here = r * size + i, next = r * size + (i + 1) % size;
            net.initial.push_back(i == 0 ? tokens : 0);
            net.takes.items.push_back({here, 1});
            net.gives.items.push_back({next, 1});
            net.takes.starts.push_back(here + 1);
            net.gives.starts.push_back(here + 1);
            net.reads.starts.push_back(0);
            net.unless.starts.push_back(0);
            net.level.push_back(0);
            net.optional.push_back(0);
        }
    }
    return net;
}

TEST_CASE("independent rings have the product of their states, in few bits, on all threads [law]") {
    // k tokens on n places: (n + k - 1 over k) states.
    struct Case {
        std::uint32_t count, size, tokens;
        std::uint64_t states, edges;
    };
    const Case cases[] = {
        {6, 7, 1, 117649, 117649 * 6},        // 7^6; each ring has one token to move
        {2, 4, 9, 48400, 2 * 220 * 220 * 3},  // (12 over 9)^2; edges see below
        {3, 100, 1, 1000000, 3000000},
    };
    for (const Case& c : cases) {
        const PlainNet net = rings(c.count, c.size, c.tokens);
        std::uint64_t edges = c.edges;
        if (c.tokens == 9) {
            // A ring has an edge per state and non-empty place: 4 places, each non-empty in
            // (11 over 8) = 165 of 220 states.
            edges = 2 * 220 * (4 * 165);
        }
        for (const unsigned threads : {1u, 2u, 3u}) {
            Budget budget;
            budget.threads = threads;
            const Exploration e = explore(net, {.find_dead = true}, budget);
            INFO(c.count << " rings, " << threads << " threads");
            CHECK(e.ended == Ended::kDone);
            CHECK(e.complete);
            CHECK(e.states == c.states);
            CHECK(e.edges == edges);
            CHECK(e.max_tokens_in_place == c.tokens);
            CHECK(e.max_tokens_per_marking == c.count * c.tokens);
            CHECK_FALSE(e.dead.found);
            CHECK(e.bits_per_state <= 45);
            if (e.states > 100000) {
                CHECK(static_cast<double>(e.bytes) / static_cast<double>(e.states) <= 16);
            }
        }
    }
}

TEST_CASE("fields grow as far as the net goes, also while threads share them [law]") {
    // A source that stops when a counter is full, by an inhibitor: 0..n tokens in each of 3 places.
    PlainNet net;
    constexpr std::uint32_t kMost = 60;
    for (std::uint32_t p = 0; p < 3; ++p) {
        net.initial.push_back(0);
        net.gives.items.push_back({p, 1});
        net.unless.items.push_back({p, kMost});
        net.takes.starts.push_back(0);
        net.gives.starts.push_back(p + 1);
        net.reads.starts.push_back(0);
        net.unless.starts.push_back(p + 1);
        net.level.push_back(0);
        net.optional.push_back(0);
    }
    for (const unsigned threads : {1u, 2u}) {
        Budget budget;
        budget.threads = threads;
        const Exploration e = explore(net, {.find_dead = true, .witnesses = true}, budget);
        CHECK(e.states == std::uint64_t{kMost + 1} * (kMost + 1) * (kMost + 1));
        CHECK(e.edges == std::uint64_t{3} * kMost * (kMost + 1) * (kMost + 1));
        CHECK(e.bounds == Marking{kMost, kMost, kMost});
        CHECK(e.max_tokens_per_marking == 3 * kMost);
        REQUIRE(e.dead.found);
        CHECK(e.dead.marking == Marking{kMost, kMost, kMost});
        CHECK(played(net, e.dead.firings) == e.dead.marking);
    }
}

// The same net with `factor` times as many tokens everywhere, each place `places` times and each
// transition `transitions` times.
PlainNet enlarged(const PlainNet& net, std::uint32_t factor, std::uint32_t places,
                  std::uint32_t transitions) {
    PlainNet out;
    for (std::uint32_t k = 0; k < places; ++k) {
        for (const std::uint32_t count : net.initial) {
            out.initial.push_back(count * factor);
        }
    }
    const auto copy = [&](const net::Rows<net::Weighted>& from, net::Rows<net::Weighted>& to,
                          std::uint32_t t) {
        for (std::uint32_t k = 0; k < places; ++k) {
            for (const net::Weighted& w : from.row(t)) {
                to.items.push_back({w.place + k * net.place_count(), w.weight * factor});
            }
        }
        to.starts.push_back(static_cast<std::uint32_t>(to.items.size()));
    };
    for (std::uint32_t k = 0; k < transitions; ++k) {
        for (std::uint32_t t = 0; t < net.transition_count(); ++t) {
            copy(net.takes, out.takes, t);
            copy(net.gives, out.gives, t);
            copy(net.reads, out.reads, t);
            copy(net.unless, out.unless, t);
            out.level.push_back(net.level[t]);
            out.optional.push_back(net.optional[t]);
        }
    }
    out.has_levels = net.has_levels;
    return out;
}

TEST_CASE("a state comes to need another word while threads are at it [law]") {
    // 33 places fill to three tokens, one after the other; no invariant bounds them. Beside them a
    // counter goes up and down, another up: 100 * 16 * 16 markings, in the end of more than 64
    // bits.
    constexpr std::uint32_t kSteps = 33, kUp = kSteps, kCount = kSteps + 1;
    PlainNet net;
    net.initial.assign(kSteps + 2, 0);
    const auto add = [&](net::Rows<net::Weighted>& rows, std::vector<net::Weighted> row) {
        rows.items.insert(rows.items.end(), row.begin(), row.end());
        rows.starts.push_back(static_cast<std::uint32_t>(rows.items.size()));
    };
    const auto transition = [&](std::vector<net::Weighted> takes, std::vector<net::Weighted> gives,
                                std::vector<net::Weighted> reads,
                                std::vector<net::Weighted> unless) {
        add(net.takes, std::move(takes));
        add(net.gives, std::move(gives));
        add(net.reads, std::move(reads));
        add(net.unless, std::move(unless));
        net.level.push_back(0);
        net.optional.push_back(0);
    };
    for (std::uint32_t k = 0; k < kSteps; ++k) {
        transition({}, {{k, 1}},
                   k > 0 ? std::vector<net::Weighted>{{k - 1, 3}} : std::vector<net::Weighted>{},
                   {{k, 3}});
    }
    transition({}, {{kUp, 1}}, {}, {{kUp, 15}});
    transition({}, {{kCount, 1}}, {}, {{kCount, 15}});
    transition({{kCount, 1}}, {}, {}, {});
    for (unsigned threads = 1; threads <= 4; ++threads) {
        Budget budget;
        budget.threads = threads;
        const Exploration e = explore(net, {}, budget);
        CHECK(e.complete);
        CHECK(e.states == 100 * 16 * 16);
        CHECK(e.edges == 99 * 256 + 100 * (15 * 16) * 3);
        CHECK(e.bits_per_state > 64);
    }
}

TEST_CASE("large counts, many places and many transitions change nothing but the numbers [law]") {
    struct Size {
        std::uint32_t factor, places, transitions;
    };
    std::uint64_t compared = 0, longest = 0;
    for (std::uint64_t i = 0; i < 120 * times(); ++i) {
        RandomStream stream = stream_of(0xE4, i);
        const PlainNet net = test::random_plain_net(stream, {.conserving = i % 2 == 0});
        const NaiveGraph g = naive_graph(net, 400);
        if (!g.complete) {
            continue;
        }
        Exploration small = explore(net, {.find_dead = true}, {});
        for (const Size size : {Size{5000, 1, 1}, Size{1 << 20, 1, 1}, Size{1, 9, 1},
                                Size{300, 3, 1}, Size{1, 1, 400}, Size{2000, 2, 300}}) {
            ++compared;
            const PlainNet large = enlarged(net, size.factor, size.places, size.transitions);
            const Exploration e = explore(large, {.find_dead = true}, {});
            INFO("net " << i << ", tokens x " << size.factor << ", places x " << size.places
                        << ", transitions x " << size.transitions);
            CHECK(e.complete);
            CHECK(e.states == small.states);
            CHECK(e.edges == small.edges * size.transitions);
            CHECK(e.dead.found == small.dead.found);
            CHECK(e.max_tokens_per_marking ==
                  small.max_tokens_per_marking * size.factor * size.places);
            for (std::uint32_t p = 0; p < e.bounds.size(); ++p) {
                CHECK(e.bounds[p] == small.bounds[p % net.place_count()] * size.factor);
            }
            longest = std::max<std::uint64_t>(longest, e.bits_per_state);
            const PlainGraph graph = build_graph(large, {}, nullptr, {});
            CHECK(graph.graph.size() == e.states);
            CHECK(graph.graph.edges.items.size() == e.edges);
        }
    }
    CHECK(compared > 200);
    CHECK(longest > 128);  // more than two words
}

TEST_CASE("threads agree on random nets that are large enough for them [agree]") {
    std::uint64_t compared = 0;
    for (std::uint64_t i = 0; i < 400 && compared < 6 * times(); ++i) {
        RandomStream stream = stream_of(0xE3, i);
        const PlainNet net = test::random_plain_net(stream, {.conserving = i % 2 == 0});
        Budget budget;
        budget.states = 150'000;
        const Exploration one = explore(net, {.find_dead = true}, budget);
        if (!one.complete || one.states < 25'000) {
            continue;
        }
        ++compared;
        budget.threads = 2;
        const Exploration two = explore(net, {.find_dead = true}, budget);
        INFO("net " << i);
        CHECK(two.complete);
        CHECK(two.states == one.states);
        CHECK(two.edges == one.edges);
        CHECK(two.bounds == one.bounds);
        CHECK(two.max_tokens_per_marking == one.max_tokens_per_marking);
        CHECK(two.dead.found == one.dead.found);
    }
}

TEST_CASE("each budget ends an exploration that would not end, with what is known [unit]") {
    PlainNet net = rings(1, 2, 1);
    net.gives.items.push_back({0, 1});  // the last transition gives a token more
    net.gives.items.back() = {1, 1};
    net.gives.starts.back() = 3;
    Budget budget;
    for (const unsigned threads : {1u, 2u}) {
        budget.threads = threads;
        SUBCASE("states") {
            budget.states = 30'000;
            const Exploration e = explore(net, {.find_dead = true}, budget);
            CHECK(e.ended == Ended::kStates);
            CHECK_FALSE(e.complete);
            CHECK(e.states >= 30'000);
        }
        SUBCASE("memory") {
            budget.bytes = 2 << 20;
            const Exploration e = explore(net, {}, budget);
            CHECK(e.ended == Ended::kMemory);
            CHECK(e.bytes <= budget.bytes * 2);
        }
        SUBCASE("time") {
            budget.seconds = 0.05;
            const Exploration e = explore(net, {}, budget);
            CHECK(e.ended == Ended::kTime);
            CHECK(e.seconds < 5);
        }
        SUBCASE("cancelled") {
            const std::atomic<bool> cancelled{true};
            budget.cancelled = &cancelled;
            CHECK(explore(net, {}, budget).ended == Ended::kCancelled);
            const PlainGraph g = build_graph(net, {}, nullptr, budget);
            CHECK(g.graph.ended == Ended::kCancelled);
            CHECK(g.graph.size() > 0);
            CHECK((g.graph.flags[0] & Graph::kCut) != 0);
        }
    }
}

TEST_CASE("nets without places, transitions or tokens have one state [unit]") {
    PlainNet net;
    Exploration e = explore(net, {.find_dead = true}, {});
    CHECK(e.states == 1);
    CHECK(e.edges == 0);
    CHECK(e.dead.found);
    net.initial = {7, 0};
    e = explore(net, {.find_dead = true}, {});
    CHECK(e.states == 1);
    CHECK(e.bounds == Marking{7, 0});
    CHECK(e.max_tokens_per_marking == 7);
    CHECK(e.dead.marking == Marking{7, 0});
}

}  // namespace
}  // namespace puppetri::proof
