// SPDX-License-Identifier: MIT
// The timed graphs against runs of the engine on random small nets that use every clause of the
// kernel. A few hundred nets; PUPPETRI_LONG=1 tries 10 000.
#include <doctest/doctest.h>

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "puppetri/base/hash.h"
#include "puppetri/net/chooser.h"
#include "puppetri/net/engine.h"
#include "puppetri/proof/plain_net.h"
#include "puppetri/proof/readiness.h"
#include "puppetri/proof/state_classes.h"
#include "puppetri/proof/timed_exact.h"
#include "support/random_net.h"

using namespace puppetri;
using namespace puppetri::proof;
using namespace puppetri::test;
using net::Engine;

namespace {

std::uint64_t nets_to_try(std::uint64_t usual) {
    return std::getenv("PUPPETRI_LONG") != nullptr ? 10'000 : usual;
}
RandomStream series(std::uint64_t purpose, std::uint64_t i) {
    return {.key = Hash64(purpose).add_u64(i).value(), .count = 0};
}

constexpr std::int64_t kUntil = 7 * kRandomNetUnit;
constexpr std::uint64_t kFirings = 6;

// What is seen of a state.
struct Look {
    std::vector<std::uint32_t> numbers;  // tokens and ready ones, per place
    std::vector<Value> data;
    bool operator==(const Look&) const = default;
    std::string text() const {
        std::string t;
        for (const std::uint32_t x : numbers) {
            t += std::to_string(x) + ",";
        }
        for (const Value v : data) {
            t += "/" + std::to_string(v);
        }
        return t;
    }
};
Look look(const net::State& s) {
    Look l;
    for (const net::Counts& c : s.counts) {
        l.numbers.push_back(c.total);
        l.numbers.push_back(c.ready);
    }
    l.data = s.data;
    return l;
}

struct Firing {
    std::int64_t at = 0;
    std::uint32_t transition = 0;
    Look after;
};
struct Played {
    std::vector<Firing> firings;
    std::string end;  // "limit", "dead", "fault"
    std::string text() const {
        std::string t;
        for (const Firing& f : firings) {
            t += std::to_string(f.at) + ":" + std::to_string(f.transition) + ";";
        }
        return t + end + (firings.empty() ? "" : firings.back().after.text());
    }
};

Played play(const net::Net& net, net::Chooser& chooser, std::uint64_t seed = 1,
            std::uint64_t firings = kFirings, std::int64_t until = kUntil, std::uint32_t events = 0,
            std::span<const Script::Outside> outside = {}) {
    net::EngineOptions options;
    options.free = events != 0;
    options.free_events = events;
    options.beat = kRandomNetUnit;
    options.seed = seed;
    Engine engine(net, chooser, options);
    engine.start();
    for (const Script::Outside& o : outside) {
        engine.occur(o.event, o.at);
    }
    Played played;
    for (;;) {
        if (played.firings.size() == firings) {
            played.end = "limit";
            return played;
        }
        const std::uint64_t before = engine.state().firings;
        const Engine::Outcome o = engine.step(until);
        if (engine.state().firings != before) {
            played.firings.push_back(
                {engine.state().now, engine.state().last, look(engine.state())});
        }
        if (o == Engine::Outcome::kFault) {
            played.end = "fault";
            if (engine.state().firings != before) {
                played.firings.back().after = {};
            }
            return played;
        }
        if (o != Engine::Outcome::kFired) {
            played.end = o == Engine::Outcome::kDead ? "dead" : "limit";
            return played;
        }
    }
}

// All runs of an exact graph within the bounds, in the same notation.
class Runs {
 public:
    Runs(const TimedGraph& g, const net::Net& net) : g_(g) {
        for (std::uint32_t s = 0; s < g.graph.size(); ++s) {
            Look l;
            for (std::uint32_t p = 0; p < net.place_count(); ++p) {
                const net::Counts c = g.tokens(s, {p});
                l.numbers.push_back(c.total);
                l.numbers.push_back(c.ready);
            }
            for (std::uint32_t d = 0; d < net.datum_count(); ++d) {
                l.data.push_back(g.datum(s, {d}));
            }
            looks.push_back(std::move(l));
        }
    }
    // False: more than so many.
    bool collect(std::set<std::string>& out, std::size_t most) {
        out_ = &out;
        most_ = most;
        Played played;
        return walk(g_.graph.initial, 0, played);
    }
    std::vector<Look> looks;

 private:
    bool walk(std::uint32_t s, std::int64_t now, Played& played) {
        if (out_->size() > most_ || ++steps_ > 200'000) {
            return false;
        }
        const Graph& g = g_.graph;
        const auto end = [&](const char* how) {
            played.end = how;
            out_->insert(played.text());
        };
        if (played.firings.size() == kFirings) {
            end("limit");
            return true;
        }
        for (const Stop& stop : g_.stops) {
            if (stop.state == s) {
                const bool fires = stop.label != Edge::kPass;
                if (fires) {
                    played.firings.push_back({now, stop.label, {}});
                }
                end("fault");
                if (fires) {
                    played.firings.pop_back();
                }
            }
        }
        if (g.dead(s) && (g.flags[s] & Graph::kCut) == 0) {
            end("dead");
        }
        for (std::uint32_t e = g.edges.starts[s]; e < g.edges.starts[s + 1]; ++e) {
            const Edge edge = g.edges.items[e];
            const std::int64_t then = now + g.low_ticks[e];
            if (then > kUntil) {
                end("limit");
                continue;
            }
            const bool fires = edge.label != Edge::kPass && (edge.label & Edge::kEvent) == 0;
            if (fires) {
                played.firings.push_back({then, edge.label, looks[edge.target]});
            }
            const bool fine = walk(edge.target, then, played);
            if (fires) {
                played.firings.pop_back();
            }
            if (!fine) {
                return false;
            }
        }
        return true;
    }

    const TimedGraph& g_;
    std::set<std::string>* out_ = nullptr;
    std::size_t most_ = 0, steps_ = 0;
};

// Does some path do these firings, with these markings after each?
// Gives  how many firings can be followed.
std::size_t followed(const Graph& g, const std::vector<Look>& looks, const Played& played,
                     std::vector<std::uint32_t>* last = nullptr) {
    std::vector<std::uint32_t> here = {g.initial};
    for (std::size_t i = 0;; ++i) {
        // Whatever is no firing may happen in between.
        std::vector<bool> seen(g.size(), false);
        for (const std::uint32_t s : here) {
            seen[s] = true;
        }
        for (std::size_t k = 0; k < here.size(); ++k) {
            for (const Edge& e : g.edges.row(here[k])) {
                if ((e.label & Edge::kEvent) != 0 && !seen[e.target]) {  // passes too
                    seen[e.target] = true;
                    here.push_back(e.target);
                }
            }
        }
        if (i == played.firings.size() ||
            (i + 1 == played.firings.size() && played.end == "fault")) {
            if (last != nullptr) {
                *last = here;
            }
            return i;
        }
        std::vector<std::uint32_t> next;
        for (const std::uint32_t s : here) {
            for (const Edge& e : g.edges.row(s)) {
                if (e.label == played.firings[i].transition &&
                    looks[e.target] == played.firings[i].after) {
                    next.push_back(e.target);
                }
            }
        }
        std::sort(next.begin(), next.end());
        next.erase(std::unique(next.begin(), next.end()), next.end());
        if (next.empty()) {
            return i;
        }
        here = std::move(next);
    }
}

std::string differences(const std::set<std::string>& a, const std::set<std::string>& b) {
    std::string text;
    int shown = 0;
    for (const std::string& r : a) {
        if (b.count(r) == 0 && ++shown <= 3) {
            text += "only the engine: " + r + "\n";
        }
    }
    shown = 0;
    for (const std::string& r : b) {
        if (a.count(r) == 0 && ++shown <= 3) {
            text += "only the graph: " + r + "\n";
        }
    }
    return text;
}

const Budget kSmall{.seconds = 5, .states = 700};

// Gives `check` some of the shortest runs, systematically, and five long random ones.
template <class Check>
void play_many(const net::Net& net, std::size_t most, const Check& check,
               const std::uint64_t& failures) {
    net::ExhaustiveChooser all;
    std::size_t tries = 0;
    do {
        check(play(net, all));
    } while (all.next() && ++tries < most && failures < 3);
    net::RandomChooser random;
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
        check(play(net, random, seed, 30, 40 * kRandomNetUnit));
    }
}

TEST_CASE("timed exact has exactly the runs of the exhaustive chooser [oracle]") {
    const std::uint64_t nets = nets_to_try(150);
    std::uint64_t compared = 0, runs = 0, failures = 0, endless = 0;
    for (std::uint64_t i = 0; i < nets && failures < 3; ++i) {
        RandomStream stream = series(11, i);
        const net::NetDraft draft = random_net(stream);
        const Checked<net::Net> net = net::compile(draft);
        if (!net.has_value()) {
            continue;
        }
        std::set<std::string> wanted;
        net::ExhaustiveChooser all;
        std::size_t tries = 0;
        do {
            wanted.insert(play(*net, all).text());
        } while (all.next() && ++tries < 3000);
        if (tries >= 3000) {
            continue;
        }
        const TimedGraph g = timed_exact_graph(
            {.net = *net, .outside_events = 0, .beat = kRandomNetUnit, .budget = kSmall});
        REQUIRE(g.available());
        if (g.graph.ended != Ended::kDone) {
            ++endless;
            continue;
        }
        Runs paths(g, *net);
        std::set<std::string> got;
        if (!paths.collect(got, 4000)) {
            continue;
        }
        ++compared;
        runs += got.size();
        if (got != wanted) {
            ++failures;
            FAIL_CHECK("net " << i << "\n" << show(draft) << differences(wanted, got));
        }
    }
    MESSAGE(compared << " nets compared, " << runs << " runs, " << endless << " unbounded");
    CHECK(compared * 3 > nets);
}

TEST_CASE("no run leaves the readiness graph [law]") {
    const std::uint64_t nets = nets_to_try(150);
    std::uint64_t compared = 0, firings = 0, failures = 0, refused = 0, endless = 0;
    for (std::uint64_t i = 0; i < nets && failures < 3; ++i) {
        RandomStream stream = series(12, i);
        const net::NetDraft draft = random_net(stream);
        const Checked<net::Net> net = net::compile(draft);
        if (!net.has_value()) {
            continue;
        }
        const TimedGraph g = readiness_graph({.net = *net, .outside_events = 0, .budget = kSmall});
        if (!g.available()) {
            ++refused;
            continue;
        }
        if (g.graph.ended != Ended::kDone) {
            ++endless;
            continue;
        }
        ++compared;
        const Runs states(g, *net);
        const auto check = [&](const Played& played) {
            std::vector<std::uint32_t> last;
            const std::size_t n = followed(g.graph, states.looks, played, &last);
            firings += n;
            const bool fault = played.end == "fault";
            const std::size_t whole = played.firings.size();
            bool fine = n >= (fault && whole > 0 ? whole - 1 : whole);
            if (fine && played.end == "dead") {
                fine = std::any_of(last.begin(), last.end(),
                                   [&](std::uint32_t s) { return g.graph.dead(s); });
            }
            if (fine && fault) {
                fine = std::any_of(g.stops.begin(), g.stops.end(), [&](const Stop& s) {
                    return std::find(last.begin(), last.end(), s.state) != last.end();
                });
            }
            if (!fine && ++failures <= 3) {
                FAIL_CHECK("net " << i << "\n"
                                  << show(draft) << played.text() << "\nfollowed " << n << " of "
                                  << whole);
            }
        };
        play_many(*net, 100, check, failures);
    }
    MESSAGE(compared << " nets, " << firings << " firings followed, " << refused << " refused, "
                     << endless << " unbounded");
    CHECK(compared * 3 > nets);
}

TEST_CASE("with events from outside no run leaves the readiness graph, nor the classes [law]") {
    const std::uint64_t nets = nets_to_try(150);
    std::uint64_t compared = 0, firings = 0, failures = 0, scripts = 0;
    for (std::uint64_t i = 0; i < nets && failures < 3; ++i) {
        RandomStream stream = series(16, i);
        net::NetDraft draft = random_net(stream);
        for (std::size_t tries = 0; draft.events.empty() && tries < 20; ++tries) {
            draft = random_net(stream);
        }
        if (!draft.data.empty() && draft.data.back().sensor && i % 2 == 0) {
            draft.events[0].sets = {};  // nobody sets it: free
        }
        const Checked<net::Net> net = net::compile(draft);
        if (!net.has_value() || draft.events.empty()) {
            continue;
        }
        const GraphRequest request{.net = *net, .outside_events = 2, .budget = kSmall};
        for (const bool classes : {false, true}) {
            const TimedGraph g = classes ? class_graph(request) : readiness_graph(request);
            if (!g.available() || g.graph.ended != Ended::kDone || (classes && net->paced())) {
                continue;
            }
            ++compared;
            const Runs states(g, *net);
            net::ExhaustiveChooser all;
            std::size_t tries = 0;
            const auto check = [&](const Played& played) {
                const std::size_t n = followed(g.graph, states.looks, played);
                firings += n;
                const bool fault = played.end == "fault" && !played.firings.empty();
                if (n + (fault ? 1 : 0) < played.firings.size() && ++failures <= 3) {
                    FAIL_CHECK("net " << i << "\n"
                                      << show(draft) << played.text() << "\nfollowed " << n);
                }
            };
            do {
                check(play(*net, all, 1, 5, kUntil, 2));
            } while (all.next() && ++tries < 200 && failures < 3);
            // As a file says it: also at instants at which others raise events.
            net::RandomChooser random;
            for (std::uint64_t seed = 1; seed <= 20; ++seed) {
                const Script::Outside outside[] = {
                    {{static_cast<std::int64_t>(stream.below(5)) * kRandomNetUnit},
                     {static_cast<std::uint32_t>(stream.below(draft.events.size()))}},
                    {{static_cast<std::int64_t>(stream.below(5)) * kRandomNetUnit},
                     {static_cast<std::uint32_t>(stream.below(draft.events.size()))}}};
                check(play(*net, random, seed, 12, 20 * kRandomNetUnit, 0, outside));
            }
            // What comes from outside can be played, too, where nothing else happens at its
            // instant that would come later.
            for (std::uint32_t s = 0; classes && s < g.graph.size() && s < 40; ++s) {
                scripts += g.script(g.path_to(s)).has_value() ? 1 : 0;
            }
        }
    }
    MESSAGE(compared << " graphs, " << firings << " firings followed, " << scripts
                     << " paths played");
    CHECK(compared * 2 > nets);
    CHECK(scripts > nets);
}

TEST_CASE("no run leaves the plain untimed picture, priorities and all [law]") {
    const std::uint64_t nets = nets_to_try(1000);
    std::uint64_t compared = 0, firings = 0, failures = 0, unsound = 0, levels = 0;
    for (std::uint64_t i = 0; i < nets && failures < 3; ++i) {
        RandomStream stream = series(15, i);
        const net::NetDraft draft = random_net(stream);
        const Checked<net::Net> net = net::compile(draft);
        if (!net.has_value()) {
            continue;
        }
        const Plain picture = plain(*net);
        if (picture.unsound) {
            ++unsound;
            continue;
        }
        ++compared;
        const PlainNet& p = picture.net;
        levels += p.has_levels ? 1 : 0;
        const auto check = [&](const Played& played) {
            Marking marking = p.initial;
            for (std::size_t k = 0; k < played.firings.size(); ++k) {
                const Firing& f = played.firings[k];
                if (f.after.numbers.empty()) {
                    return;  // it stopped here
                }
                bool fine = p.enabled(marking, f.transition);
                for (std::uint32_t t = 0; p.has_levels && t < p.transition_count(); ++t) {
                    fine = fine && (p.level[t] <= p.level[f.transition] || !p.enabled(marking, t));
                }
                fine = fine && p.fire(marking, f.transition);
                for (std::uint32_t q = 0; q < p.place_count(); ++q) {
                    fine = fine && marking[q] == f.after.numbers[2 * q];
                }
                if (!fine) {
                    if (++failures <= 3) {
                        FAIL_CHECK("net " << i << "\n"
                                          << show(draft) << played.text() << "\nfiring " << k);
                    }
                    return;
                }
                ++firings;
            }
        };
        play_many(*net, 50, check, failures);
    }
    MESSAGE(compared << " nets, " << firings << " firings followed, " << unsound << " unsound, "
                     << levels << " with levels");
    CHECK(compared * 3 > nets);
}

TEST_CASE("with single durations state classes have exactly the runs of timed exact [agree]") {
    const std::uint64_t nets = nets_to_try(150);
    std::uint64_t compared = 0, runs = 0, failures = 0, refused = 0;
    Features features;
    features.intervals = false;
    for (std::uint64_t i = 0; i < nets && failures < 3; ++i) {
        RandomStream stream = series(13, i);
        const net::NetDraft draft = random_net(stream, features);
        const Checked<net::Net> net = net::compile(draft);
        if (!net.has_value() || net->paced()) {
            continue;
        }
        const GraphRequest request{
            .net = *net, .outside_events = 0, .beat = kRandomNetUnit, .budget = kSmall};
        const TimedGraph classes = class_graph(request);
        if (!classes.available() || !classes.graph.exact) {
            ++refused;
            continue;
        }
        const TimedGraph timed = timed_exact_graph(request);
        if (timed.graph.ended != Ended::kDone || classes.graph.ended != Ended::kDone) {
            continue;
        }
        Runs of_classes(classes, *net);
        Runs of_timed(timed, *net);
        std::set<std::string> a, b;
        if (!of_timed.collect(a, 4000) || !of_classes.collect(b, 4000)) {
            continue;
        }
        ++compared;
        runs += a.size();
        if (a != b) {
            ++failures;
            FAIL_CHECK("net " << i << "\n" << show(draft) << differences(a, b));
        }
    }
    MESSAGE(compared << " nets compared, " << runs << " runs, " << refused << " refused");
    CHECK(compared * 4 > nets);
}

TEST_CASE(
    "no run with durations from intervals leaves the classes, and their paths are runs [law]") {
    const std::uint64_t nets = nets_to_try(150);
    std::uint64_t compared = 0, firings = 0, scripts = 0, failures = 0, refused = 0;
    for (std::uint64_t i = 0; i < nets && failures < 3; ++i) {
        RandomStream stream = series(14, i);
        const net::NetDraft draft = random_net(stream);
        const Checked<net::Net> net = net::compile(draft);
        if (!net.has_value() || net->paced()) {
            continue;
        }
        const TimedGraph g = class_graph({.net = *net, .outside_events = 0, .budget = kSmall});
        if (!g.available()) {
            ++refused;
            continue;
        }
        if (g.graph.ended != Ended::kDone) {
            continue;
        }
        ++compared;
        const Runs states(g, *net);
        const auto check = [&](const Played& played) {
            const std::size_t n = followed(g.graph, states.looks, played);
            firings += n;
            const bool fault = played.end == "fault" && !played.firings.empty();
            if (n + (fault ? 1 : 0) < played.firings.size() && ++failures <= 3) {
                FAIL_CHECK("net " << i << "\n"
                                  << show(draft) << played.text() << "\nfollowed " << n);
            }
        };
        net::RandomChooser random;
        for (std::uint64_t seed = 1; seed <= 10; ++seed) {
            check(play(*net, random, seed, 20, 30 * kRandomNetUnit));
        }
        if (!g.graph.exact) {
            continue;
        }
        // Random walks in the graph.
        for (int walk = 0; walk < 5 && failures < 3; ++walk) {
            std::vector<std::uint32_t> path;
            std::uint32_t s = g.graph.initial;
            while (path.size() < 15 && !g.graph.dead(s)) {
                const std::uint32_t first = g.graph.edges.starts[s];
                const auto e = static_cast<std::uint32_t>(
                    first + stream.below(g.graph.edges.starts[s + 1] - first));
                path.push_back(e);
                s = g.graph.edges.items[e].target;
            }
            std::string trouble;
            ++scripts;
            if (!path.empty() && !g.script(path, &trouble) && ++failures <= 3) {
                std::string text;
                for (const std::uint32_t e : path) {
                    text += g.words_of_edge(e) + "; ";
                }
                FAIL_CHECK("net " << i << "\n" << show(draft) << text << "\n" << trouble);
            }
        }
    }
    MESSAGE(compared << " nets, " << firings << " firings followed, " << scripts
                     << " paths played, " << refused << " refused");
    CHECK(compared * 4 > nets);
}

}  // namespace
