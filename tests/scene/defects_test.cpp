// SPDX-License-Identifier: MIT
// Every defect is told, once, where it stands, with its remedy, and together with all the others.
#include <algorithm>

#include "files.h"

namespace puppetri::scene {
namespace {

struct Case {
    const char* body;  // begins in line 4
    const char* code;
    std::uint32_t line, column;
};

constexpr Case kCases[] = {
    // names
    {"place P\nplace Q\nt: P -> R after 1 s", "unknown-name", 6, 9},
    {"place P does ana.thrw(ball)", "unknown-name", 4, 18},
    {"place P does anna.step(left)", "unknown-name", 4, 14},
    {"place P does ana.tail.transfer()", "unknown-name", 4, 18},
    {"place P does ana.throw(ball, too: rui)", "unknown-name", 4, 30},
    {"place P runs wlak(ana)", "unknown-name", 4, 14},
    {"place P takes exponental(3 s)", "unknown-name", 4, 15},
    {"place P of Custmer", "unknown-name", 4, 12},
    {"data x: nit = 1", "unknown-name", 4, 9},
    {"place P\nplace P", "name-twice", 5, 7},
    {"net n(p: int) {\n place p\n}\nuse n(1)", "name-twice", 5, 8},
    {"place P tokens 1 is Q\nplace Q is P", "place-cycle", 4, 21},
    {"state s = s", "state-cycle", 4, 1},
    {"rule r never P\nrule r never P\nplace P", "name-twice", 5, 6},
    // parameters and arguments
    {"net n(p: int) { place P }\nuse n()", "missing-argument", 5, 1},
    {"net n(p: int) { place P }\nuse n(1, 2)", "too-many-arguments", 5, 10},
    {"net n(p: int) { place P }\nuse n(1, p: 2)", "repeated-argument", 5, 13},
    {"net n(p: int) { place P }\nuse n(ana)", "wrong-type", 5, 7},
    {"net n(p: int) { place P }\nuse n(1.5)", "wrong-unit", 5, 7},
    {"net n(p: 1 .. 3) { place P }\nuse n(4)", "out-of-range", 5, 7},
    {"net n(p: time) { place P }\nuse n(3 m)", "wrong-unit", 5, 7},
    {"net n(p: time) { place P }\nuse n(3)", "wrong-unit", 5, 7},
    {"net n(p: tiem) { place P }\nuse n(3 s)", "unknown-name", 4, 10},
    {"net n(p: int = q, q: int = p) { place P tokens p }\nuse n()", "parameter-cycle", 4, 7},
    {"net n(o: m) { place P }\nnet m() { place P }\nuse n(b) as a\nuse n(a) as b", "wrong-type", 6,
     7},
    // movements
    {"place P does ana.step(stroke: 0.6 m)", "missing-argument", 4, 14},
    {"place P does ana.step(left, stroke: 0.6 s)", "wrong-unit", 4, 37},
    {"place P does ana.step(left, stroke: 0.6)", "wrong-unit", 4, 37},
    {"place P does ana.step(up)", "unknown-name", 4, 23},
    {"place P does ana.throw(rui, to: rui)", "wrong-type", 4, 24},
    {"place P does ana.walk(steps: 2.5)", "wrong-unit", 4, 30},
    {"place P does ana.face(road, arms: step(left))", "wrong-type", 4, 35},
    {"place P does ana.transfer()", "wrong-subject", 4, 14},
    {"place P does ana.left_arm.transfer()", "wrong-subject", 4, 14},
    {"place P does ball.step(left)", "wrong-subject", 4, 14},
    {"place P does step(left)", "no-subject", 4, 14},
    {"data k: 1 .. 9 = 3\nplace P does ana.walk(steps: k)", "not-constant", 5, 30},
    // units and times
    {"place P takes 3 m", "wrong-unit", 4, 15},
    {"place P takes 3 s + 2 m", "wrong-unit", 4, 15},
    {"place P takes auto", "auto-without-movement", 4, 9},
    {"place P tokens 0 - 1", "out-of-range", 4, 16},
    {"place P tokens 1 s", "wrong-unit", 4, 16},
    {"place P takes 1 s / 0", "division-by-zero", 4, 15},
    {"place P holds at most 0", "out-of-range", 4, 23},
    // nets
    {"place P runs n()\nnet n() { place Q }", "no-start", 4, 14},
    {"net n() { use n() as m }\nuse n()", "module-cycle", 4, 11},
    {"net n() { place P runs m() }\nnet m() { start place Q runs n() \n finish place R }\nuse n()",
     "module-cycle", 5, 30},
    {"net n() { place hidden }\nuse n() as a\nplace P\nt: P -> a.hidden", "not-public", 7, 11},
    {"place Q\nnet n() {\n place P\n t: P -> Q\n}\nuse n()", "unknown-name", 7, 10},
    {"place P tokens 1\nt: P -> P odds 0", "odds-not-positive", 5, 1},
    {"place P tokens 1\nt: 0*P -> P", "weight-not-positive", 5, 4},
    {"place P\nt: -> P", "source-without-delay", 5, 1},
    {"data x: int\nplace P\nt: P -> P set x := 1, x := 2", "two-writers", 6, 23},
    {"place P takes as Q tokens 1\nplace Q", "as-without-sibling", 4, 1},
    {"place P takes 1 s\nplace Q takes 2 s is P", "fused-disagree", 5, 1},
    {"place P of C(k: int)\ntoken C(k: int)\nt: P(l = x) -> P(k = x)", "unknown-name", 6, 6},
    {"place P of C(k: int)\ntoken C(k: int)\nt: P -> P", "missing-attribute", 6, 9},
    {"place P\nt: P -> P set P := 1", "wrong-type", 5, 15},
    {"place P\nt: P -> P on P", "wrong-type", 5, 14},
    {"place P\nt: P -> P when 3", "wrong-unit", 5, 16},
    {"place P\nt: P -> P for left", "left-without-now", 5, 1},
    {"event e every 0 s", "negative-time", 4, 15},
    // rules
    {"rule r never ana.left_leg.swinging", "unknown-name", 4, 27},
    {"rule r never 3", "wrong-unit", 4, 14},
    {"rule r ana leads to rui", "wrong-type", 4, 8},
    {"place P\nrule r P leads to P within 3", "wrong-unit", 5, 28},
    {"for p in (a, b) {\n rule r never p\n}", "unknown-name", 4, 11},
    // blocks and cast
    {"camera c { att (0, 1, 2) m }", "unknown-name", 4, 12},
    {"camera c { at (0, 1) m }", "wrong-type", 4, 15},
    {"camera c { keeps anna in view }", "unknown-name", 4, 18},
    {"camrea c { }", "unknown-name", 4, 1},
    {"cast { eve: manequin { } }", "unknown-name", 4, 13},
    {"cast { eve: mannequin { height 1.7 s } }", "wrong-unit", 4, 32},
    {"cast { eve: mannequin { height 17 m } }", "height-out-of-range", 4, 8},
    {"cast { eve: mannequin { palette teel } }", "unknown-name", 4, 33},
    {"cast { ana: stick { } }", "name-twice", 0, 0},
    {"import walk from \"missing.pup\"", "cannot-read", 4, 18},
    {"events from \"missing.txt\"", "cannot-read", 4, 1},
};

bool is_told(const Diagnostics& list, const Case& c) {
    return std::any_of(list.begin(), list.end(), [&](const Diagnostic& d) {
        return d.severity == Severity::kError && d.code == c.code &&
               (c.line == 0 || (d.where.line == c.line && d.where.column == c.column));
    });
}

}  // namespace

TEST_CASE("each defect is told with its code, line and column, and with a remedy [unit]") {
    for (const Case& c : kCases) {
        const Diagnostics list = defects_of(c.body);
        CHECK_MESSAGE(is_told(list, c), c.body << "\n wants " << c.code << " at " << c.line << ":"
                                               << c.column << "\n told:\n"
                                               << told(list));
        std::size_t errors = 0;
        for (const Diagnostic& d : list) {
            errors += d.severity == Severity::kError ? 1 : 0;
            CHECK_FALSE(d.element.empty());
            CHECK_FALSE(d.message.empty());
            const bool has_remedy = !d.remedy.empty() || d.severity != Severity::kError;
            CHECK_MESSAGE(has_remedy, told({d}));
        }
        CHECK_MESSAGE(errors <= 2, c.body << "\n told:\n"
                                          << told(list));  // no avalanche from one defect
        MemoryFiles files;
        files.add("scene.pup", with_cast(c.body));
        CHECK_FALSE(load(files, "scene.pup").has_value());
    }
}

TEST_CASE("all defects of all files are told at once, in order [unit]") {
    const Diagnostics list = defects_of(
        "import a from \"other.pup\"\nplace P takes 3 m\nplace Q does ana.thrw(ball)\nt: P -> R\n"
        "u: 0*P -> Q\nrule r never nobody\nuse a()",
        "net a() {\n place X takes 1 kg\n place Y runs missing()\n}");
    std::vector<std::pair<std::string, std::uint32_t>> got;
    for (const Diagnostic& d : list) {
        got.emplace_back(d.where.file, d.where.line);
    }
    const std::vector<std::pair<std::string, std::uint32_t>> want = {
        {"scene.pup", 5}, {"scene.pup", 6}, {"scene.pup", 7}, {"scene.pup", 8},
        {"scene.pup", 9}, {"other.pup", 2}, {"other.pup", 3}};
    CHECK_MESSAGE(got == want, told(list));
}

TEST_CASE("the nearest known name is proposed [unit]") {
    const auto remedy = [](const char* body) {
        const Diagnostics list = defects_of(body);
        REQUIRE_FALSE(list.empty());
        return list[0].remedy;
    };
    CHECK(remedy("place P does ana.thrw(ball)").find("throw") != std::string::npos);
    CHECK(remedy("place P does anna.step(left)").find("ana") != std::string::npos);
    CHECK(remedy("place to_throw\nt: to_thow -> to_throw").find("to_throw") != std::string::npos);
    CHECK(remedy("place P takes exponental(3 s)").find("exponential") != std::string::npos);
    CHECK(remedy("data x: nit = 1").find("int") != std::string::npos);
}

TEST_CASE("a defect of a net that is used twice is told once [unit]") {
    const Diagnostics list = defects_of(
        "net n(me: actor) { place P does me.thrw(ball) }\nuse n(ana) as a\nuse n(rui) as b");
    CHECK_MESSAGE(list.size() == 1, told(list));
}

TEST_CASE("nets that nobody uses, and libraries of nets, are looked at too [unit]") {
    CHECK(defects_of("net n(me: actor) { place P does me.thrw(ball) }").size() == 1);
    CHECK(defects_of("net n(me: actor, k: int) { place P does me.throw(ball, to: me) tokens k }")
              .empty());
    MemoryFiles files;
    files.add("lib.pup",
              "net n(me: actor, other: n, k: int) {\n place P does me.walk(step: k)\n place Q "
              "takes 3 m\n t: P + other.Q -> R\n}\n");
    const Diagnostics list = check(files, "lib.pup");
    CHECK_MESSAGE(list.size() == 3, told(list));
    CHECK_FALSE(load(files, "lib.pup").has_value());
}

TEST_CASE("a file that cannot be read or parsed gives its own errors and no others [hostile]") {
    MemoryFiles files;
    CHECK(check(files, "nothing.pup").at(0).code == "cannot-read");
    files.add("scene.pup", "import walk from \"other.pup\"\nplace P runs walk(ana)\n");
    files.add("other.pup", "net walk( {\n");
    for (const Diagnostic& d : check(files, "scene.pup")) {
        CHECK_MESSAGE(d.where.file == "other.pup", told({d}));
    }
    files.add("bad.pup", std::string("scene \"\xff\xfe\"\n"));
    CHECK(has_errors(check(files, "bad.pup")));
}

TEST_CASE("no truncation of a scene crashes or loads half [hostile]") {
    ExampleFiles examples;
    const std::string whole = *examples.read("03_ball/figure5.pup");
    for (std::size_t n = 0; n < whole.size(); n += 37) {
        MemoryFiles files;
        files.add("scene.pup", whole.substr(0, n));
        const Diagnostics list = check(files, "scene.pup");
        MemoryFiles again;
        again.add("scene.pup", whole.substr(0, n));
        CHECK(load(again, "scene.pup").has_value() == !has_errors(list));
    }
}

TEST_CASE("nets that would grow without bound are refused in time [hostile]") {
    std::string body = "net n0() { place P }\n";
    for (int i = 1; i < 40; ++i) {
        const std::string below = "n" + std::to_string(i - 1);
        body += "net n" + std::to_string(i) + "() {\n use " + below + "() as a\n use " + below +
                "() as b\n}\n";
    }
    const Diagnostics list = defects_of(body + "use n39() as root");
    CHECK(std::any_of(list.begin(), list.end(),
                      [](const Diagnostic& d) { return d.code == "net-too-large"; }));
    CHECK(defects_of("for i in 1 .. 1000000000000 {\n place P[i]\n}").at(0).code ==
          "net-too-large");
}

}  // namespace puppetri::scene
