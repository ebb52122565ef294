// SPDX-License-Identifier: MIT
// What files become: instances, paths, parameters, names across nets, units, loops, rules.
#include <algorithm>
#include <set>

#include "files.h"
#include "puppetri/scene/perform.h"

namespace puppetri::scene {
namespace {

const net::PlaceDraft& place(const Scene& scene, const std::string& path) {
    for (const net::PlaceDraft& p : scene.draft.places) {
        if (p.path == path) {
            return p;
        }
    }
    FAIL("no place " << path);
    return scene.draft.places[0];
}

const net::TransitionDraft& transition(const Scene& scene, const std::string& path) {
    for (const net::TransitionDraft& t : scene.draft.transitions) {
        if (t.path == path) {
            return t;
        }
    }
    FAIL("no transition " << path);
    return scene.draft.transitions[0];
}

std::int64_t ticks_of(const Scene& scene, const std::string& path) {
    const net::PlaceDraft& p = place(scene, path);
    REQUIRE(p.duration.has_value());
    REQUIRE(p.duration->kind == net::DurationKind::kConstant);
    return p.duration->a.literal_value();
}

const stage::Action& action(const Scene& scene, const std::string& path) {
    const net::ActionIndex index = place(scene, path).action;
    REQUIRE(index.valid());
    return scene.play.actions[index.value];
}

const net::Rule& rule(const Scene& scene, const std::string& path) {
    for (const net::Rule& r : scene.draft.rules) {
        if (r.path == path) {
            return r;
        }
    }
    FAIL("no rule " << path);
    return scene.draft.rules[0];
}

constexpr std::int64_t kMillisecond = kTicksPerMillisecond;

TEST_CASE(
    "values of an enumeration are known beside data of it; reals begin with any number [unit]") {
    const std::string net = R"(net light {
  enum Colour { red, green }
  public data lit: Colour = green
  public data level: real = 2
  place p takes 1 s tokens 1
  t: p -> p set lit := lit = red ? green : red
}
use light as l
place q tokens 1
)";
    const Scene scene = from_text(net +
                                  "u: q -> when l.lit = red and red != l.lit\n"
                                  "rule r never l.lit = green\n");
    CHECK(scene.draft.data[0].initial == 1);
    CHECK(scene.draft.data[1].initial == value_of_real(2));
    const Diagnostics list = defects_of(net + "u: q -> when l.lit = blue\n");
    REQUIRE(list.size() == 1);
    CHECK(list[0].code == "unknown-name");
}

}  // namespace

TEST_CASE("a whole cast is imported, and names of it mean its members [unit]") {
    MemoryFiles files;
    files.add("scene.pup",
              "language 1\nscene \"s\"\nuntil 1 s\nimport cast, nod from \"seats.pup\"\n"
              "import cast from \"scene.pup\"\n"
              "place p does ana.nod() tokens 1\ncast { rui: mannequin { at (1, 0, 0) m } }\n");
    files.add(
        "seats.pup",
        "language 1\ncast {\n ana: mannequin\n stool: cylinder { height 40 cm }\n}\n"
        "movement nod(me: actor) { takes 1 s; me.head.flex = 5 deg }\nnet none { place p }\n");
    const Scene scene = must(load(files, "scene.pup"));
    CHECK(scene.play.cast.actors.size() == 2);
    REQUIRE(scene.play.cast.props.size() == 1);
    CHECK(scene.play.cast.props[0].size_m.y == doctest::Approx(0.4));
    CHECK(scene.play.cast.actors[scene.play.actions[0].call.subject.actor.value].name == "ana");
}

TEST_CASE("instances may name each other in any order, and roles carry their parameters [unit]") {
    const Scene scene = from_text(
        "net n(me: actor, other: n, k: int = other.j, j: int = 2) {\n public place P takes k * 1 "
        "s\n place Q does me.face(other.me)\n"
        " t: P -> other.P + Q\n}\nuse n(ana, b, j: 5) as a\nuse n(rui, a) as b");
    CHECK(ticks_of(scene, "a.P") == 2000 * kMillisecond);  // b's j
    CHECK(ticks_of(scene, "b.P") == 5000 * kMillisecond);  // a's j
    CHECK(scene.draft.places[transition(scene, "a.t").outputs[0].place.value].path == "b.P");
    CHECK(scene.draft.places[transition(scene, "b.t").outputs[0].place.value].path == "a.P");
    const stage::Action& q = action(scene, "b.Q");
    CHECK(q.instance == "b");
    CHECK(q.call.subject.actor.value == 1);
    REQUIRE(q.call.arguments.size() == 1);
    CHECK(std::get<motion::ActorIndex>(q.call.arguments[0].value).value == 0);
}

TEST_CASE(
    "a place that runs a net has the net below its path, with start, finish and inside [unit]") {
    const Scene scene = from_text(
        "net inner() {\n start place S\n place M\n finish place F\n t: S -> M\n u: M -> F\n}\n"
        "net outer() {\n start place S\n place P runs inner()\n finish place F\n t: S -> P\n u: P "
        "-> F\n}\n"
        "place A runs outer() tokens 1\nplace B\nv: A -> B");
    CHECK(scene.net.find_place("A.P.M").valid());
    REQUIRE(scene.draft.refinements.size() == 2);
    const auto paths = [&](const std::vector<net::PlaceIndex>& list) {
        std::set<std::string> out;
        for (const net::PlaceIndex p : list) {
            out.insert(scene.draft.places[p.value].path);
        }
        return out;
    };
    const net::RefinementDraft& a = scene.draft.refinements[0];
    CHECK(scene.draft.places[a.place.value].path == "A");
    CHECK(paths(a.start) == std::set<std::string>{"A.S"});
    CHECK(paths(a.finish) == std::set<std::string>{"A.F"});
    CHECK(paths(a.inside) == std::set<std::string>{"A.S", "A.P", "A.F", "A.P.S", "A.P.M", "A.P.F"});
    const auto performed = perform(scene);
    REQUIRE(performed.has_value());
    CHECK(performed->firings == 5);
}

TEST_CASE("numbers are exact fractions and units are turned once [unit]") {
    const Scene scene = from_text(
        "place A takes 1 s / 3 * 3\nplace B takes 7 frames\nplace C takes 0.1 s + 0.2 s\nplace D "
        "takes 90 deg / 1 turns * 1 s\n"
        "place E takes min(3 s, 2 s, 4 s)\nplace F takes 3 m / (2 m/s)\nplace G takes (7 div 2) * "
        "1 s\nplace H takes 2^3 * 1 ms");
    CHECK(ticks_of(scene, "A") == 1000 * kMillisecond);
    CHECK(ticks_of(scene, "B") == 7 * kTicksPerSecond / 24);
    CHECK(ticks_of(scene, "C") == 300 * kMillisecond);
    CHECK(ticks_of(scene, "D") == 250 * kMillisecond);
    CHECK(ticks_of(scene, "E") == 2000 * kMillisecond);
    CHECK(ticks_of(scene, "F") == 1500 * kMillisecond);
    CHECK(ticks_of(scene, "G") == 3000 * kMillisecond);
    CHECK(ticks_of(scene, "H") == 8 * kMillisecond);
}

TEST_CASE("what is no whole number of ticks is rounded to nearest with a note [unit]") {
    // 705 600 000 / 11 = 64145454.54...
    const Scene scene = from_text("place A takes 1 s / 11");
    CHECK(ticks_of(scene, "A") == 64145455);
    CHECK(std::any_of(scene.notes.begin(), scene.notes.end(),
                      [](const Diagnostic& d) { return d.code == "rounded"; }));
}

TEST_CASE("a time without unit takes the file's unit of time, and only that file's [unit]") {
    MemoryFiles files;
    files.add("scene.pup",
              "scene \"x\"\ntime unit 1 min\nimport n from \"n.pup\"\nplace A takes 2\nuse n()\n");
    files.add("n.pup", "time unit 1 ms\nnet n(d: time = 5) { place B takes d }\n");
    const Scene scene = must(load(files, "scene.pup"));
    CHECK(ticks_of(scene, "A") == 120'000 * kMillisecond);
    CHECK(ticks_of(scene, "n.B") == 5 * kMillisecond);
}

TEST_CASE("loops index what they make, and rules in loops carry the name of the turn [unit]") {
    const Scene scene = from_text(
        "net p() { public place P }\nuse p as a\nuse p as b\nfor i in 1 .. 3 {\n place f[i] tokens "
        "i\n"
        " for x in (a, b) {\n  rule deep never (x.P and f[i])\n }\n}\nt: f[1 + 1] -> f[3]\n"
        "for x in (a, b) {\n rule r never x.P\n}");
    CHECK(place(scene, "f[3]").tokens[0].count == 3);
    CHECK(scene.draft.places[transition(scene, "t").inputs[0].place.value].path == "f[2]");
    CHECK(rule(scene, "r.a").operands.size() == 1);
    CHECK(rule(scene, "r.b").operands.size() == 1);
    CHECK(rule(scene, "deep.2.b").operands.size() == 1);
}

TEST_CASE("an alias is the same place under another name [unit]") {
    const Scene scene = from_text(
        "net n() { public place P takes 1 s tokens 2 }\nuse n as a\nplace Q is a.P\nplace R\nt: Q "
        "-> R");
    CHECK(scene.net.find_place("Q") == scene.net.find_place("a.P"));
    const auto performed = perform(scene);
    REQUIRE(performed.has_value());
    CHECK(performed->firings == 2);
}

TEST_CASE("movements are bound with names, defaults left out, nested calls and sides [unit]") {
    const Scene scene = from_text(
        "net n(me: actor, arms: movement = swing, s: side = left) {\n place P does me.step(s, "
        "stroke: 60 cm, arms: arms)\n}\n"
        "use n(ana, carry(ball)) as a\nuse n(rui, s: right) as b");
    const motion::BoundCall& a = action(scene, "a.P").call;
    CHECK(a.movement == "step");
    REQUIRE(a.find("side") != nullptr);
    CHECK(std::get<motion::Side>(*a.find("side")) == motion::Side::kLeft);
    CHECK(std::get<double>(*a.find("stroke")) == doctest::Approx(0.6));
    CHECK(a.find("duty") == nullptr);
    REQUIRE(a.nested.size() == 1);
    CHECK(a.nested[std::get<motion::NestedCall>(*a.find("arms")).index].movement == "carry");
    const motion::BoundCall& b = action(scene, "b.P").call;
    CHECK(std::get<motion::Side>(*b.find("side")) == motion::Side::kRight);
    CHECK(b.nested[0].movement == "swing");
}

TEST_CASE("attributes of tokens reach movements, guards and durations [unit]") {
    const Scene scene = from_text(
        "token Job(n: int, wait: time)\nplace todo of Job tokens 1 (n = 3, wait = 2 s), 1 (n = 1, "
        "wait = 1 s)\n"
        "place walking of Job does ana.walk(steps: n) takes wait\nplace done of Job\n"
        "go: todo(n = k, wait = w) -> walking(n = k + 1, wait = 2 * w) when k > 2\n"
        "stop: walking(n = k, wait = w) -> done(n = k, wait = w)");
    const motion::ArgumentValue* steps = action(scene, "walking").call.find("steps");
    REQUIRE(steps != nullptr);
    CHECK(std::get<motion::TokenAttribute>(*steps).index == 0);
    const auto performed = perform(scene);
    REQUIRE(performed.has_value());
    REQUIRE_FALSE(performed->fault.has_value());
    REQUIRE(performed->performance->score().size() == 1);  // the job with n = 1 stays
    const stage::ScoreEntry& entry = performed->performance->score()[0];
    CHECK(entry.start.ticks == 0);
    CHECK(entry.left.ticks == 4 * kTicksPerSecond);
}

TEST_CASE("an attribute may have a name in quotes, wherever it is named [unit]") {
    const Scene scene = from_text(
        "token Job('my kind': 0 .. 3)\nplace todo of Job tokens 1 ('my kind' = 2)\nplace done of "
        "Job\ngo: todo('my kind' = k) -> done('my kind' = k + 1) when k = 2\n"
        "again: done('my kind' = 3) -> todo('my kind' = 0)");
    const auto performed = perform(scene);
    REQUIRE(performed.has_value());
    CHECK(performed->firings == 2);
}

TEST_CASE("events of movements wake transitions [unit]") {
    const Scene scene = from_text(
        "place throwing does ana.throw(ball, to: rui) tokens 1\nplace seen\nplace after\n"
        "look: -> seen on throwing.release\nend_of: throwing -> after");
    CHECK(scene.net.find_event("throwing.release").valid());
    const auto performed = perform(scene);
    REQUIRE(performed.has_value());
    CHECK(performed->firings == 2);
}

TEST_CASE("rules become formulas over places, firings, phases and holders [unit]") {
    const Scene scene = from_text(
        "place P tokens 1\nplace Q\nt: P -> Q\nu: Q -> P after 1 s\nstate s = P or not Q\n"
        "rule a never (ana.left_leg.swing and ball.holder = ana.hands)\nrule b t only if P\nrule c "
        "s leads to Q within 2 s\n"
        "rule d bounded(P, by: 2)\nrule e nobody_freezes(ana)\nrule f ltl G(P implies F(Q))");
    REQUIRE(scene.draft.host_atoms.size() == 2);
    CHECK(scene.draft.host_atoms[0].subject == "ana.left_leg");
    CHECK(scene.draft.host_atoms[0].value == "swing");
    CHECK(scene.draft.host_atoms[1].subject == "ball");
    CHECK(scene.draft.host_atoms[1].value == "ana.hands");
    CHECK(rule(scene, "b").kind == net::RuleKind::kOnlyIf);
    CHECK(rule(scene, "b").operands[0].nodes[0].op == net::FormulaOp::kFires);
    CHECK(rule(scene, "b").operands[1].nodes[0].op == net::FormulaOp::kMarked);
    REQUIRE(rule(scene, "c").within.has_value());
    CHECK(rule(scene, "c").within->ticks == 2 * kTicksPerSecond);
    CHECK(rule(scene, "d").count == 2);
    CHECK(scene.draft.states.at(0).path == "s");
    CHECK(scene.rules().size() == 6);
}

TEST_CASE("a net sees the cast of its own file, which comes along when it is named [unit]") {
    MemoryFiles files;
    files.add("scene.pup",
              "scene \"x\"\nimport n from \"n.pup\"\ncast { ana: mannequin }\nuse n(ana)\n");
    files.add("n.pup",
              "cast {\n hill: set { model floor }\n nobody: mannequin\n}\nnet n(me: actor) { place "
              "P does me.face(hill) }\n");
    const Scene scene = must(load(files, "scene.pup"));
    CHECK(scene.play.cast.actors.size() == 1);
    REQUIRE(scene.play.cast.sets.size() == 1);
    CHECK(scene.play.cast.sets[0].name == "hill");
}

TEST_CASE("imports that name each other are fine; paths are beside the importer [unit]") {
    MemoryFiles files;
    files.add("a/scene.pup", "scene \"x\"\nimport n from \"../b/n.pup\"\nuse n\n");
    files.add("b/n.pup", "import m from \"./m.pup\"\nnet n { use m }\n");
    files.add("b/m.pup", "import n from \"n.pup\"\nnet m { place P tokens 1 }\n");
    const Scene scene = must(load(files, "a/scene.pup"));
    CHECK(scene.net.find_place("n.m.P").valid());
}

TEST_CASE("cast, cameras and header become plain values in SI units [unit]") {
    MemoryFiles files;
    files.add(
        "scene.pup",
        "language 1\nscene \"All\"\nframes 30000/1001 per second, until frame 300\nseed 9\n"
        "cast {\n ana: stick { height 160 cm, at (1, 0, -2) m, facing 90 deg, palette amber }\n"
        " crate: box { size (40, 30, 20) cm, mass 500 g, at (0, 0.15, 0) m }\n"
        " road: set { model road, length 60 m, width 4 m }\n}\n"
        "camera main { at (0, 1.6, 8) m, looks at (0, 1, 0) m, keeps ana in view, moves with them, "
        "opens 35 deg }\n");
    const Scene scene = must(load(files, "scene.pup"));
    CHECK(scene.title == "All");
    CHECK(scene.seed == 9);
    CHECK(scene.frame_rate == FrameRate{30000, 1001});
    REQUIRE(scene.horizon.time.has_value());
    CHECK(scene.horizon.time->ticks == 300LL * 1001 * kTicksPerSecond / 30000);
    const stage::Actor& ana = scene.play.cast.actors.at(0);
    CHECK(ana.body == stage::BodyKind::kStick);
    CHECK(ana.height_m == doctest::Approx(1.6));
    CHECK(ana.heading_rad == doctest::Approx(1.5707963267948966));
    CHECK(ana.palette == "amber");
    const stage::Prop& crate = scene.play.cast.props.at(0);
    CHECK(crate.size_m.x == doctest::Approx(0.4));
    CHECK(crate.mass_kg == doctest::Approx(0.5));
    CHECK(scene.play.cast.sets.at(0).length_m == 60);
    const Camera& camera = scene.cameras.at(0);
    CHECK(camera.moves_with_them);
    CHECK(camera.keeps.size() == 1);
    REQUIRE(camera.fov_rad.has_value());
    CHECK(*camera.fov_rad == doctest::Approx(0.6108652381980153));
}

TEST_CASE("the order of declarations changes no log [law]") {
    const std::string a = "use n(ana, b, 1) as a\n", b = "use n(rui, a, 0) as b\n";
    const std::string net =
        "net n(me: actor, other: n, k: int) {\n public place P takes uniform(1 s, 2 s) tokens k\n"
        " place Q takes exponential(1 s)\n t: P -> Q\n u: Q -> other.P\n}\n";
    const Scene one = from_text(net + a + b), two = from_text(b + a + net);
    const auto first = perform(one), second = perform(two);
    REQUIRE(first.has_value());
    REQUIRE(second.has_value());
    CHECK(first->firings > 10);
    CHECK(first->log_hash == second->log_hash);
}

TEST_CASE("the place and the end of a holding time can be named like others [unit]") {
    const Scene scene = from_text(
        "place p takes 1 s tokens 1\nplace q\nplace r tokens 1\nplace seen\nt: p -> q for 2 s\n"
        "u: r -> seen while t.busy\nrule a never (t.busy and q)\nrule b t.end only if t.busy\nrule "
        "c t.begin only if p");
    const net::PlaceIndex busy = scene.net.find_place("t.busy");
    REQUIRE(busy.valid());
    run::Player player(scene.net);
    player.advance_to(SimTime{2 * kTicksPerSecond});
    CHECK(player.tokens(busy) == 1);
    CHECK(player.tokens(scene.net.find_place("seen")) == 1);
    player.advance_to(SimTime{3 * kTicksPerSecond});
    CHECK(player.tokens(busy) == 0);
    CHECK(player.tokens(scene.net.find_place("q")) == 1);
    CHECK(rule(scene, "a").operands.size() == 1);
    CHECK(rule(scene, "b").operands[0].nodes[0].op == net::FormulaOp::kFires);
    const Diagnostics list =
        defects_of("place p tokens 1\nt: p -> p after 1 s\nrule a never t.busy");
    CHECK(list.at(0).code == "no-member");
}

}  // namespace puppetri::scene
