// SPDX-License-Identifier: MIT
// The player: limits, outside events, recordings, snapshots.
#include "puppetri/run/player.h"

#include <doctest/doctest.h>

#include "net/maker.h"
#include "puppetri/base/random.h"

namespace puppetri::run {
namespace {

using net::lasts;
using net::Maker;
using net::seconds;

struct Firings final : LogSink {
    void fired(SimTime at, net::TransitionIndex t) override {
        list.emplace_back(at.ticks, t.value);
    }
    std::vector<std::pair<std::int64_t, std::uint32_t>> list;
};

// Clocks, a buffer, ties, distributions, attributes, and three events from outside.
Maker model() {
    Maker m;
    for (const char* name : {"e0", "e1", "e2"}) {
        m.event(name);
    }
    m.place("idle", 2);
    m.place("busy", 0, net::exponential(0.7));
    m.place("buffer").capacity = 3;
    m.place("lamp", 1, lasts(0.25));
    m.t("arrive", {}, {"buffer"}).delay = net::DelayDraft{net::exponential(0.5)};
    m.t("start", {"buffer", "idle"}, {"busy"});
    m.t("end", {"busy"}, {"idle"});
    m.t("blink", {"lamp"}, {"lamp"});
    m.t("push", {"now busy"}, {"idle"}).events = {{0}};
    m.t("clear", {"all buffer"}, {}).events = {{1}, {2}};
    return m;
}

TEST_CASE("same net, seed and events: same log; another seed: another log [law]") {
    const net::Net n = model().net();
    const auto hash = [&](std::uint64_t seed) {
        Player p(n, {.seed = seed});
        p.run({.until = seconds(100)});
        return p.log_hash();
    };
    CHECK(hash(1) == hash(1));
    CHECK(hash(1) != hash(2));
}

TEST_CASE("limits: a time, frames, firings [unit]") {
    const net::Net n = model().net();
    Player p(n);
    CHECK(p.run({.until = seconds(10)}) == Stop::kLimit);
    CHECK(p.now() == seconds(10));
    CHECK(p.run({.firings = p.firings() + 7}) == Stop::kLimit);
    Player q(n);
    CHECK(q.run(Limits::frames(48, {kTicksPerSecond / 24})) == Stop::kLimit);
    CHECK(q.now() == seconds(2));
    Player r(n);
    CHECK(r.run({.firings = 25}) == Stop::kLimit);
    CHECK(r.firings() == 25);
    CHECK(r.step({.firings = 25}) == Stop::kLimit);
    CHECK(r.step() == Stop::kNone);
    CHECK(r.firings() == 26);
}

TEST_CASE("the end of a net is dead, or final if it is declared so [unit]") {
    Maker m;
    m.place("a", 1, lasts(1));
    m.t("t", {"a"}, {"b"});
    const net::Net first = m.net();
    Player p(first);
    CHECK(p.run({}) == Stop::kDead);
    net::FinalMarkingDraft end;
    end.condition = net::Formula::marked(m.p("b"));
    m.draft.finals.push_back(end);
    const net::Net second = m.net();
    Player q(second);
    CHECK(q.run({}) == Stop::kFinal);
    CHECK(q.tokens(second.find_place("b")) == 1);
}

TEST_CASE("a recorded session replays with one hash, however the events came in [law]") {
    const net::Net n = model().net();
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
        RandomStream dice{seed, 0};
        Player live(n, {.seed = seed, .record = true});
        for (int i = 0; i < 300; ++i) {
            switch (dice.below(4)) {
                case 0:
                    live.push({static_cast<std::uint32_t>(dice.below(3))});
                    break;
                case 1:
                    live.step({.until = seconds(1000)});
                    break;
                case 2:
                    live.advance_to(live.now() + SimTime{dice.between(0, kTicksPerSecond / 3)});
                    break;
                default:
                    live.run({.firings = live.firings() + dice.below(5)});
                    break;
            }
        }
        live.advance_to(seconds(400));
        Player replay(n, {.seed = seed});
        replay.schedule(live.recording());
        replay.run({.until = seconds(400)});
        CHECK(live.recording().size() > 20);
        CHECK(replay.firings() == live.firings());
        CHECK(replay.log_hash() == live.log_hash());
    }
}

TEST_CASE("a snapshot restores at any instant, also between two firings of one [law]") {
    const net::Net n = model().net();
    Player p(n, {.seed = 3});
    const std::vector<OutsideEvent> events = {
        {seconds(1), {0}}, {seconds(2), {1}}, {seconds(9), {2}}};
    p.schedule(events);
    for (int i = 0; i < 200; ++i) {
        p.step();
        const std::vector<std::uint8_t> bytes = p.snapshot();
        Player q(n, {.seed = 3});
        q.run({.firings = 50});  // somewhere else
        REQUIRE(q.restore(bytes));
        CHECK(q.now() == p.now());
        Player again(n, {.seed = 3});
        again.schedule(events);
        again.run({.firings = p.firings() + 30});
        q.run({.firings = p.firings() + 30});
        CHECK(q.log_hash() == again.log_hash());
        CHECK(q.snapshot() == again.snapshot());
    }
    CHECK_FALSE(p.restore({}));
    CHECK(p.firings() == 200);
}

TEST_CASE("the log sink hears every firing in order [unit]") {
    const net::Net n = model().net();
    Firings log;
    Player p(n, {.seed = 1, .sink = &log});
    p.run({.firings = 100});
    REQUIRE(log.list.size() == 100);
    for (std::size_t i = 1; i < log.list.size(); ++i) {
        CHECK(log.list[i - 1].first <= log.list[i].first);
    }
    CHECK(log.list.back().second == p.last().value);
}

}  // namespace
}  // namespace puppetri::run
