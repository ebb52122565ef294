// SPDX-License-Identifier: MIT
// What a draft may get wrong: each defect by its code, all of them at once; and what the tables
// cost.
#include <doctest/doctest.h>

#include <algorithm>

#include "maker.h"

namespace puppetri::net {
namespace {

using Codes = std::vector<std::string>;

// A net without defects to spoil.
Maker sound() {
    Maker m;
    m.place("a", 1);
    m.place("b", 0, lasts(1));
    m.t("t", {"a"}, {"b"});
    return m;
}

TEST_CASE("a sound net has no defects [unit]") { CHECK(sound().codes().empty()); }

TEST_CASE("each defect has its code [unit]") {
    Maker m = sound();
    TransitionDraft& t = m.draft.transitions[0];
    SUBCASE("arc weight 0") {
        t.inputs[0].weight = 0;
        CHECK(m.codes() == Codes{"weight-not-positive"});
    }
    SUBCASE("output weight negative") {
        t.outputs[0].weight = -1;
        CHECK(m.codes() == Codes{"weight-not-positive"});
    }
    SUBCASE("odds 0") {
        t.odds = Expr::integer(0);
        CHECK(m.codes() == Codes{"odds-not-positive"});
    }
    SUBCASE("source without delay or event") {
        m.t("source", {}, {"a"});
        CHECK(m.codes() == Codes{"source-without-delay"});
        m.draft.transitions.back().delay = DelayDraft{lasts(1)};
        CHECK(m.codes().empty());
        m.draft.transitions.back().delay.reset();
        m.draft.transitions.back().events = {m.event("e")};
        CHECK(m.codes().empty());
    }
    SUBCASE("two writers of one variable in one firing") {
        const DatumIndex n = m.integer("n", 0);
        t.assignments = {{n, Expr::integer(1), {}}, {n, Expr::integer(1), {}}};
        CHECK(m.codes() == Codes{"two-writers"});
    }
    SUBCASE("as without sibling") {
        m.place("b").duration = of_kind(DurationKind::kAs);
        m.place("b").duration->sibling = m.p("c");
        CHECK(m.codes() == Codes{"as-without-sibling"});
        t.outputs.push_back(m.output("c"));
        CHECK(m.codes().empty());
        m.place("c").duration = of_kind(DurationKind::kAs);
        m.place("c").duration->sibling = m.p("b");
        CHECK(m.codes() == Codes{"as-without-sibling", "as-without-sibling"});
    }
    SUBCASE("as an open one") {
        m.place("c").duration = of_kind(DurationKind::kOpen);
        m.place("b").duration = of_kind(DurationKind::kAs);
        m.place("b").duration->sibling = m.p("c");
        t.outputs.push_back(m.output("c"));
        CHECK(m.codes() == Codes{"as-without-sibling"});
    }
    SUBCASE("guard that is no bool") {
        t.guard = Expr::integer(1);
        CHECK(m.codes() == Codes{"type-mismatch"});
    }
    SUBCASE("variable read before it is bound") {
        t.variables = {{"x", {ValueKind::kInt, 0}}};
        t.guard = expr(ExprOp::kEqual, Maker::variable(t, 0), Expr::integer(1));
        CHECK(m.codes() == Codes{"variable-unbound"});
    }
    SUBCASE("binding in an inhibitor") {
        m.place("a").attributes = {{"x", {ValueKind::kInt, 0}}};
        m.place("a").tokens[0].attributes = {1};
        t.variables = {{"x", {ValueKind::kInt, 0}}};
        t.inputs.push_back(m.arc("unless a"));
        PatternDraft p;
        p.binds = 0;
        t.inputs.back().pattern = {p};
        CHECK(m.codes() == Codes{"pattern-on-attribute"});
    }
    SUBCASE("tokens without their attributes") {
        m.place("b").attributes = {{"x", {ValueKind::kInt, 0}}};
        CHECK(m.codes() == Codes{"type-mismatch"});
    }
    SUBCASE("names taken twice") {
        m.draft.places[1].path = "a";
        CHECK(m.codes() == Codes{"duplicate-name"});
    }
    SUBCASE("negative duration") {
        m.place("b").duration = lasts(-1);
        CHECK(m.codes() == Codes{"negative-duration"});
    }
    SUBCASE("empty interval") {
        m.place("b").duration = between(5, 4);
        CHECK(m.codes() == Codes{"empty-interval"});
    }
    SUBCASE("distribution with wrong parameters") {
        m.place("b").duration = exponential(-1);
        CHECK(m.codes() == Codes{"wrong-distribution"});
    }
    SUBCASE("auto without a movement") {
        m.place("b").duration = of_kind(DurationKind::kAuto);
        CHECK(m.codes() == Codes{"auto-without-movement"});
    }
    SUBCASE("more tokens than it holds") {
        m.place("a").capacity = 0;
        CHECK(m.codes() == Codes{"capacity-exceeded"});
    }
    SUBCASE("least of nothing") {
        m.place("a").discipline = Discipline::kLeast;
        CHECK(m.codes() == Codes{"key-missing"});
    }
    SUBCASE("datum outside its range") {
        m.integer("n", 7, 0, 5);
        CHECK(m.codes() == Codes{"initial-out-of-range"});
        m.draft.data[0].low = 9;
        CHECK(m.codes() == Codes{"range-empty"});
    }
    SUBCASE("a sensor is not assigned") {
        const DatumIndex d = m.datum("near", {ValueKind::kBool, 0}, 0);
        m.draft.data[0].sensor = true;
        t.assignments = {{d, Expr::boolean(true), {}}};
        CHECK(m.codes() == Codes{"sensor-assigned"});
    }
    SUBCASE("an event makes ready what is not open") {
        m.event("e");
        m.draft.events[0].makes_ready = m.p("b");
        CHECK(m.codes() == Codes{"type-mismatch"});
    }
    SUBCASE("an index that is not there") {
        t.inputs[0].place = PlaceIndex{77};
        CHECK(m.codes() == Codes{"unknown-index"});
    }
    SUBCASE("a guard over data that is not there") {
        t.guard = Expr::slot(slot(SlotKind::kDatum, 3), {ValueKind::kBool, 0});
        CHECK(m.codes() == Codes{"unknown-index"});
    }
    SUBCASE("an event scheduled again and again in no time") {
        m.at(1, m.event("e"));
        m.draft.schedule[0].every = SimTime{0};
        CHECK(m.codes() == Codes{"negative-duration"});
    }
    SUBCASE("a final marking that speaks of a firing") {
        FinalMarkingDraft end;
        end.condition = Formula::fires({0});
        m.draft.finals.push_back(end);
        CHECK(m.codes() == Codes{"type-mismatch"});
    }
}

TEST_CASE("sources of foreign nets fire once per beat, in nets without time only [unit]") {
    Maker m;
    m.place("a", 0);
    m.t("source", {}, {"a"});
    CHECK(m.codes() == Codes{"source-without-delay"});
    m.draft.sources_on_beats = true;
    CHECK(m.codes().empty());
    Run run(m.net());
    run.until(2.5);
    CHECK(run.log.text == "0:source 1:source 2:source");
    m.place("b", 1, lasts(1));
    CHECK(m.codes() == Codes{"source-without-delay"});
}

TEST_CASE("all defects are told at once, with their source positions [unit]") {
    Maker m = sound();
    m.draft.transitions[0].inputs[0].weight = 0;
    m.draft.transitions[0].where = {"x.pup", 3, 5, 1};
    m.draft.transitions[0].odds = Expr::real(-1);
    m.place("b").duration = lasts(-1);
    Checked<Net> net = compile(m.draft);
    REQUIRE_FALSE(net);
    CHECK(net.error().size() == 3);
    CHECK(net.error()[1].where == SourceSpan{"x.pup", 3, 5, 1});
    CHECK(net.error()[1].element == "transition t");
    for (const Diagnostic& d : net.error()) {
        CHECK_FALSE(d.remedy.empty());
    }
}

TEST_CASE("a time that is no whole number of ticks is noted [unit]") {
    Maker m = sound();
    m.place("b").duration = computed(Expr::unary(ExprOp::kToTime, Expr::real(1.0 / 7)).value());
    const Net net = m.net();
    REQUIRE(net.notes().size() == 1);
    CHECK(net.notes()[0].code == "rounded-to-tick");
}

TEST_CASE("the net knows its elements by path, and where the draft's went [unit]") {
    Maker m = sound();
    m.draft.places[0].caption = "the first";
    m.draft.places[0].where = {"x.pup", 2, 1, 5};
    const Net net = m.net();
    CHECK(net.find_place("a").value == 0);
    CHECK_FALSE(net.find_place("c").valid());
    CHECK(net.place({0}).path == "a");
    CHECK(net.place({0}).caption == "the first");
    CHECK(net.place({0}).where == SourceSpan{"x.pup", 2, 1, 5});
    CHECK(net.transition({0}).path == "t");
    Net copy = net;
    CHECK(copy.hash() == net.hash());
    m.place("a", 1);
    CHECK(m.net().hash() != net.hash());
}

TEST_CASE("a plain place and a plain arc cost at most 64 bytes each [law]") {
    Maker m;
    const std::uint32_t n = 400;
    for (std::uint32_t i = 0; i < n; ++i) {
        m.place("p" + std::to_string(i), 1, lasts(i % 2));
    }
    for (std::uint32_t i = 0; i < n; ++i) {
        m.t("t" + std::to_string(i), {"p" + std::to_string(i), "p" + std::to_string((i + 1) % n)},
            {"p" + std::to_string((i + 2) % n)});
    }
    const Net net = m.net();
    const std::size_t state =
        sizeof(Counts) + sizeof(Pending);  // per place, all tokens on their way
    CHECK(net.hot_bytes() + n * state <= 64 * n + 64 * 3 * n);
    MESSAGE("bytes of " << n << " places and " << 3 * n
                        << " arcs: " << net.hot_bytes() + n * state);
}

}  // namespace
}  // namespace puppetri::net
