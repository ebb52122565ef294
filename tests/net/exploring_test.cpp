// SPDX-License-Identifier: MIT
// The smallest steps of a run, and time kept by somebody else.
#include <doctest/doctest.h>

#include "maker.h"

namespace puppetri::net {
namespace {

using Turn = Engine::Turn;

// Gives numbers, and remembers what began.
struct Keeper final : Timekeeper {
    std::int64_t begin(Kind kind, std::uint32_t element, SimTime low, SimTime high) override {
        begun.push_back({kind, element, low.ticks, high.ticks});
        return low.ticks == 0 ? 0 : static_cast<std::int64_t>(begun.size());
    }
    struct Begun {
        Kind kind;
        std::uint32_t element;
        std::int64_t low, high;
    };
    std::vector<Begun> begun;
};

struct Kept {
    explicit Kept(const Net& net) : engine(net, chooser, with()) { engine.start(); }
    EngineOptions with() {
        EngineOptions o;
        o.timekeeper = &keeper;
        return o;
    }
    void pass(std::initializer_list<std::int64_t> numbers) {
        engine.pass({numbers.begin(), numbers.size()});
    }
    ExhaustiveChooser chooser;
    Keeper keeper;
    Engine engine;
};

TEST_CASE("turns are what run() does, one after another [law]") {
    Maker m;
    m.place("P", 1, lasts(2));
    const EventIndex e = m.event("ring");
    m.at(3, e);
    m.t("a", {"P"}, {"Q"});
    m.t("b", {"Q"}, {"R"}).events = {e};
    const Net net = m.net();
    RandomChooser random;
    Engine engine(net, random);
    engine.start();
    const Turn turns[] = {Turn::kPassed, Turn::kFired,      Turn::kPassed, Turn::kOffered,
                          Turn::kFired,  Turn::kOfferEnded, Turn::kDead};
    for (const Turn t : turns) {
        CHECK(engine.turn() == t);
    }
    Run run(m.net());
    run.until(100);
    CHECK(engine.state().log_hash == run.engine.state().log_hash);
}

TEST_CASE("a timekeeper decides what is ready; priorities stay the engine's [unit]") {
    Maker m;
    m.place("P", 1, lasts(2));
    m.place("Q", 1, between(5, 9));
    m.t("low", {"P"}, {"L"});
    m.t("high", {"P", "Q"}, {"H"}).priority = 2;
    const Net net = m.net();
    Kept k(net);
    REQUIRE(k.keeper.begun.size() == 2);
    CHECK(k.keeper.begun[0].low == 2 * kSecond);
    CHECK(k.keeper.begun[1].low == 5);
    CHECK(k.keeper.begun[1].high == 9);
    CHECK(k.engine.turn() == Turn::kWaits);
    SUBCASE("together") {
        k.pass({1, 2});
        CHECK(k.engine.turn() == Turn::kFired);
        CHECK(net.transition({k.engine.state().last}).path == "high");
    }
    SUBCASE("one alone") {
        k.pass({1});
        CHECK(k.engine.turn() == Turn::kFired);
        CHECK(net.transition({k.engine.state().last}).path == "low");
        CHECK(k.engine.turn() == Turn::kWaits);
        k.pass({2});
        CHECK(k.engine.turn() == Turn::kDead);
    }
}

TEST_CASE("the time left of a token that waits is the same wait, given on [unit]") {
    Maker m;
    m.place("P", 1, lasts(4));
    m.place("Go", 1);
    TransitionDraft& t = m.t("move", {"now P", "Go"}, {"Q"});
    t.variables.push_back({"left", {ValueKind::kTime, 0}});
    t.inputs[0].time_left = 0;
    t.outputs[0].lasts = Maker::variable(t, 0);
    const Net net = m.net();
    Kept k(net);
    REQUIRE(k.keeper.begun.size() == 1);
    CHECK(k.engine.turn() == Turn::kFired);
    CHECK(k.keeper.begun.size() == 1);  // nobody was asked again
    CHECK(k.engine.turn() == Turn::kWaits);
    k.pass({1});
    CHECK(k.engine.state().counts[net.find_place("Q").value].ready == 1);
}

TEST_CASE("where order is kept, what lasts no time waits with the one before it [unit]") {
    Maker m;
    PlaceDraft& q = m.place("Q");
    q.attributes.push_back({"n", {ValueKind::kInt, 0}});
    q.keeps_order = true;
    q.duration = computed(expr(ExprOp::kMultiply,
                               Expr::slot(slot(SlotKind::kAttribute, 0), {ValueKind::kInt, 0}),
                               Expr::time(seconds(1))));
    for (const Value n : {3, 0}) {
        InitialToken token;
        token.attributes = {n};
        q.tokens.push_back(token);
    }
    m.t("out", {"Q"}, {"R"});
    const Net net = m.net();
    Kept k(net);
    CHECK(k.keeper.begun.size() == 1);
    CHECK(k.engine.turn() == Turn::kWaits);
    k.pass({1});
    CHECK(k.engine.state().counts[net.find_place("Q").value].ready == 2);
}

TEST_CASE("siblings wait under one number, delays and the schedule under their own [unit]") {
    Maker m;
    m.place("Start", 1);
    m.place("P", 0, lasts(1));
    DurationDraft as = of_kind(DurationKind::kAs);
    as.sibling = m.p("P");
    m.place("Q", 0, as);
    m.t("both", {"Start"}, {"P", "Q"});
    DelayDraft delay;
    delay.duration = between(3, 7);
    m.t("late", {"P"}, {"R"}).delay = delay;
    const EventIndex e = m.event("ring");
    m.at(3, e);
    m.t("rung", {"R"}, {"S"}).events = {e};
    const Net net = m.net();
    Kept k(net);
    CHECK(k.keeper.begun.size() == 1);  // the schedule
    CHECK(k.engine.turn() == Turn::kFired);
    REQUIRE(k.keeper.begun.size() == 2);  // P and Q
    k.pass({2});
    CHECK(k.engine.state().counts[net.find_place("P").value].ready == 1);
    CHECK(k.engine.state().counts[net.find_place("Q").value].ready == 1);
    REQUIRE(k.keeper.begun.size() == 3);
    CHECK(k.keeper.begun[2].kind == Timekeeper::Kind::kDelay);
    CHECK(k.engine.turn() == Turn::kWaits);
    k.pass({3});
    CHECK(k.engine.turn() == Turn::kFired);
    k.pass({1});
    CHECK(k.engine.turn() == Turn::kOffered);
    CHECK(k.engine.turn() == Turn::kFired);
}

}  // namespace
}  // namespace puppetri::net
