// SPDX-License-Identifier: MIT
// What each statement of the language becomes.
#include "puppetri/lang/parse.h"

#include <doctest/doctest.h>

#include <fstream>
#include <sstream>

#include "lang/dump.h"

using namespace puppetri;
using namespace puppetri::lang;

namespace {

File parsed(const std::string& text) {
    Parsed result = parse(text, "test.pup");
    for (const Diagnostic& d : result.diagnostics) {
        FAIL_CHECK(format_diagnostic(d, result.file.line_text(d.where.line), false));
    }
    return std::move(result.file);
}
Net in_net(const std::string& statements) {
    File file = parsed("net n {\n" + statements + "\n}\n");
    REQUIRE(file.body.nets.size() == 1);
    return std::move(file.body.nets[0]);
}
Place place(const std::string& text) {
    Net net = in_net(text);
    REQUIRE(net.body.places.size() == 1);
    return std::move(net.body.places[0]);
}
Transition transition(const std::string& text) {
    Net net = in_net(text);
    REQUIRE(net.body.transitions.size() == 1);
    return std::move(net.body.transitions[0]);
}
Rule rule(const std::string& text) {
    File file = parsed("rule r " + text);
    REQUIRE(file.body.rules.size() == 1);
    return std::move(file.body.rules[0]);
}

}  // namespace

TEST_CASE("a place says its name, its caption and who may see it [unit]") {
    const Place p = place("public place with_ball \"walk with the ball\"");
    CHECK(p.name.text == "with_ball");
    CHECK(p.caption.text == "walk with the ball");
    CHECK(p.is_public);
    CHECK(p.role == Role::kInner);
    CHECK(p.takes.kind == DurationKind::kDefault);
    CHECK(place("start place P1").role == Role::kStart);
    CHECK(place("public finish place P1").role == Role::kFinish);
    CHECK(place("place 'left leg'").name.text == "left leg");
}

TEST_CASE("a place does a movement or runs a net [unit]") {
    const Place p = place("place a does me.face(other.me, arms: carry(ball)) takes 12 frames");
    REQUIRE(p.does.kind == ExprKind::kCall);
    CHECK(to_text(p.does) == "me.face(other.me, arms: carry(ball))");
    CHECK(p.does.args[1].name.text == "arms");
    CHECK(p.does.args[1].value.kind == ExprKind::kCall);
    CHECK(p.takes.value.unit == "frames");
    CHECK(place("place a runs walk(me)").runs.kind == ExprKind::kCall);
}

TEST_CASE("every kind of duration has its word [unit]") {
    CHECK(place("place a takes auto").takes.kind == DurationKind::kAuto);
    CHECK(place("place a takes open").takes.kind == DurationKind::kOpen);
    CHECK(to_text(place("place a takes as b.c").takes.as) == "b.c");
    const Place interval = place("place a takes 0.4 .. 0.6 s");
    REQUIRE(interval.takes.value.kind == ExprKind::kRange);
    CHECK(interval.takes.value.args[0].value.unit == "s");  // the unit holds for both ends
    CHECK(interval.takes.value.args[0].value.number == Rational{2, 5});
    CHECK(place("place a takes exponential(3 s)").takes.value.kind == ExprKind::kCall);
}

TEST_CASE("tokens of a place come in groups with attributes, ready or not [unit]") {
    const Place p =
        place("place a of Customer(kind: Kind, due: time) tokens 2 (kind = vip) ready, n + 1");
    CHECK(to_text(p.of_type) == "Customer");
    REQUIRE(p.attributes.size() == 2);
    CHECK(p.attributes[1].name.text == "due");
    REQUIRE(p.tokens.size() == 2);
    CHECK(p.tokens[0].ready);
    CHECK(to_text(p.tokens[0].attributes[0].value) == "vip");
    CHECK_FALSE(p.tokens[1].ready);
    CHECK(to_text(p.tokens[1].count) == "n + 1");
    CHECK(place("place a tokens 1 ready").tokens[0].ready);
    CHECK(place("place a tokens starts ? 1 : 0").tokens[0].count.kind == ExprKind::kConditional);
}

TEST_CASE("a place has a capacity, an order, a discipline, another name [unit]") {
    const Place p =
        place("place a holds at most 3 keeps order discipline least due - 2 s is other.flight");
    CHECK(p.capacity.number == Rational{3});
    CHECK(p.keeps_order);
    CHECK(p.discipline == Discipline::kLeast);
    CHECK(to_text(p.discipline_key) == "due - 2 s");
    CHECK(to_text(p.same_as) == "other.flight");
    CHECK(place("place a discipline oldest").discipline == Discipline::kOldest);
    CHECK(place("place a discipline newest").discipline == Discipline::kNewest);
    CHECK(place("place a discipline most due").discipline == Discipline::kMost);
    CHECK(place("place a discipline any").discipline == Discipline::kAny);
}

TEST_CASE("arcs have weights, patterns and ways of taking [unit]") {
    const Transition t = transition(
        "t \"c\": now 2*P(left = r) + all Q + steps*R + (n + 1)*S -> 2*A + b.c(kind = k)");
    CHECK(t.name.text == "t");
    CHECK(t.caption.text == "c");
    REQUIRE(t.inputs.size() == 4);
    CHECK(t.inputs[0].kind == ArcKind::kTakeNow);
    CHECK(t.inputs[0].weight.number == Rational{2});
    CHECK(to_text(t.inputs[0].pattern[0].name) == "left");
    CHECK(t.inputs[1].kind == ArcKind::kTakeAll);
    CHECK(to_text(t.inputs[2].weight) == "steps");
    CHECK(to_text(t.inputs[3].weight) == "n + 1");
    REQUIRE(t.outputs.size() == 2);
    CHECK(t.outputs[0].kind == ArcKind::kGive);
    CHECK(to_text(t.outputs[1].place) == "b.c");
}

TEST_CASE("all now, and on next; events may have these names [unit]") {
    const Transition t = transition("t: all now P + all now -> on next A or B");
    REQUIRE(t.inputs.size() == 2);
    CHECK(t.inputs[0].kind == ArcKind::kTakeAllNow);
    CHECK(t.inputs[1].kind == ArcKind::kTakeAll);
    CHECK(to_text(t.inputs[1].place) == "now");
    CHECK(t.next_event);
    CHECK(t.events.size() == 2);
    const Transition named = transition("t: P -> on next or next");
    CHECK_FALSE(named.next_event);
    CHECK(named.events.size() == 2);
}

TEST_CASE("a transition may take from nowhere and give nothing [unit]") {
    CHECK(transition("t: -> P after 2 s").inputs.empty());
    const Transition t = transition("t: P -> when x > 2");
    CHECK(t.outputs.empty());
    CHECK(to_text(t.guard) == "x > 2");
    CHECK(transition("t: P ->").outputs.empty());
}

TEST_CASE("tests read and forbid [unit]") {
    const Transition t =
        transition("t: P -> Q with A and 2*B while C unless D or 2*E unless ready F");
    REQUIRE(t.tests.size() == 6);
    const ArcKind wanted[] = {ArcKind::kWith,   ArcKind::kWith,   ArcKind::kWhile,
                              ArcKind::kUnless, ArcKind::kUnless, ArcKind::kUnlessReady};
    for (std::size_t i = 0; i < 6; ++i) {
        CHECK(t.tests[i].kind == wanted[i]);
    }
    CHECK(t.tests[1].weight.number == Rational{2});
}

TEST_CASE("each clause of a transition has one meaning [unit]") {
    const Transition t = transition(
        "public t: P -> Q priority -2 when not a = b on wave or P.release after 1 .. 2 s memory "
        "age servers infinite set x := "
        "x + 1, y := no odds 3/4 raises hit, miss together with other.shake");
    CHECK(t.is_public);
    CHECK(to_text(t.priority) == "-2");
    CHECK(t.guard.op == Op::kNot);  // not (a = b)
    CHECK(t.events.size() == 2);
    CHECK(t.delay.kind == ExprKind::kRange);
    CHECK(t.memory == Memory::kAge);
    CHECK(to_text(t.servers) == "infinite");
    REQUIRE(t.assignments.size() == 2);
    CHECK(to_text(t.assignments[0].value) == "x + 1");
    CHECK(t.assignments[1].value.kind == ExprKind::kBool);
    CHECK(to_text(t.odds) == "3/4");
    CHECK(t.raises.size() == 2);
    CHECK(t.together_with.size() == 1);
    CHECK(transition("t: P -> Q for 2 s").holding.number == Rational{2});
    CHECK(transition("t: now P -> Q for left").holding_left);
}

TEST_CASE("data, enumerations, token types, states and events are declared [unit]") {
    const Net net = in_net(
        "public data x \"count\": 0 .. 5 = 2\ndata open: bool\nenum Kind { vip, normal }\ntoken "
        "Customer(kind: Kind)\n"
        "public state busy \"b\" = P or #Q > 2\npublic consumed event wave at 2 s, 3.5 s\nevent "
        "tick every 2 s from 1 s until "
        "30 s\nevent call\nend { P and Q\n R }");
    CHECK(net.body.data[0].type.kind == ExprKind::kRange);
    CHECK(net.body.data[0].initial.number == Rational{2});
    CHECK(net.body.data[0].caption.text == "count");
    CHECK_FALSE(net.body.data[1].initial);
    CHECK(net.body.enumerations[0].values[1].text == "normal");
    CHECK(net.body.token_types[0].attributes[0].name.text == "kind");
    CHECK(net.body.states[0].formula.op == Op::kOr);
    CHECK(net.body.events[0].is_consumed);
    CHECK(net.body.events[0].at.size() == 2);
    CHECK(net.body.events[1].every.number == Rational{2});
    CHECK(net.body.events[1].from.number == Rational{1});
    CHECK(net.body.events[1].until.number == Rational{30});
    CHECK(net.body.events[2].at.empty());
    CHECK(net.body.ends[0].formulas.size() == 2);
}

TEST_CASE("nets have parameters with types and defaults [unit]") {
    const File file =
        parsed("net player(me: actor, n: 0 .. 5 = 2, out = 3, ball: prop) \"a player\" { }");
    const Net& net = file.body.nets[0];
    REQUIRE(net.parameters.size() == 4);
    CHECK(net.caption.text == "a player");
    CHECK(to_text(net.parameters[0].type) == "actor");
    CHECK(net.parameters[1].type.kind == ExprKind::kRange);
    CHECK(net.parameters[1].default_value.number == Rational{2});
    CHECK_FALSE(net.parameters[2].type);
    CHECK_FALSE(net.parameters[3].default_value);
}

TEST_CASE("instances, loops and indexed names [unit]") {
    const File file = parsed(
        "use player(ana, b, out: 3) as a\nuse helper\nfor i in 1 .. n {\n  use eater(fork[i], "
        "fork[i mod n + 1]) as "
        "eater[i]\n  for p in (a, b) { rule r never p.x }\n}\n");
    CHECK(file.body.uses[0].name.text == "a");
    CHECK(file.body.uses[0].args[2].name.text == "out");
    CHECK(file.body.uses[1].name.text == "helper");
    REQUIRE(file.body.loops.size() == 1);
    const For& loop = file.body.loops[0];
    CHECK(loop.domain.kind == ExprKind::kRange);
    REQUIRE(loop.body.uses[0].name.index.size() == 1);
    CHECK(to_text(loop.body.uses[0].args[1].value) == "fork[i mod n + 1]");
    CHECK(loop.body.loops[0].domain.kind == ExprKind::kTuple);
    CHECK(loop.body.loops[0].body.rules.size() == 1);
}

TEST_CASE("the header says version, title, rate, horizon, seed, pace and unit of time [unit]") {
    const File file = parsed(
        "language 1\nscene \"Two\"\nframes 23.976 per second, until frame 960\nseed 7\npace 2 "
        "s\ntime unit 1 min\n"
        "import walk, run from \"gaits.pup\"\nevents from \"e.csv\"\n");
    CHECK(file.header.title.text == "Two");
    CHECK(file.header.frames_per_second.number == Rational{2997, 125});
    CHECK(file.header.horizon_kind == HorizonKind::kFrame);
    CHECK(file.header.horizon.number == Rational{960});
    CHECK(file.header.seed.number == Rational{7});
    CHECK(file.header.pace.unit == "s");
    CHECK(file.header.time_unit.unit == "min");
    REQUIRE(file.imports.size() == 1);
    CHECK(file.imports[0].names.size() == 2);
    CHECK(file.imports[0].path == "gaits.pup");
    CHECK(file.body.event_files[0].path == "e.csv");
    CHECK(parsed("until 40 s").header.horizon_kind == HorizonKind::kTime);
    CHECK(parsed("until 960 frames").header.horizon_kind == HorizonKind::kTime);
    CHECK(parsed("until 500 firings").header.horizon_kind == HorizonKind::kFirings);
}

TEST_CASE("rules have forms [unit]") {
    CHECK(rule("never (a and b)").kind == RuleKind::kNever);
    CHECK(rule("always #a <= 3").operands[0].op == Op::kLessEqual);
    CHECK(rule("possible a").kind == RuleKind::kPossible);
    CHECK(rule("mutex(a, b)").kind == RuleKind::kMutex);
    CHECK(rule("exactly_one(a, b, c)").operands.size() == 3);
    CHECK(rule("alternate(a, b)").kind == RuleKind::kAlternate);
    CHECK(rule("bounded(a, by: 3)").bound.number == Rational{3});
    CHECK(rule("bounded").operands.empty());
    CHECK(rule("a only if b").kind == RuleKind::kOnlyIf);
    CHECK(rule("after a no b until c").kind == RuleKind::kAfterNoUntil);
    CHECK(rule("after a no b until c").operands.size() == 3);
    const Rule leads = rule("\"text\" a leads to b within 2 s");
    CHECK(leads.kind == RuleKind::kLeadsTo);
    CHECK(leads.operands.size() == 2);
    CHECK(leads.bound.unit == "s");
    CHECK(leads.caption.text == "text");
    CHECK_FALSE(rule("a leads to b").bound);
    const Rule takes = rule("a takes at most 20 frames");
    CHECK(takes.kind == RuleKind::kTakesAtMost);
    CHECK(takes.operands.size() == 1);
    CHECK(takes.bound.unit == "frames");
    CHECK(rule("deadlock_free").kind == RuleKind::kDeadlockFree);
    CHECK(rule("reversible").kind == RuleKind::kReversible);
    CHECK(rule("ends").kind == RuleKind::kEnds);
    CHECK(rule("live(a)").operands.size() == 1);
    CHECK(rule("quasi_live").kind == RuleKind::kQuasiLive);
    CHECK(rule("nobody_freezes(ana)").operands.size() == 1);
    CHECK(rule("never a when settled").when_settled);
    CHECK(rule("ctl AG(EF(home))").kind == RuleKind::kCtl);
    const Rule ltl = rule("ltl G(a implies F(b until c))");
    CHECK(ltl.kind == RuleKind::kLtl);
    CHECK(to_text(ltl.operands[0]) == "G(a implies F(b until c))");
}

TEST_CASE("questions have forms [unit]") {
    const auto question = [](const std::string& text) {
        File file = parsed("question q " + text);
        REQUIRE(file.body.questions.size() == 1);
        return std::move(file.body.questions[0]);
    };
    CHECK(question("shortest time to a and b").kind == QuestionKind::kShortestTime);
    CHECK(question("longest time to (a)").kind == QuestionKind::kLongestTime);
    const Question cycle = question("\"how long a round takes\" cycle time of t");
    CHECK(cycle.kind == QuestionKind::kCycleTime);
    CHECK(cycle.caption.text == "how long a round takes");
    CHECK(to_text(cycle.about) == "t");
    // The words stay names elsewhere.
    const Net net = in_net("place question\nplace cycle\nshortest: question -> cycle");
    CHECK(net.body.places.size() == 2);
}

TEST_CASE("measures have a statistic and something that is seen [unit]") {
    const auto measure = [](const std::string& text) {
        File file = parsed("measure m " + text);
        REQUIRE(file.body.measures.size() == 1);
        return std::move(file.body.measures[0]);
    };
    const Measure state = measure("\"who waits\" mean of #queue + 2 * #chair");
    CHECK(state.statistic.text == "mean");
    CHECK(state.caption.text == "who waits");
    CHECK(state.seen == Seen::kExpr);
    CHECK(to_text(state.value) == "#queue + 2*#chair");
    const Measure at = measure("share of kind = vip at leave or lose");
    CHECK(to_text(at.value) == "kind = vip");
    REQUIRE(at.from.size() == 2);
    CHECK(to_text(at.from[1].transition) == "lose");
    const Measure stay = measure("percentile 97.5 of time in shop.queue");
    CHECK(stay.seen == Seen::kStay);
    CHECK(stay.percent.number.numerator == 195);
    CHECK(to_text(stay.place) == "shop.queue");
    const Measure late = measure("share of time from arrive(next) to leave(n) or lose(n) > 5 min");
    CHECK(late.seen == Seen::kPassage);
    CHECK(to_text(late.from[0].key) == "next");
    REQUIRE(late.to.size() == 2);
    CHECK(to_text(late.to[1].transition) == "lose");
    CHECK(to_text(late.above) == "5 min");
    CHECK(to_text(measure("count of leave or lose").value) == "leave or lose");
    // The words stay names elsewhere
    const Net net = in_net("place measure\nplace time\nmeasure: time -> measure");
    CHECK(net.body.places.size() == 2);
    CHECK(measure("mean of time").seen == Seen::kExpr);
}

TEST_CASE("keywords are keywords only where they can be [unit]") {
    const Net net = in_net(
        "place place\nplace takes takes 2 s\nplace now\nplace live\nwhen: now + takes -> "
        "place\nnow: now now -> when\nrule: a -> "
        "b\nuse: rule -> use");
    CHECK(net.body.places.size() == 4);
    REQUIRE(net.body.transitions.size() == 4);
    CHECK(net.body.transitions[1].inputs[0].kind == ArcKind::kTakeNow);
    CHECK(to_text(net.body.transitions[1].inputs[0].place) == "now");
    CHECK(rule("live leads to now").kind == RuleKind::kLeadsTo);
}

TEST_CASE("blocks of any kind keep their properties [unit]") {
    const File file = parsed(
        "camera main { at (0, 1.6, 8) m, keeps ana and rui in view, moves with them }\nmaterial "
        "wood(shine = 0.2) {\n  grain { "
        "size 2 mm }\n  a -> b: 3\n}\nlight { }");
    REQUIRE(file.body.blocks.size() == 3);
    const Block& camera = file.body.blocks[0];
    CHECK(camera.kind.text == "camera");
    CHECK(camera.name.text == "main");
    REQUIRE(camera.properties.size() == 3);
    CHECK(camera.properties[0].values[0].kind == ExprKind::kTuple);
    CHECK(camera.properties[0].values[0].unit == "m");
    REQUIRE(camera.properties[1].values.size() == 3);
    CHECK(to_text(camera.properties[1].values[0]) == "ana and rui");
    CHECK(to_text(camera.properties[1].values[2]) == "view");
    const Block& wood = file.body.blocks[1];
    CHECK(wood.parameters[0].name.text == "shine");
    REQUIRE(wood.properties[0].children.size() == 1);
    CHECK(wood.properties[1].values[0].kind == ExprKind::kSymbol);
    CHECK(file.body.blocks[2].name.text.empty());
}

TEST_CASE("a sign after a word begins a value where it is spaced as one [unit]") {
    const auto values = [](const char* property) {
        const Parsed parsed = parse(std::string("thing x {\n  ") + property + "\n}\n", "a.pup", 0);
        REQUIRE(parsed.diagnostics.empty());
        std::vector<std::string> out;
        for (const Expr& e : parsed.file.body.blocks[0].properties[0].values) {
            out.push_back(to_text(e));
        }
        return out;
    };
    using Values = std::vector<std::string>;
    CHECK(values("a starts -1 pulse -x*2") == Values{"starts", "-1", "pulse", "-x*2"});
    CHECK(values("a starts - 1") == Values{"starts - 1"});
    CHECK(values("a starts-1") == Values{"starts - 1"});
    CHECK(values("a 3 -1") == Values{"3 - 1"});
    CHECK(values("a f(b -1)") == Values{"f(b - 1)"});
    CHECK(values("a whole -5 .. -1") == Values{"whole", "-5 .. -1"});
}

TEST_CASE("the cast has kinds with properties, on one line or on many [unit]") {
    const File file = parsed(
        "cast {\n  ana: mannequin { height 1.75 m, held by rui.hands }\n  ball: sphere {\n    mass "
        "0.4 kg\n  }\n  road: "
        "set\n}\n");
    REQUIRE(file.body.cast.size() == 3);
    CHECK(file.body.cast[0].kind.text == "mannequin");
    CHECK(file.body.cast[0].properties.size() == 2);
    CHECK(to_text(file.body.cast[0].properties[1].values[1]) == "rui.hands");
    CHECK(to_text(file.body.cast[1].properties[0].values[0]) == "0.4 kg");
    CHECK(file.body.cast[2].properties.empty());
}

TEST_CASE("spans point at the text of their node [law]") {
    const std::string text =
        "net n {\n  place a takes 2 s\n  go: a -> a priority 3\n}\nuse n(x: 1) as m\n";
    const File file = parsed(text);
    const auto of = [&](Span span) { return text.substr(span.begin, span.end - span.begin); };
    const Net& net = file.body.nets[0];
    CHECK(of(net.span) == text.substr(0, text.find("use") - 1));
    CHECK(of(net.body.places[0].span) == "place a takes 2 s");
    CHECK(of(net.body.places[0].takes.span) == "takes 2 s");
    CHECK(of(net.body.transitions[0].span) == "go: a -> a priority 3");
    CHECK(of(net.body.transitions[0].priority.span) == "3");
    CHECK(of(file.body.uses[0].args[0].name.span) == "x");
    const SourceSpan where = file.where(net.body.transitions[0].priority.span);
    CHECK(where.line == 3);
    CHECK(where.column == 23);
}

TEST_CASE("line ends continue inside brackets, after operators and before arrows [unit]") {
    const Transition t = transition("t: a +\n  b\n  -> c(x =\n 3,\n y = 2) priority 1 +\n 2");
    CHECK(t.inputs.size() == 2);
    CHECK(t.outputs[0].pattern.size() == 2);
    CHECK(t.priority.op == Op::kAdd);
    CHECK(place("place a \\\n  takes 2 s").takes.value.number == Rational{2});
    CHECK(in_net("place a\n\n# comment\n\nplace b # more").body.places.size() == 2);
}

TEST_CASE("a file of CRLF line ends, tabs and a byte order mark is the same file [law]") {
    std::ifstream in(PUP_SOURCE_DIR "/tests/corpus/every_construct.pup", std::ios::binary);
    std::stringstream buffer;
    buffer << in.rdbuf();
    const std::string text = buffer.str();
    std::string other = "\xEF\xBB\xBF";
    for (const char c : text) {
        other += c == '\n' ? "\r\n" : std::string(1, c);
    }
    for (std::size_t i = other.find("  "); i != std::string::npos; i = other.find("  ", i + 1)) {
        other.replace(i, 2, "\t");
    }
    CHECK(testing::Dump::of(parsed(text)) == testing::Dump::of(parsed(other)));
}
