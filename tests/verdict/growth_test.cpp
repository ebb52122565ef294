// SPDX-License-Identifier: MIT
// Places that grow without end: refuted by a run that comes back with more, or because every run
// feeds a place that nothing takes from; and where covering an ancestor proves nothing. 200 random
// nets; PUPPETRI_LONG=1 takes 10 000.
#include <algorithm>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include "proved_scene.h"
#include "puppetri/net/chooser.h"
#include "puppetri/proof/timed_exact.h"
#include "puppetri/run/player.h"
#include "puppetri/verdict/obligation.h"
#include "support/random_net.h"

namespace puppetri::verdict {
namespace {

// The loop of the witness, twenty times more: the same firings, as far apart, and each round some
// place holds more than after the round before.
bool goes_on(const net::Net& net, const Witness& w, SimTime beat) {
    std::vector<run::OutsideEvent> events;
    for (const Witness::Event& e : w.events) {
        events.push_back({e.at, net.find_event(e.path)});
    }
    const auto player_of = [&](net::Chooser& chooser) {
        run::Options options;
        options.chooser = &chooser;
        options.beat = beat;
        auto player = std::make_unique<run::Player>(net, options);
        player->schedule(events);
        return player;
    };
    const std::size_t loop = w.steps.size() - w.lasso_from;
    net::ScriptedChooser script(w.choices);
    auto player = player_of(script);
    std::size_t from = 0;
    const auto total = [&](const run::Player& p) {
        std::vector<std::uint32_t> counts;
        for (std::uint32_t i = 0; i < net.place_count(); ++i) {
            counts.push_back(p.tokens(net::PlaceIndex{i}));
        }
        return counts;
    };
    for (std::size_t i = 0; i < w.steps.size(); ++i) {
        from = i == w.lasso_from ? script.used() : from;
        if (player->step() != run::Stop::kNone || player->now() != w.steps[i].at) {
            return false;
        }
    }
    std::vector<std::int64_t> longer = w.choices;
    constexpr int kRounds = 20;
    for (int k = 0; k < kRounds; ++k) {
        longer.insert(longer.end(), w.choices.begin() + static_cast<std::ptrdiff_t>(from),
                      w.choices.end());
    }
    net::ScriptedChooser again(longer);
    player = player_of(again);
    for (std::size_t i = 0; i < w.steps.size(); ++i) {
        if (player->step() != run::Stop::kNone) {
            return false;
        }
    }
    std::vector<std::uint32_t> before = total(*player);
    SimTime began = player->now();
    const SimTime start = w.lasso_from == 0 ? SimTime{} : w.steps[w.lasso_from - 1].at;
    for (int k = 0; k < kRounds && events.empty(); ++k) {
        for (std::size_t i = 0; i < loop; ++i) {
            const Witness::Step& step = w.steps[w.lasso_from + i];
            if (player->step() != run::Stop::kNone ||
                net.transition(player->last()).path != step.transition ||
                player->now() - began != step.at - start) {
                return false;
            }
        }
        const std::vector<std::uint32_t> after = total(*player);
        bool more = false;
        for (std::size_t p = 0; p < after.size(); ++p) {
            if (after[p] < before[p]) {
                return false;
            }
            more = more || after[p] > before[p];
        }
        if (!more) {
            return false;
        }
        before = after;
        began = player->now();
    }
    return true;
}

void check_pump(const ProvedScene& s, const std::string& rule, const std::string& place) {
    CHECK(s.says(rule) == "REFUTED");
    const Verdict& v = s.of(rule);
    CHECK_MESSAGE(v.reason.find("place " + place + " grows without end") != std::string::npos,
                  v.reason);
    REQUIRE(v.witness);
    REQUIRE(v.witness->lasso_from != Witness::kNone);
    CHECK(goes_on(s.scene->net, *v.witness, s.scene->beat));
}

TEST_CASE("a place that a loop feeds and nothing empties grows, and the loop is shown [oracle]") {
    const ProvedScene s(R"(
place a  takes 1 s  tokens 1
place heap
again: a -> a + heap
rule calm  bounded
rule here  bounded(heap)
rule there bounded(a, by: 1)
)");
    check_pump(s, "calm", "heap");
    check_pump(s, "here", "heap");
    CHECK(s.says("there") == "PROVED");
}

TEST_CASE("a queue grows where customers come faster than they are served [oracle]") {
    const std::string shop = R"(
place queue
place barber  tokens 1
place chair  takes 20 s
arrive: street -> street + queue
serve:  queue + barber -> chair
done:   chair -> barber
rule calm bounded
)";
    check_pump(ProvedScene("place street  takes 10 s  tokens 1" + shop), "calm", "queue");
    // Without time it grows all the same; with these times it does not.
    const ProvedScene slow("place street  takes 20 s  tokens 1" + shop);
    CHECK(slow.says("calm") == "PROVED");
    CHECK(slow.of("calm").method == "exact time");
}

TEST_CASE("what tests the place from above ends the growth: nothing is refuted [oracle]") {
    const char* ends[] = {
        "again: a -> a + heap  unless 4*heap\nover: a -> done  with 4*heap",
        "again: a -> a + heap\ndrain: 4*heap ->  priority 2",
        "again: a -> a + heap\nstop: a -> done  priority 2 when #heap >= 5",
        "again: a -> a + heap\nstop: a -> done  priority 2 with 6*heap",
        "again: a -> a + heap\nempty: clock + all heap -> clock",
    };
    for (const char* end : ends) {
        const ProvedScene s(
            "place a  takes 1 s  tokens 1\nplace clock  takes 10 s  tokens 1\nplace heap\nplace "
            "done\n" +
            std::string(end) + "\nrule calm bounded\n");
        CHECK_MESSAGE(s.of("calm").answer != Answer::kRefuted, end << ": " << s.of("calm").reason);
    }
}

TEST_CASE("whatever the timing: a place that every run feeds grows, drawn times or not [law]") {
    const ProvedScene s(R"(
place a  takes exponential(1 s)  tokens 1
place b  takes uniform(1 s, 2 s)
place heap
ab: a -> b + heap
ba: b -> a
rule calm bounded
)");
    CHECK(s.says("calm") == "REFUTED");
    CHECK(s.of("calm").reason.find("in every run ab fires again and again") != std::string::npos);
    REQUIRE(s.of("calm").witness);
    // Who may as well never feed it is not known to.
    const ProvedScene other(R"(
place a  takes exponential(1 s)  tokens 1
place heap
feed: a -> a + heap
rest: a -> a
rule calm bounded
)");
    CHECK(other.of("calm").answer == Answer::kUnknown);
    CHECK_MESSAGE(other.of("calm").reason.find("heap") != std::string::npos,
                  other.of("calm").reason);
}

TEST_CASE("what does not read the growing place is answered as if it were not there [oracle]") {
    const ProvedScene s(R"(
place a  takes 1 .. 2 s  tokens 1
place b  takes exponential(1 s)
place heap  takes 3 s
ab: a -> b + heap
ba: b -> a
rule one       exactly_one(a, b)
rule goes_on   deadlock_free
rule turns     alternate(ab, ba)
rule returns   b leads to a
rule in_time   a leads to b within 2 s
rule has       ba only if heap
rule had_not   never (a and heap)
rule many      always #heap <= 3
rule alive     live
rule back      reversible
)");
    CHECK(s.says("one") == "PROVED");
    CHECK(s.says("goes_on") == "PROVED");
    CHECK(s.says("turns") == "PROVED");
    CHECK(s.says("returns") == "PROVED for every choice");
    CHECK(s.says("in_time") == "PROVED for every choice");
    CHECK(s.says("has") == "PROVED");
    CHECK(s.says("had_not") == "REFUTED");
    CHECK(s.says("many") == "REFUTED");
    CHECK(s.of("alive").answer == Answer::kProved);
    CHECK(s.of("back").answer != Answer::kProved);
    for (const Verdict& v : s.verdicts) {
        CHECK_MESSAGE(v.seconds < 10, v.rule);
    }
}

TEST_CASE("on random nets only what grows is refuted, and its round goes on [agree]") {
    const char* wanted = std::getenv("PUPPETRI_LONG");
    const int nets = wanted != nullptr ? 10'000 : 200;
    int refuted = 0, finite = 0, rounds = 0;
    for (int i = 0; i < nets; ++i) {
        RandomStream stream{stream_key(static_cast<std::uint64_t>(i), "growth", "net"), 0};
        test::Features features;
        features.capacities = features.records = features.any = false;
        net::NetDraft draft = test::random_net(stream, features);
        {
            // A clock feeds one of its places: whether that grows is up to the rest.
            net::PlaceDraft clock;
            clock.path = "clock";
            clock.duration = net::DurationDraft::constant(
                SimTime{test::kRandomNetUnit * static_cast<std::int64_t>(1 + stream.below(3))});
            clock.tokens.push_back({});
            const net::PlaceIndex here{static_cast<std::uint32_t>(draft.places.size())};
            const net::PlaceIndex fed{
                static_cast<std::uint32_t>(stream.below(draft.places.size()))};
            draft.places.push_back(std::move(clock));
            net::TransitionDraft feed;
            feed.path = "feed";
            feed.inputs.push_back({.place = here});
            feed.outputs.push_back({.place = here});
            feed.outputs.push_back({.place = fed});
            draft.transitions.push_back(std::move(feed));
            net::Rule rule;
            rule.path = "calm";
            rule.kind = net::RuleKind::kBounded;
            rule.count = kNoCount;
            draft.rules = {rule};
        }
        const auto net = net::compile(draft);
        if (!net) {
            continue;  // the fed place is a module's
        }
        ProveOptions options;
        options.built_in = false;
        options.budget.seconds = 1;
        options.budget.states = 12;  // graphs prove nothing: all is left to the runs
        options.outside_events = 0;
        const Verdict v = prove(draft, *net, options).front();
        if (v.answer != Answer::kRefuted) {
            continue;
        }
        ++refuted;
        proof::Budget budget;
        budget.seconds = 1;
        budget.states = 3000;
        const proof::TimedGraph exact =
            proof::timed_exact_graph({.net = *net, .outside_events = 0, .budget = budget});
        const bool whole =
            exact.available() && exact.graph.over && exact.graph.ended == proof::Ended::kDone;
        finite += whole ? 1 : 0;
        CHECK_MESSAGE(!whole, "net " << i << ": " << v.reason << "\n" << test::show(draft));
        if (v.witness && v.witness->lasso_from != Witness::kNone) {
            ++rounds;
            CHECK_MESSAGE(goes_on(*net, *v.witness, SimTime{kTicksPerSecond}),
                          "net " << i << ": " << v.reason << "\n"
                                 << test::show(draft));
        }
    }
    MESSAGE(refuted << " refuted, " << rounds << " rounds gone on with");
    CHECK(rounds > nets / 20);
}

}  // namespace
}  // namespace puppetri::verdict
