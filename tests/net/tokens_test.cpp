// SPDX-License-Identifier: MIT
// Tokens and places: SEMANTICS sections 2 and 3, sentence by sentence.
#include <doctest/doctest.h>

#include <algorithm>
#include <map>

#include "maker.h"

namespace puppetri::net {
namespace {

// A place `queue` of tokens (kind: int, due: time) with the given initial ones, and `take:
// queue(due = d) -> out`.
struct Queue {
    explicit Queue(Discipline discipline) {
        PlaceDraft& q = m.place("queue");
        q.attributes = {{"kind", {ValueKind::kInt, 0}}, {"due", {ValueKind::kTime, 0}}};
        q.discipline = discipline;
        q.duration = lasts(0);
        PlaceDraft& out = m.place("out");
        out.attributes = q.attributes;
    }
    void token(Value kind, double due) {
        InitialToken t;
        t.attributes = {kind, seconds(due).ticks};
        m.place("queue").tokens.push_back(t);
    }
    TransitionDraft& take(const char* name = "take") {
        TransitionDraft& t = m.t(name, {"queue"}, {"out"});
        t.variables = {{"k", {ValueKind::kInt, 0}}, {"d", {ValueKind::kTime, 0}}};
        PatternDraft k, d;
        k.attribute = 0;
        k.binds = 0;
        d.attribute = 1;
        d.binds = 1;
        t.inputs[0].pattern = {k, d};
        t.outputs[0].attributes = {Maker::variable(t, 0), Maker::variable(t, 1)};
        return t;
    }
    Maker m;
};

// The kinds in the order in which they were taken.
std::vector<Value> kinds_in(const Run& run, const std::string& place) {
    const std::uint32_t p = run.net.find_place(place).value;
    const RichTokens& tokens = run.engine.state().rich[run.net.tables().place_rich[p]];
    std::vector<std::pair<std::uint64_t, Value>> list;
    const std::uint32_t width = run.net.tables().rich[run.net.tables().place_rich[p]].attributes;
    for (std::uint32_t i = tokens.head; i < tokens.order.size(); ++i) {
        list.emplace_back(tokens.pool[tokens.order[i]].serial,
                          tokens.values[tokens.order[i] * width]);
    }
    std::sort(list.begin(), list.end());
    std::vector<Value> kinds;
    for (const auto& [serial, kind] : list) {
        kinds.push_back(kind);
    }
    return kinds;
}

TEST_CASE("initial tokens arrive at 0 and age like others, unless they are ready [unit]") {
    Maker m;
    m.place("a", 1, lasts(2));
    m.place("b", 0, lasts(2));
    InitialToken ready;
    ready.ready = true;
    m.place("b").tokens.push_back(ready);
    m.t("ta", {"a"}, {});
    m.t("tb", {"b"}, {});
    Run run(m.net());
    run.until(10);
    CHECK(run.log.text == "0:tb 2:ta");
}

TEST_CASE("a token of duration 0 is ready in the same instant [unit]") {
    Maker m;
    m.place("a", 1);
    m.place("c", 0, lasts(0));
    m.t("t1", {"a"}, {"b"});
    m.t("t2", {"b"}, {"c"});
    m.t("t3", {"c"}, {});
    Run run(m.net());
    run.until(10);
    CHECK(run.net.paced());
    CHECK(run.log.text == "0:t1 1:t2 2:t3");
    m.place("clock", 1, lasts(5));
    Run timed(m.net());
    timed.until(10);
    CHECK(timed.log.text == "0:t1 0:t2 0:t3");
}

TEST_CASE("a token taken and given back is a new arrival; a read token keeps its age [unit]") {
    Maker m;
    m.place("a", 1, lasts(3));
    m.place("tick", 1, lasts(2));
    m.t("end", {"a"}, {});
    SUBCASE("taken with now and given back") { m.t("touch", {"tick", "now a"}, {"a"}); }
    SUBCASE("read with while") { m.t("touch", {"tick", "while a"}, {}); }
    Run run(m.net());
    run.until(10);
    const bool taken = run.net.tables().rich.size() == 1;
    CHECK(run.log.text == (taken ? "2:touch 5:end" : "2:touch 3:end"));
}

TEST_CASE("disciplines: oldest, newest, least, most [unit]") {
    struct Case {
        Discipline discipline;
        std::vector<Value> order;
    };
    const Case cases[] = {{Discipline::kOldest, {0, 1, 2, 3}},
                          {Discipline::kNewest, {3, 2, 1, 0}},
                          {Discipline::kLeast, {2, 0, 3, 1}},
                          {Discipline::kMost, {1, 0, 3, 2}}};
    for (const Case& c : cases) {
        Queue q(c.discipline);
        q.m.place("queue").key = Expr::slot(slot(SlotKind::kAttribute, 1), {ValueKind::kTime, 0});
        q.token(0, 5);
        q.token(1, 9);
        q.token(2, 1);
        q.token(3, 5);
        q.take();
        Run run(q.m.net());
        run.until(100);
        CHECK(kinds_in(run, "out") == c.order);
    }
}

TEST_CASE("first means earliest arrival, whatever tokens last [unit]") {
    struct Case {
        Discipline discipline;
        bool by_arrival;
        std::vector<Value> order;
    };
    // Kinds arrive in the order 0, 1, 2 and are ready in the order 1, 2, 0.
    const Case cases[] = {
        {Discipline::kOldest, false, {1, 2, 0}}, {Discipline::kOldest, true, {0, 1, 2}},
        {Discipline::kNewest, false, {0, 2, 1}}, {Discipline::kNewest, true, {2, 1, 0}},
        {Discipline::kLeast, false, {1, 2, 0}},  {Discipline::kLeast, true, {0, 1, 2}}};
    for (const Case& c : cases) {
        Queue q(c.discipline);
        const Expr stays = Expr::slot(slot(SlotKind::kAttribute, 1), {ValueKind::kTime, 0});
        q.m.place("queue").duration = computed(stays);
        q.m.place("queue").by_arrival = c.by_arrival;
        q.m.place("queue").key = Expr::integer(7);  // the same for all
        q.token(0, 9);
        q.token(1, 3);
        q.token(2, 5);
        q.take().inputs[0].kind = ArcKind::kTakeNow;
        Run run(q.m.net());
        run.until(100);
        CHECK(kinds_in(run, "out") == c.order);
    }
}

TEST_CASE("oldest means earliest ready time, then earliest arrival [unit]") {
    // The token of kind 0 arrives first but is ready last.
    Queue q(Discipline::kOldest);
    DurationDraft own = computed(Expr::slot(slot(SlotKind::kAttribute, 1), {ValueKind::kTime, 0}));
    q.m.place("queue").duration = own;
    q.token(0, 3);
    q.token(1, 1);
    q.token(2, 2);
    q.m.place("gate", 1, lasts(10));
    TransitionDraft& open = q.m.t("open", {"gate"}, {"3*pass"});
    (void)open;
    q.take().inputs.push_back(q.m.arc("pass"));
    Run run(q.m.net());
    run.until(100);
    CHECK(kinds_in(run, "out") == std::vector<Value>{1, 2, 0});
}

TEST_CASE("a token of an `any` place is drawn, each equally often [law]") {
    std::map<Value, int> first;
    for (std::uint64_t seed = 1; seed <= 3000; ++seed) {
        Queue q(Discipline::kAny);
        for (int k = 0; k < 3; ++k) {
            q.token(k, 1);
        }
        q.take();
        EngineOptions options;
        options.seed = seed;
        Run run(q.m.net(), nullptr, options);
        run.until(100, 1);
        ++first[kinds_in(run, "out")[0]];
    }
    for (const auto& [kind, times] : first) {
        CHECK(times > 900);  // mean 1000, deviation 26
        CHECK(times < 1100);
    }
}

TEST_CASE("any draws only tokens with which the rest can be bound [unit]") {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        Queue q(Discipline::kAny);
        for (int k = 0; k < 4; ++k) {
            q.token(k, 1);
        }
        TransitionDraft& t = q.take();
        t.guard =
            expr(ExprOp::kEqual, expr(ExprOp::kModulo, Maker::variable(t, 0), Expr::integer(2)),
                 Expr::integer(1));
        EngineOptions options;
        options.seed = seed;
        Run run(q.m.net(), nullptr, options);
        CHECK(run.until(100) == Engine::Outcome::kDead);
        std::vector<Value> kinds = kinds_in(run, "out");
        std::sort(kinds.begin(), kinds.end());
        CHECK(kinds == std::vector<Value>{1, 3});
    }
}

TEST_CASE("keeps order: no token is ready before its predecessor [unit]") {
    Queue q(Discipline::kOldest);
    q.m.place("queue").duration =
        computed(Expr::slot(slot(SlotKind::kAttribute, 1), {ValueKind::kTime, 0}));
    q.m.place("queue").keeps_order = true;
    q.token(0, 3);
    q.token(1, 1);
    q.token(2, 5);
    q.take();
    Run run(q.m.net());
    run.until(100);
    CHECK(run.log.text == "3:take 3:take 5:take");
    CHECK(kinds_in(run, "out") == std::vector<Value>{0, 1, 2});
}

TEST_CASE(
    "a full place blocks its producers; who takes from it as well does not count twice [unit]") {
    Maker m;
    m.place("source", 5);
    m.place("buffer", 0, lasts(1)).capacity = 2;
    m.t("put", {"source"}, {"buffer"});
    m.t("get", {"buffer"}, {"sink"});
    Run run(m.net());
    run.until(0);
    CHECK(run.log.text == "0:put 0:put");
    run.until(100);
    CHECK(run.tokens("sink") == 5);

    Maker loop;
    loop.place("full", 2, lasts(1)).capacity = 2;
    loop.t("turn", {"full"}, {"full"});
    Run turning(loop.net());
    CHECK(turning.until(2, 4) == Engine::Outcome::kFired);
}

TEST_CASE("now takes tokens ready or not, ready ones first, and binds the time left [unit]") {
    Maker m;
    m.place("a", 1, lasts(5));
    m.place("cutter", 1, lasts(2));
    TransitionDraft& cut = m.t("cut", {"cutter", "now a"}, {"b"});
    cut.variables = {{"left", {ValueKind::kTime, 0}}};
    cut.inputs[1].time_left = 0;
    cut.outputs[0].lasts = Maker::variable(cut, 0);
    m.t("end", {"b"}, {});
    Run run(m.net());
    run.until(100);
    CHECK(run.log.text == "2:cut 5:end");
    CHECK(run.tokens("a") == 0);
}

TEST_CASE("all takes however many ready tokens there are, also none [unit]") {
    for (const bool timed : {false, true}) {
        for (const std::uint32_t tokens : {0u, 3u}) {
            Maker m;
            m.place("a", tokens, lasts(timed ? 1 : 0));
            m.place("late", 0, lasts(1));
            m.place("go", 1, lasts(2));
            m.place("a");
            m.t("sweep", {"go", "all a"}, {"done"});
            Run run(m.net());
            run.until(100);
            CHECK(run.log.text == "2:sweep");
            CHECK(run.tokens("a") == 0);
            CHECK(run.ready("a") == 0);
        }
    }
}

TEST_CASE("all leaves tokens that are not ready: only now cuts [unit]") {
    Maker m;
    m.place("a", 2, lasts(5));
    InitialToken ready;
    ready.ready = true;
    m.place("a").tokens.push_back(ready);
    m.place("go", 1, lasts(1));
    SUBCASE("all") {
        m.t("sweep", {"go", "all a"}, {});
        Run run(m.net());
        run.until(1);
        CHECK(run.tokens("a") == 2);
        CHECK(run.ready("a") == 0);
        run.until(100);
        CHECK(run.ready("a") == 2);
    }
    SUBCASE("all now") {
        m.t("sweep", {"go", "allnow a"}, {});
        Run run(m.net());
        run.until(100);
        CHECK(run.tokens("a") == 0);
    }
}

TEST_CASE(
    "with reads ready tokens, while reads tokens ready or not, unless counts all, unless ready the "
    "ready [unit]") {
    const auto first_time = [](const char* test) {
        Maker m;
        m.place("a", 1, lasts(2));
        m.place("go", 1);
        m.t("t", {"go", test}, {});
        m.t("end", {"a", "unless go"}, {});
        Run run(m.net());
        run.until(100);
        return run.log.text;
    };
    CHECK(first_time("with a") == "2:t 2:end");
    CHECK(first_time("while a") == "0:t 2:end");
    CHECK(first_time("unless a") == "");
    CHECK(first_time("unless 2*a") == "0:t 2:end");
    CHECK(first_time("unless ready a") == "0:t 2:end");
}

TEST_CASE(
    "each arc is tested alone on the marking before the firing, parallel arcs of one kind add "
    "[unit]") {
    const auto fires = [](std::uint32_t tokens, const std::vector<std::string>& arcs) {
        Maker m;
        m.place("a", tokens);
        m.t("t", arcs, {"b"});
        Run run(m.net());
        return run.engine.fireable({0});
    };
    CHECK(fires(1, {"a", "with a"}));  // one token is taken and read
    CHECK_FALSE(fires(1, {"a", "a"}));
    CHECK(fires(2, {"a", "a"}));
    CHECK_FALSE(fires(2, {"with 2*a", "with a"}));
    CHECK(fires(3, {"with 2*a", "with a"}));
    CHECK(fires(2, {"with a", "unless 2*a", "unless a"}));
    CHECK_FALSE(fires(3, {"with a", "unless 2*a", "unless a"}));
    CHECK_FALSE(fires(1, {"a", "now a"}));  // taking arcs take different tokens
    CHECK(fires(2, {"a", "now a"}));
}

TEST_CASE(
    "patterns: the first match of the discipline, with backtracking until the guard holds [unit]") {
    // Two queues joined where kinds are equal and the due times add up to 10 s.
    Maker m;
    for (const char* name : {"left", "right"}) {
        PlaceDraft& p = m.place(name);
        p.attributes = {{"kind", {ValueKind::kInt, 0}}, {"due", {ValueKind::kTime, 0}}};
    }
    const auto token = [&](const char* name, Value kind, double due) {
        InitialToken t;
        t.attributes = {kind, seconds(due).ticks};
        m.place(name).tokens.push_back(t);
    };
    token("left", 1, 2);
    token("left", 2, 3);
    token("left", 2, 4);
    token("right", 3, 8);
    token("right", 2, 5);
    token("right", 2, 6);
    m.place("joined").attributes = {{"kind", {ValueKind::kInt, 0}}, {"due", {ValueKind::kTime, 0}}};
    TransitionDraft& t = m.t("join", {"left", "right"}, {"joined"});
    t.variables = {
        {"k", {ValueKind::kInt, 0}}, {"d", {ValueKind::kTime, 0}}, {"e", {ValueKind::kTime, 0}}};
    const auto bind = [](std::uint32_t attribute, std::uint32_t v) {
        PatternDraft p;
        p.attribute = attribute;
        p.binds = v;
        return p;
    };
    t.inputs[0].pattern = {bind(0, 0), bind(1, 1)};
    t.inputs[1].pattern = {bind(0, 0), bind(1, 2)};
    t.guard = expr(ExprOp::kEqual, expr(ExprOp::kAdd, Maker::variable(t, 1), Maker::variable(t, 2)),
                   Expr::time(seconds(10)));
    t.outputs[0].attributes = {Maker::variable(t, 0), Maker::variable(t, 1)};
    Run run(m.net());
    CHECK(run.until(100) == Engine::Outcome::kDead);
    CHECK(run.engine.state().firings == 1);  // (2, 4) with (2, 6), although (2, 3) was tried first
    CHECK(run.tokens("left") == 2);
    const RichTokens& joined =
        run.engine.state().rich[run.net.tables().place_rich[run.net.find_place("joined").value]];
    CHECK(joined.values[1] == seconds(4).ticks);
}

TEST_CASE("inhibitors and sweeps with patterns count and take matching tokens only [unit]") {
    Queue q(Discipline::kOldest);
    q.token(1, 1);
    q.token(2, 1);
    q.token(2, 1);
    q.m.place("go", 1, lasts(1));
    const auto equals = [](Value kind) {
        PatternDraft p;
        p.attribute = 0;
        p.equals = Expr::integer(kind);
        return p;
    };
    SUBCASE("unless") {
        q.m.t("no3", {"unless queue", "go"}, {}).inputs[0].pattern = {equals(3)};
        q.m.t("no2", {"unless 2*queue", "go"}, {}).inputs[0].pattern = {equals(2)};
        Run run(q.m.net());
        run.until(100);
        CHECK(run.log.text == "1:no3");
    }
    SUBCASE("all") {
        q.m.t("sweep", {"all queue", "go"}, {}).inputs[0].pattern = {equals(2)};
        Run run(q.m.net());
        run.until(100);
        CHECK(kinds_in(run, "queue") == std::vector<Value>{1});
    }
}

TEST_CASE("as P lasts as long as the sibling token of the same firing [unit]") {
    Maker m;
    m.place("go", 3);
    m.place("main", 0, exponential(1));
    DurationDraft as = of_kind(DurationKind::kAs);
    as.sibling = m.p("main");
    m.place("shadow", 0, as);
    as.sibling = m.p("shadow");
    m.place("echo", 0, as);
    // Declared in the unkind order: the sibling comes last.
    m.t("start", {"go"}, {"echo", "shadow", "main"});
    m.t("end", {"main", "shadow", "echo"}, {});
    m.t("late", {"main", "unless ready shadow"}, {"wrong"}).priority = 2;
    Run run(m.net());
    run.until(1000);
    CHECK(run.engine.state().firings == 6);
    CHECK(run.tokens("wrong") == 0);
}

TEST_CASE("an open token is ready when its owner says so, the oldest first [unit]") {
    Maker m;
    m.place("door", 2, of_kind(DurationKind::kOpen));
    const EventIndex contact = m.event("contact");
    m.draft.events[0].makes_ready = m.p("door");
    m.at(1, contact);
    m.at(4, contact);
    m.at(6, contact);
    m.t("through", {"door"}, {});
    Run run(m.net());
    run.until(100);
    CHECK(run.log.text == "1:through 4:through 6:lost-contact");
}

TEST_CASE("durations are fixed at arrival, after all assignments of the firing [unit]") {
    Maker m;
    const DatumIndex n = m.integer("n", 1);
    m.place("go", 1);
    m.place("busy", 0, computed(expr(ExprOp::kMultiply, Expr::time({kSecond}), m.read(n))));
    TransitionDraft& t = m.t("start", {"go"}, {"busy"});
    t.assignments.push_back({n, Expr::integer(7), {}});
    m.t("end", {"busy"}, {});
    TransitionDraft& change = m.t("change", {"unless go", "once"}, {});
    m.place("once", 1);
    change.assignments.push_back({n, Expr::integer(2), {}});
    Run run(m.net());
    run.until(100);
    CHECK(run.log.text == "0:start 0:change 7:end");
}

}  // namespace
}  // namespace puppetri::net
