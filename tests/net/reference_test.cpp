// SPDX-License-Identifier: MIT
// The reference nets whose logs were worked out by hand.
#include <doctest/doctest.h>

#include <map>

#include "maker.h"
#include "reference_nets.h"

namespace puppetri::net {
namespace {

constexpr double kFrame = 1.0 / 24;

TEST_CASE("the walk of three steps fires at frames 0, 10, 30, 50, 60 [oracle]") {
    Run run(walk_net(3));
    CHECK(run.until(100) == Engine::Outcome::kDead);
    CHECK(run.engine.in_final_marking());
    CHECK(run.log.text == "0:t1 0.416667:t2 1.25:t3 1.25:t5 2.083333:t8 2.5:t10");
    CHECK(run.tokens("P5") == 1);
    CHECK(run.tokens("P9") == 1);
}

TEST_CASE("k steps last exactly 20 k frames and end with P8 for odd k, P7 for even [law]") {
    for (int k = 1; k <= 6; ++k) {
        Run run(walk_net(k));
        run.until(100);
        CHECK(run.engine.state().now == seconds(20 * kFrame * k).ticks);
        const std::string last = k % 2 == 1 ? "t10" : "t9";
        CHECK(run.net.transition({run.engine.state().last}).path == last);
    }
}

// `place` runs a walk of so many steps.
void add_walk(Maker& m, const std::string& place, int steps, std::uint32_t& actions) {
    const std::string w = place + ".";
    const double n = 20 * kFrame;
    for (const auto& [name, s] :
         {std::pair{"P2", n / 2}, {"P4", n}, {"P6", n}, {"P7", n / 2}, {"P8", n / 2}}) {
        m.place(w + name, 0, lasts(s)).action = ActionIndex{actions++};
    }
    const auto t = [&](const char* name, std::vector<std::string> in, std::vector<std::string> out,
                       int priority) {
        for (auto* list : {&in, &out}) {
            for (std::string& arc : *list) {
                const std::size_t at = arc.find('P');
                arc.insert(at, w);
            }
        }
        m.t(w + name, in, out).priority = priority;
    };
    t("t1", {"P1"}, {"P2", "P3"}, 1);
    t("t2", {"P2", "unless P5"}, {"P4", "P3"}, 2);
    t("t3", {"P4", "unless P5"}, {"P6", "P3"}, 2);
    t("t4", {"P6", "unless P5"}, {"P4", "P3"}, 2);
    t("t5", {std::to_string(steps) + "*P3"}, {"P5"}, 1);
    t("t6", {"P4"}, {"P7"}, 1);
    t("t7", {"P2"}, {"P8"}, 1);
    t("t8", {"P6"}, {"P8"}, 1);
    t("t9", {"P7"}, {"P9"}, 1);
    t("t10", {"P8"}, {"P9"}, 1);
    t("leave", {"P9", "P5"}, {"Pdone"}, 1);
    RefinementDraft r;
    r.place = m.p(place);
    r.start = {m.p(w + "P1")};
    r.finish = {m.p(w + "Pdone")};
    for (const char* inside : {"P1", "P2", "P3", "P4", "P5", "P6", "P7", "P8", "P9", "Pdone"}) {
        r.inside.push_back(m.p(w + inside));
    }
    m.draft.refinements.push_back(r);
    m.place(place).duration.reset();
}

struct QuietHost final : MovementHost {
    SimTime begin(ActionIndex, ActivityIndex, SimTime, SimTime duration,
                  std::span<const std::int64_t>) override {
        return duration;
    }
    std::span<const RaisedEvent> raised(ActivityIndex) override { return {}; }
    void cut(ActivityIndex, SimTime) override {}
    void left(ActivityIndex, SimTime) override {}
};

Net ball_game(bool with_walks = false) {
    Maker m = ball_game_maker();
    if (with_walks) {
        std::uint32_t actions = 0;
        for (std::uint32_t i = 1; i <= 20; ++i) {
            const std::string name = "P" + std::to_string(i);
            if (i != 9 && i != 11 && i != 1 && i != 5 && i != 13 && i != 17) {
                m.place(name).action = ActionIndex{actions++};
            }
        }
        for (const char* place : {"P1", "P5", "P13", "P17"}) {
            add_walk(m, place, place == std::string("P5") ? 2 : 3, actions);
        }
    }
    return m.net();
}

TEST_CASE("the ball game keeps its five invariants after every firing [law]") {
    Run run(ball_game());
    const auto sum = [&](std::initializer_list<const char*> places) {
        std::uint32_t total = 0;
        for (const char* p : places) {
            total += run.tokens(p);
        }
        return total;
    };
    for (int i = 0; i < 2000; ++i) {
        REQUIRE(run.engine.step() == Engine::Outcome::kFired);
        REQUIRE(sum({"P1", "P2", "P3", "P7", "P8", "P10", "P12", "P15", "P16", "P17", "P18",
                     "P19"}) == 1);
        REQUIRE(sum({"P1", "P2", "P3", "P4", "P5", "P6", "P7", "P8"}) == 1);
        REQUIRE(sum({"P13", "P14", "P15", "P16", "P17", "P18", "P19", "P20"}) == 1);
        REQUIRE(sum({"P9", "P3", "P10"}) == run.tokens("P14"));
        REQUIRE(sum({"P11", "P19", "P12"}) == run.tokens("P6"));
    }
}

TEST_CASE(
    "the ball game with its walks plays on, and a snapshot of it has at most 500 bytes [law]") {
    QuietHost host;
    EngineOptions options;
    options.host = &host;
    Run run(ball_game(true), nullptr, options);
    std::size_t most = 0;
    for (int i = 0; i < 2000; ++i) {
        REQUIRE(run.engine.step() == Engine::Outcome::kFired);
        most = std::max(most, write_state(run.net, run.engine.save()).size());
    }
    CHECK(run.engine.state().now > seconds(40).ticks);
    CHECK(most <= 500);
    MESSAGE("largest snapshot: " << most << " bytes");
}

TEST_CASE("of the three arcs only t2 is enabled [unit]") {
    Maker m;
    m.place("P1", 1);
    m.place("P2", 1);
    m.place("P3", 1);
    m.t("t1", {"2*P1"}, {"P4"});
    m.t("t2", {"P2", "P3"}, {"P4"});
    Run run(m.net());
    CHECK_FALSE(run.engine.fireable(run.net.find_transition("t1")));
    CHECK(run.engine.fireable(run.net.find_transition("t2")));
    CHECK(run.until(100) == Engine::Outcome::kDead);
    CHECK(run.log.text == "0:t2");
}

}  // namespace
}  // namespace puppetri::net
