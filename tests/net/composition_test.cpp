// SPDX-License-Identifier: MIT
// Composition: fused places, rendezvous, holding times, refined places.
#include <doctest/doctest.h>

#include <algorithm>

#include "maker.h"

namespace puppetri::net {
namespace {

bool has(const std::vector<std::string>& codes, const char* code) {
    return std::find(codes.begin(), codes.end(), code) != codes.end();
}

TEST_CASE("fused places add their tokens, keep their names, and must agree [unit]") {
    Maker m;
    m.place("a.out", 1, lasts(1));
    m.place("b.in", 2, lasts(1));
    m.t("give", {"go"}, {"a.out"});
    m.t("take", {"b.in"}, {});
    m.draft.fusions.push_back({m.p("a.out"), m.p("b.in")});
    Run run(m.net());
    CHECK(run.net.place_count() == 2);
    CHECK(run.net.find_place("b.in") == run.net.find_place("a.out"));
    CHECK(run.net.place_of_draft(m.p("b.in")) == run.net.find_place("a.out"));
    CHECK(run.tokens("a.out") == 3);
    run.until(10);
    CHECK(run.log.text == "1:take 1:take 1:take");
    m.place("b.in").duration = lasts(2);
    CHECK(has(m.codes(), "fused-disagree"));
    m.place("b.in").duration = lasts(1);
    CHECK(m.codes().empty());
    m.place("b.in").discipline = Discipline::kNewest;
    CHECK(has(m.codes(), "fused-disagree"));
}

TEST_CASE("fusion is transitive [unit]") {
    Maker m;
    for (const char* name : {"a", "b", "c", "d"}) {
        m.place(name, 1);
    }
    m.draft.fusions.push_back({m.p("b"), m.p("c")});
    m.draft.fusions.push_back({m.p("d"), m.p("b")});
    m.draft.fusions.push_back({m.p("a"), m.p("d")});
    m.t("t", {"4*c"}, {});
    Run run(m.net());
    CHECK(run.net.place_count() == 1);
    CHECK(run.engine.fireable({0}));
}

TEST_CASE(
    "a rendezvous is the union of arcs, the conjunction of guards, the highest priority [unit]") {
    Maker m;
    const DatumIndex x = m.integer("x", 1);
    const DatumIndex y = m.integer("y", 0);
    m.place("p", 1);
    m.place("q", 1);
    m.place("tick", 1, lasts(2));
    TransitionDraft& a = m.t("a.meet", {"p"}, {"r"});
    a.guard = expr(ExprOp::kEqual, m.read(x), Expr::integer(1));
    a.assignments = {{x, Expr::integer(5), {}}};
    a.priority = 2;
    TransitionDraft& b = m.t("b.meet", {"q"}, {"s"});
    b.guard = expr(ExprOp::kEqual, m.read(y), Expr::integer(1));
    b.assignments = {{y, Expr::integer(6), {}}};
    m.t("set", {"tick"}, {}).assignments = {{y, Expr::integer(1), {}}};
    m.draft.rendezvous.push_back({m.index("a.meet"), m.index("b.meet")});
    Run run(m.net());
    run.until(10);
    CHECK(run.log.text == "2:set 2:a.meet|b.meet");
    CHECK(run.datum("x") == 5);
    CHECK(run.datum("y") == 6);
    CHECK(run.tokens("r") == 1);
    CHECK(run.tokens("s") == 1);
    b.assignments = {{x, Expr::integer(6), {}}};
    CHECK(has(m.codes(), "two-writers"));
    b.assignments.clear();
    a.delay = b.delay = DelayDraft{lasts(1)};
    CHECK(has(m.codes(), "rendezvous-disagree"));
}

TEST_CASE("a rendezvous that lacks a token for ever is warned of, and no other [unit]") {
    const auto notes = [](bool comes) {
        Maker m;
        m.place("p", 1);
        m.place("far", 1);
        m.place("q");
        m.place("lonely");
        m.t("a.meet", {"p"}, {"p"});
        m.t("b.meet", {"q"}, {"q"});
        // Over two steps, and through a place that is another's under a second name.
        m.place("way");
        m.place("q2");
        m.t("first", {comes ? "far" : "lonely"}, {"way"});
        m.t("second", {"way"}, {"q2"});
        m.t("back", {"q"}, {"lonely"});
        m.draft.fusions.push_back({m.p("q"), m.p("q2")});
        m.draft.rendezvous.push_back({m.index("a.meet"), m.index("b.meet")});
        return m.net().notes();
    };
    CHECK(notes(true).empty());
    const Diagnostics never = notes(false);
    REQUIRE(never.size() == 1);
    CHECK(never[0].code == "rendezvous-never");
    CHECK(never[0].severity == Severity::kWarning);
    CHECK(never[0].element == "transition a.meet");
}

TEST_CASE(
    "a holding time is begin, busy, end: tests at the begin, gifts and assignments at the end "
    "[unit]") {
    Maker m;
    const DatumIndex n = m.integer("n", 0);
    m.place("a", 2);
    m.place("b");
    TransitionDraft& t = m.t("work", {"a"}, {"b"});
    t.holding = lasts(3);
    t.guard = expr(ExprOp::kEqual, m.read(n), Expr::integer(0));
    t.assignments = {{n, Expr::integer(1), {}}};
    Run run(m.net());
    CHECK(run.net.transition_of_draft({0}) == run.net.find_transition("work.begin"));
    run.until(1);
    CHECK(run.tokens("work.busy") == 2);
    CHECK(run.tokens("b") == 0);
    CHECK(run.datum("n") == 0);
    run.until(10);
    CHECK(run.log.text == "0:work.begin 0:work.begin 3:work.end 3:work.end");
    CHECK(run.tokens("b") == 2);
    CHECK(run.datum("n") == 1);
}

TEST_CASE("bound variables travel through the holding time, also into its duration [unit]") {
    Maker m;
    PlaceDraft& a = m.place("a");
    a.attributes = {{"size", {ValueKind::kTime, 0}}};
    for (const double s : {4.0, 1.0}) {
        InitialToken token;
        token.attributes = {seconds(s).ticks};
        a.tokens.push_back(token);
    }
    m.place("b").attributes = a.attributes;
    TransitionDraft& t = m.t("work", {"a"}, {"b"});
    t.variables = {{"s", {ValueKind::kTime, 0}}};
    PatternDraft bind;
    bind.binds = 0;
    t.inputs[0].pattern = {bind};
    t.outputs[0].attributes = {Maker::variable(t, 0)};
    t.holding = computed(Maker::variable(t, 0));
    Run run(m.net());
    run.until(10);
    CHECK(run.log.text == "0:work.begin 0:work.begin 1:work.end 4:work.end");
}

// place `walk` runs a module: start -> step (1 s) -> done.
Maker with_module() {
    Maker m;
    m.place("go", 1);
    m.place("walk").duration = of_kind(DurationKind::kOpen);
    m.place("walk.step", 0, lasts(1));
    m.t("in", {"go"}, {"walk"});
    m.t("walk.begin", {"walk.start"}, {"walk.step"});
    m.t("walk.end", {"walk.step"}, {"walk.done"});
    m.t("out", {"walk"}, {"after"});
    RefinementDraft r;
    r.place = m.p("walk");
    r.start = {m.p("walk.start")};
    r.finish = {m.p("walk.done")};
    r.inside = {m.p("walk.start"), m.p("walk.step"), m.p("walk.done")};
    m.draft.refinements.push_back(r);
    return m;
}

TEST_CASE("a refined place keeps its token as the shadow of the module's activity [unit]") {
    Maker m = with_module();
    m.t("watch", {"walk.step", "while walk", "unless seen"}, {"walk.step", "seen"}).priority = 2;
    Run run(m.net());
    run.until(0);
    CHECK(run.log.text == "0:in 0:walk.begin");
    CHECK(run.tokens("walk") == 1);
    run.until(10);
    CHECK(run.tokens("walk") == 0);
    CHECK(run.tokens("walk.done") == 0);
    CHECK(run.tokens("after") == 1);
}

TEST_CASE("an initial token of a refined place marks the module's start [unit]") {
    Maker m = with_module();
    m.place("walk", 1);
    m.place("go").tokens.clear();
    Run run(m.net());
    run.until(10);
    CHECK(run.log.text == "0:walk.begin 1:walk.end 1:out");
}

TEST_CASE(
    "readers of a refined place wait for its module, and it holds one activity at a time [unit]") {
    Maker m = with_module();
    m.place("go", 1);  // two in all
    m.place("eye", 1);
    TransitionDraft& look = m.t("look", {"eye", "with walk"}, {});
    look.priority = 2;
    Run run(m.net());
    run.until(10);
    CHECK(run.log.text ==
          "0:in 0:walk.begin 1:walk.end 1:look 1:out 1:in 1:walk.begin 2:walk.end 2:out");
}

TEST_CASE("now on a refined place cuts the whole activity [unit]") {
    Maker m = with_module();
    m.place("tick", 1, lasts(0.5));
    m.t("stop", {"tick", "now walk"}, {"fallen"});
    Run run(m.net());
    run.until(10);
    CHECK(run.log.text == "0:in 0:walk.begin 0.5:stop");
    CHECK(run.tokens("walk.step") == 0);
}

TEST_CASE("a module must end clean: a token left inside stops the run and is named [unit]") {
    Maker m = with_module();
    m.draft.transitions[m.index("walk.begin").value].outputs.push_back(m.output("walk.crumb"));
    m.draft.refinements[0].inside.push_back(m.p("walk.crumb"));
    Run run(m.net());
    CHECK(run.until(10) == Engine::Outcome::kFault);
    CHECK(run.engine.fault().code == "module-not-clean");
    CHECK(run.engine.fault().element == "place walk.crumb");
}

TEST_CASE("modules within modules: the outer way in starts the inner one [unit]") {
    for (const bool inner_first : {false, true}) {
        Maker m;
        m.place("go", 1);
        m.place("outer").duration = of_kind(DurationKind::kOpen);
        m.place("outer.inner").duration = of_kind(DurationKind::kOpen);
        m.place("outer.inner.step", 0, lasts(2));
        m.t("in", {"go"}, {"outer"});
        m.t("inner_end", {"outer.inner.step"}, {"outer.inner.done"});
        m.t("up", {"outer.inner"}, {"outer.done"});
        m.t("out", {"outer"}, {"after"});
        RefinementDraft inner;
        inner.place = m.p("outer.inner");
        inner.start = {m.p("outer.inner.step")};
        inner.finish = {m.p("outer.inner.done")};
        inner.inside = {m.p("outer.inner.step"), m.p("outer.inner.done")};
        RefinementDraft outer;
        outer.place = m.p("outer");
        outer.start = {m.p("outer.inner")};
        outer.finish = {m.p("outer.done")};
        outer.inside = {m.p("outer.inner"), m.p("outer.done"), m.p("outer.inner.step"),
                        m.p("outer.inner.done")};
        m.draft.refinements = {outer, inner};
        if (inner_first) {
            std::swap(m.draft.refinements[0], m.draft.refinements[1]);
        }
        Run run(m.net());
        run.until(10);
        CHECK(run.log.text == "0:in 2:inner_end 2:up 2:out");
    }
}

}  // namespace
}  // namespace puppetri::net
