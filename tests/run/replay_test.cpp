// SPDX-License-Identifier: MIT
// Logs held against nets: what a net has done it can do, and what was tampered with is found.
#include "puppetri/run/replay.h"

#include <doctest/doctest.h>

#include <cstdlib>

#include "net/maker.h"
#include "puppetri/run/player.h"
#include "support/random_net.h"

namespace puppetri::run {
namespace {

class Recorder final : public LogSink {
 public:
    std::vector<Observed> log;
    void fired(SimTime at, net::TransitionIndex t) override { log.push_back({at, t}); }
};

std::vector<Observed> played(const net::Net& net, std::uint64_t seed, std::uint64_t firings) {
    Recorder recorder;
    Player player(net, {.seed = seed, .sink = &recorder});
    player.run({.until = net::seconds(1000), .firings = firings});
    return recorder.log;
}

std::string text_of(const Replayed& r) {
    std::string text;
    if (r.deviation) {
        text = "kind " + std::to_string(static_cast<int>(r.deviation->kind)) + " at " +
               std::to_string(r.deviation->index);
        for (const std::string& reason : r.deviation->reasons) {
            text += "\n  " + reason;
        }
    }
    return text;
}

bool has_reason(const Replayed& r, const std::string& part) {
    return r.deviation && !r.deviation->reasons.empty() &&
           r.deviation->reasons[0].find(part) != std::string::npos;
}

// serve: queue + idle -> chair (3 s); leave: chair -> idle; the door opens by an event, twice.
struct Shop {
    net::Maker make;
    Shop(net::DurationDraft service, bool delay = false) {
        make.place("queue", 2);
        make.place("idle", 1);
        if (delay) {
            make.place("chair");
        } else {
            make.place("chair", 0, service);
        }
        make.t("serve", {"queue", "idle"}, {"chair"});
        net::TransitionDraft& leave = make.t("leave", {"chair"}, {"idle"});
        if (delay) {
            leave.delay = net::DelayDraft{.duration = service};
        }
    }
    Replayed replay(std::initializer_list<std::pair<double, const char*>> log,
                    const ReplayOptions& options = {}) {
        const net::Net net = net::compile(make.draft).value();
        std::vector<Observed> observed;
        for (const auto& [at, name] : log) {
            observed.push_back({net::seconds(at), net.find_transition(name)});
        }
        return run::replay(net, observed, options);
    }
};

}  // namespace

TEST_CASE("a log of constant times: what fits, and each way of parting from it") {
    for (const bool delay : {false, true}) {
        CAPTURE(delay);
        Shop shop(net::lasts(3), delay);
        CHECK(text_of(shop.replay({{0, "serve"}, {3, "leave"}, {3, "serve"}, {6, "leave"}})) == "");
        const Replayed early = shop.replay({{0, "serve"}, {2, "leave"}});
        REQUIRE(early.deviation.has_value());
        CHECK(early.deviation->kind == Deviation::Kind::kCannotFire);
        CHECK(early.deviation->index == 1);
        CHECK(has_reason(early, "1 s too early"));
        CHECK(early.firings == 1);
        const Replayed late = shop.replay({{0, "serve"}, {3.5, "leave"}});
        REQUIRE(late.deviation.has_value());
        CHECK(late.deviation->kind == Deviation::Kind::kMissed);
        CHECK(late.deviation->at == net::seconds(3));
        CHECK(has_reason(late, "leave"));
        // Both wait at 0: nobody may let time pass
        CHECK(shop.replay({{1, "serve"}}).deviation->kind == Deviation::Kind::kMissed);
        const Replayed twice = shop.replay({{0, "serve"}, {0, "serve"}});
        CHECK(has_reason(twice, "idle"));
        CHECK(has_reason(twice, "none"));
        const Replayed back = shop.replay({{0, "serve"}, {3, "leave"}, {3, "serve"}, {2, "leave"}});
        CHECK(back.deviation->kind == Deviation::Kind::kOutOfOrder);
        // Clocks that are wrong by a tenth
        CHECK(
            text_of(shop.replay({{0.05, "serve"}, {2.95, "leave"}, {3.02, "serve"}, {6.1, "leave"}},
                                {.tolerance = net::seconds(0.1)})) == "");
        CHECK(shop.replay({{0, "serve"}, {2.75, "leave"}}, {.tolerance = net::seconds(0.1)})
                  .deviation);
        CHECK(shop.replay({{0, "serve"}, {3.25, "leave"}}, {.tolerance = net::seconds(0.1)})
                  .deviation);
    }
}

TEST_CASE("what the log leaves open is taken in its favour, within the net's bounds") {
    for (const bool delay : {false, true}) {
        CAPTURE(delay);
        Shop drawn(net::exponential(3), delay);
        CHECK(text_of(drawn.replay(
                  {{0, "serve"}, {0.1, "leave"}, {0.1, "serve"}, {70, "leave"}})) == "");
        Shop between(net::between(net::seconds(2).ticks, net::seconds(4).ticks), delay);
        CHECK(text_of(between.replay({{0, "serve"}, {2, "leave"}, {2, "serve"}, {6, "leave"}})) ==
              "");
        CHECK(has_reason(between.replay({{0, "serve"}, {1.5, "leave"}}), "0.5 s too early"));
        CHECK(between.replay({{0, "serve"}, {4.5, "leave"}}).deviation->kind ==
              Deviation::Kind::kMissed);
    }
    // The log has no `serve`
    Shop shop(net::lasts(3));
    const ReplayOptions unseen{.unlogged_fire = true};
    const Replayed r = shop.replay({{3, "leave"}, {6, "leave"}}, unseen);
    CHECK(text_of(r) == "");
    CHECK(r.unseen >= 2);
    CHECK(shop.replay({{3, "leave"}, {5, "leave"}}, unseen).deviation);
}

TEST_CASE("guards, inhibitors and priorities are named") {
    net::Maker make;
    make.place("here", 2);
    make.place("bar", 1);
    const net::DatumIndex n = make.datum("n", {ValueKind::kInt}, 4);
    make.t("guarded", {"here"}, {}).guard =
        net::expr(ExprOp::kLess, make.read(n), Expr::integer(3));
    make.t("barred", {"here", "unless bar"}, {});
    make.t("low", {"here"}, {});
    make.t("high", {"here"}, {}).priority = 2;
    const net::Net net = net::compile(make.draft).value();
    const auto alone = [&](const char* name) {
        const std::vector<Observed> log = {{{0}, net.find_transition(name)}};
        return replay(net, log);
    };
    CHECK(has_reason(alone("guarded"), "n is 4"));
    CHECK(has_reason(alone("barred"), "bar"));
    CHECK(alone("low").deviation->kind == Deviation::Kind::kOvertaken);
    CHECK(has_reason(alone("low"), "high"));
    CHECK(!alone("high").deviation);
}

TEST_CASE("whatever a random net has done it can do again, and the state is the player's") {
    const char* longer = std::getenv("PUPPETRI_LONG");
    const int count = longer != nullptr ? 4000 : 400;
    RandomStream stream{.key = 11};
    test::Features features;
    features.any = false;     // which token was drawn is not in a log
    features.events = false;  // when the outside did something is not in a log
    std::uint64_t firings = 0;
    int whole = 0, nets = 0;
    for (int i = 0; i < count; ++i) {
        const net::NetDraft draft = test::random_net(stream, features);
        const auto net = net::compile(draft);
        if (!net) {
            continue;
        }
        const std::vector<Observed> log = played(*net, 5, 60);
        const Replayed r = replay(*net, log);
        INFO(test::show(draft));
        INFO(text_of(r));
        REQUIRE((!r.deviation || !r.deviation->certain));
        whole += !r.deviation;
        ++nets;
        firings += r.firings;
    }
    CHECK(firings > 2000);
    CHECK(whole > nets * 3 / 4);  // guesses are few, and mostly right
}

TEST_CASE("in a net without luck a log that was tampered with is found where it was") {
    RandomStream stream{.key = 12};
    test::Features features;
    features.any = features.events = features.intervals = features.odds = false;
    int tampered = 0;
    for (int i = 0; i < 300; ++i) {
        // One transition at a time can fire: no ties, so that the net has one run
        const auto net = net::compile(test::random_net(stream, features));
        if (!net || net->paced()) {
            continue;
        }
        std::vector<Observed> log = played(*net, 1, 30);
        bool one_run = log.size() > 4;
        for (std::uint64_t seed = 2; seed < 6; ++seed) {
            one_run = one_run && played(*net, seed, 30) == log;
        }
        if (!one_run) {
            continue;
        }
        // The last one comes later by a second than it can
        log.back().at.ticks += kTicksPerSecond;
        const Replayed r = replay(*net, log);
        if (r.deviation) {
            CHECK(r.deviation->index == log.size() - 1);
            ++tampered;
        }
    }
    CHECK(tampered > 5);
}

}  // namespace puppetri::run
