// SPDX-License-Identifier: MIT
// Linda: operations by hand, and random programs, which are played firing for firing against an
// interpreter of tuple spaces that knows nothing of nets.
#include <algorithm>
#include <array>
#include <map>
#include <set>

#include "playing.h"
#include "puppetri/base/random.h"

namespace puppetri::notation {
namespace {

TEST_CASE("tuples are put, taken and read by patterns; eval begins processes [unit]") {
    CHECK(log_of(R"(use space as s
linda space {
  tuple task(n: 0 .. 9, hard: bool)
  tuple sum(n: 0 .. 99)
  start boss
  out sum(0)
  process boss {
    let i: 0 .. 3 := 3
    while i > 0 {
      out task(i, i = 2)
      eval worker(i)
      let i := i - 1
    }
  }
  process worker(mine: 0 .. 3) {
    in task(mine, get(hard))
    if hard {
      wait 5 s
    }
    else {
      wait 1 s
    }
    in sum(get(n: 0 .. 99))
    out sum(n + mine)
    rd sum(6)
    last: wait 1 s
  }
}
)",
                 20)
              .back() == "6 s s.worker_last_done");
}

TEST_CASE("inp and rdp go on at once, with the one case or the other [unit]") {
    for (const bool there : {false, true}) {
        const std::vector<std::string> log = log_of(std::string(R"(use space as s
linda space {
  tuple a(n: 0 .. 3)
  tuple b
  start p
  out a(1)
)") + (there ? "  out a(2)\n" : "") + R"(  process p {
    inp a(2) {
      yes: out b
    }
    else {
      no: wait 1 s
    }
    rdp b {
      both: wait 2 s
    }
  }
}
)",
                                                    20);
        CHECK(log.back() == (there ? "2 s s.p_both_done" : "1 s s.p_rdp_b_none"));
    }
}

TEST_CASE("an evaluated tuple is there when its process has come back, not before [unit]") {
    const std::vector<std::string> log = log_of(R"(use space as s
linda space {
  tuple square(n: 0 .. 3, s: 0 .. 9)
  start p
  process p {
    eval square(3, times(3))
    inp square(_, _) {
      early: wait 1 s
    }
    rd square(get(n), get(s))
    if n = 3 and s = 9 {
      right: wait 1 s
    }
  }
  process times(n: 0 .. 3) {
    wait 2 s
    return n*n
  }
}
)",
                                                20);
    CHECK(log.back() == "3 s s.p_right_done");
    CHECK(std::count(log.begin(), log.end(), "2 s s.times_to_square_return_done") == 1);
    CHECK(std::count(log.begin(), log.end(), "0 s s.p_inp_square_none") == 1);
}

TEST_CASE("who is taken where several tuples fit is what the kind of tuple says [unit]") {
    for (const auto& [policy, wanted] : std::map<std::string, std::string>{
             {"oldest", "213"}, {"newest", "312"}, {"least n", "123"}, {"most n", "321"}}) {
        std::string got;
        for (const std::string& line :
             log_of("use space as s\nlinda space {\n  tuple a(n: 1 .. 3) " + policy + R"(
  start p
  process p {
    out a(2)
    wait 1 s
    out a(1)
    wait 1 s
    out a(3)
    repeat 3 {
      in a(get(n))
      if n = 1 { one: wait 1 s }
      if n = 2 { two: wait 1 s }
      if n = 3 { three: wait 1 s }
    }
  }
}
)",
                    20)) {
            got += line.find("p_one_done") != line.npos     ? "1"
                   : line.find("p_two_done") != line.npos   ? "2"
                   : line.find("p_three_done") != line.npos ? "3"
                                                            : "";
        }
        INFO(policy);
        CHECK(got == wanted);
    }
}

TEST_CASE(
    "a space that ends does the work of a place, again and again, and leaves nothing [unit]") {
    const std::vector<std::string> log = log_of(R"(place p runs space(2) tokens 1
place q takes 1 s
go: p -> q
back: q -> p
linda space(n: int) {
  tuple task(k: 1 .. 3)
  tuple left_over
  out n task(1)
  out task(3)
  start worker(1)
  ends
  process worker(mine: 1 .. 3) {
    repeat 2 {
      in task(1)
      wait 1 s
    }
    out left_over
    eval helper
  }
  process helper {
    wait 2 s
  }
}
)",
                                                12);
    std::vector<std::string> outside;
    std::copy_if(log.begin(), log.end(), std::back_inserter(outside),
                 [](const std::string& line) { return line.find("p.") == line.npos; });
    CHECK(outside == std::vector<std::string>{"4 s go", "5 s back", "9 s go", "10 s back"});
}

TEST_CASE("figures are known before the run: each choice has a program of its own [unit]") {
    const scene::Scene scene = from_text(R"(until 20 s
cast {
  ana: mannequin
  rui: mannequin { at (2, 0, 0) m }
}
use space(rui) as s
linda space(other: actor) {
  tuple turn(who: actor)
  start first(ana)
  process first(me: actor) {
    does me.wave()
    eval second(me)
    eval second(other)
    out turn(other)
  }
  process second(me: actor) {
    in turn(me)
    let n: 1 .. 3 := 2
    does me.wave(times: n)
  }
}
)");
    CHECK(scene.net.find_place("s.first_ana_wave").value != net::PlaceIndex{}.value);
    CHECK(scene.net.find_place("s.second_ana_wave").value != net::PlaceIndex{}.value);
    CHECK(scene.net.find_place("s.second_other_wave").value != net::PlaceIndex{}.value);
}

TEST_CASE("defects of tuple spaces are told where they stand [unit]") {
    std::string got;
    for (const Diagnostic& d : defects_of(R"(use space
cast { ana: mannequin }
linda space {
  tuple a(n: 0 .. 3)
  tuple who(me: actor)
  start p
  process p {
    out a(get(x))
    in b(1)
    in a(1, 2)
    repeat {
      rd a(1)
    }
    out a(1)
  }
  process q {
    take a(1)
  }
  start r
  process r {
    out a(4)
    out a(yes)
    in who(get(w))
    out a(w)
    eval s(w)
    does w.wave()
    eval a(1)
    eval a(v)
    in a(get(w))
    eval u(1)
    wait 1 s
    else {
    }
  }
  process s(me: actor) {
    return
    out a(1)
  }
  process v {
    wait 1 s
  }
  tuple a
  nothing
}
)")) {
        got += std::to_string(d.where.line) + " " + d.code + "\n";
        CHECK_FALSE(d.remedy.empty());
    }
    for (const char* defect : {"10 formal-in-out",
                               "11 unknown-name",
                               "12 wrong-fields",
                               "13 zero-time-loop",
                               "16 never-reached",
                               "18 never-begun",
                               "19 unknown-operation",
                               "23 out-of-range",
                               "24 type-mismatch",
                               "25 never-put",
                               "26 type-mismatch",
                               "27 not-known-before",
                               "28 not-known-before",
                               "29 eval-without-process",
                               "31 type-mismatch",
                               "32 unknown-name",
                               "34 syntax",
                               "39 never-reached",
                               "41 no-value",
                               "44 name-twice",
                               "45 syntax"}) {
        INFO(got);
        INFO(defect);
        CHECK(got.find(defect) != got.npos);
    }
}

TEST_CASE("a defect of a program is told once, however many run it [unit]") {
    const Diagnostics list = defects_of(R"(use s
cast {
  ana: mannequin
  rui: mannequin { at (2, 0, 0) m }
}
linda s {
  start p(ana)
  start p(rui)
  process p(me: actor) {
    wait
    does me.wave() twice
    eval nobody(me)
  }
}
)");
    CHECK(list.size() == 3);
}

TEST_CASE("tuples that nobody puts, and those that nobody takes, are warned of [unit]") {
    const auto told_of = [](const char* lines) {
        std::string got;
        for (const Diagnostic& d : defects_of(std::string("until 10 s\nuse space\nlinda space {\n"
                                                          "  tuple a(n: 0 .. 3, b: bool)\n") +
                                              lines + "}\n")) {
            got += std::to_string(d.where.line) + " " + d.code + "\n";
        }
        return got;
    };
    CHECK(told_of("  start p\n  process p {\n    in a(2, get(b))\n  }\n  out a(1, yes)\n") ==
          "9 never-put\n");
    CHECK(told_of("  start p\n  process p {\n    in a(1, get(b))\n  }\n  out a(1, yes)\n") == "");
    CHECK(told_of("  start p\n  process p {\n    repeat {\n      wait 1 s\n      out a(1, yes)\n"
                  "    }\n  }\n") == "11 grows-without-bound\n");
    for (const char* round :
         {"in a(get(n), get(b))\n      out a(n, b)", "in a(_, _)\n      out a(1, no)"}) {
        CHECK(
            told_of((std::string("  out a(1, no)\n  start p\n  process p {\n    repeat {\n      ") +
                     round + "\n    }\n  }\n")
                        .c_str()) == "10 zero-time-poll\n");
    }
    CHECK(told_of(
              "  out a(1, no)\n  start p\n  process p {\n    repeat {\n      in a(1, _)\n"
              "      out a(2, no)\n    }\n  }\n  start q\n  process q {\n    in a(2, _)\n  }\n") ==
          "");
    CHECK(told_of("  start p\n  process p {\n    eval q\n  }\n  process q {\n    eval p\n  }\n")
              .find("zero-time-loop") != std::string::npos);
    CHECK(told_of("  start p\n  process p {\n    wait 1 s\n    eval p\n    eval p\n  }\n") ==
          "11 unbounded-processes\n");
    CHECK(told_of("  start p\n  process p {\n    repeat {\n      wait 1 s\n      eval q\n    }\n"
                  "  }\n  process q {\n    repeat {\n      wait 1 s\n    }\n  }\n") ==
          "11 unbounded-processes\n");
    CHECK(told_of("  start p\n  process p {\n    wait 1 s\n    eval p\n  }\n") == "");
}

// ---------------------------------------------------------------------------------------------------------------------
// Random programs

constexpr int kVariables = 6;
constexpr int kWidth[] = {1, 1, 2};  // fields of t0, t1, t2; each 0 or 1

struct Argument {
    enum { kConstant, kVariable, kGet, kAny } what = kConstant;
    int value = 0;  // or the number of the variable
};
struct Instruction {
    enum What {
        kBegin,
        kOut,
        kIn,
        kRd,
        kInp,
        kRdp,
        kIf,
        kLet,
        kRepeat,
        kEval,
        kReturn,
        kSet,
        kJump
    };
    What what = kBegin;
    int label = 0, kind = 0;
    std::array<Argument, 2> arguments{};  // kIf: variable, constant; kLet: variable, negated one
    int live = 0;                         // kEval: which field is the process
    Argument given;                       // and what it gets
    std::size_t otherwise = 0;            // where to go on: kJump, what finds none, kRepeat's end
};
using Program = std::vector<Instruction>;

using Tuple = std::array<int, 3>;  // kind, fields
struct Process {
    std::size_t program = 0, at = 0;
    std::array<int, kVariables + 3> variables{};  // behind the named ones counters of loops
    Tuple becomes{-1, -1, -1};                    // -2: its own value
    auto operator<=>(const Process&) const = default;
};
struct World {
    std::multiset<Tuple> tuples;
    std::multiset<Process> processes;
    auto operator<=>(const World&) const = default;
};

struct Interpreter {
    std::vector<Program> programs;
    std::vector<std::string> names;

    // What needs no operation of its own.
    void settle(Process& p) const {
        for (const Program& program = programs[p.program]; p.at < program.size();) {
            const Instruction& x = program[p.at];
            if (x.what == Instruction::kJump) {
                p.at = x.otherwise;
            } else if (x.what == Instruction::kSet) {
                p.variables[static_cast<std::size_t>(x.kind)] = x.label;
                ++p.at;
            } else {
                break;
            }
        }
    }
    static int value(const Argument& a, const Process& p) {
        return a.what == Argument::kVariable ? p.variables[static_cast<std::size_t>(a.value)]
                                             : a.value;
    }
    static bool fits(const Tuple& t, const Instruction& x, const Process& p) {
        bool good = t[0] == x.kind;
        for (int i = 0; good && i < kWidth[x.kind]; ++i) {
            const Argument& a = x.arguments[static_cast<std::size_t>(i)];
            good = a.what == Argument::kGet || a.what == Argument::kAny ||
                   value(a, p) == t[static_cast<std::size_t>(i) + 1];
        }
        return good;
    }
    std::string name_of(const Process& p) const {
        return names[p.program] + (p.becomes[0] >= 0 ? "_to_t" + std::to_string(p.becomes[0]) : "");
    }

    // Every operation that is possible, as the log calls it, and the world after it.
    std::vector<std::pair<std::string, World>> steps(const World& world) const {
        std::vector<std::pair<std::string, World>> out;
        const std::set<Process> different(world.processes.begin(), world.processes.end());
        for (const Process& p : different) {
            const Instruction& x = programs[p.program][p.at];
            const std::string label = name_of(p) + "_l" + std::to_string(x.label);
            const auto go = [&](const char* how, World next, Process after, std::size_t at) {
                next.processes.erase(next.processes.find(p));
                after.at = at;
                settle(after);
                if (after.at < programs[after.program].size()) {
                    next.processes.insert(after);
                }
                out.emplace_back((x.what == Instruction::kBegin ? name_of(p) : label) + how,
                                 std::move(next));
            };
            switch (x.what) {
                case Instruction::kBegin:
                    go("_begins", world, p, p.at + 1);
                    break;
                case Instruction::kOut: {
                    World next = world;
                    next.tuples.insert({x.kind, value(x.arguments[0], p),
                                        kWidth[x.kind] > 1 ? value(x.arguments[1], p) : 0});
                    go("_done", std::move(next), p, p.at + 1);
                    break;
                }
                case Instruction::kIn:
                case Instruction::kRd:
                case Instruction::kInp:
                case Instruction::kRdp: {
                    const bool asks = x.what == Instruction::kInp || x.what == Instruction::kRdp;
                    bool none = true;
                    const std::set<Tuple> each(world.tuples.begin(), world.tuples.end());
                    for (const Tuple& t : each) {
                        if (!fits(t, x, p)) {
                            continue;
                        }
                        none = false;
                        World next = world;
                        if (x.what == Instruction::kIn || x.what == Instruction::kInp) {
                            next.tuples.erase(next.tuples.find(t));
                        }
                        Process after = p;
                        for (std::size_t i = 0; i < 2; ++i) {
                            if (x.arguments[i].what == Argument::kGet) {
                                after.variables[static_cast<std::size_t>(x.arguments[i].value)] =
                                    t[i + 1];
                            }
                        }
                        go(asks ? "_found" : "_done", std::move(next), after, p.at + 1);
                    }
                    if (none && asks) {
                        go("_none", world, p, x.otherwise);
                    }
                    break;
                }
                case Instruction::kIf: {
                    const bool yes = value(x.arguments[0], p) == x.arguments[1].value;
                    go(yes ? "_true" : "_false", world, p, yes ? p.at + 1 : x.otherwise);
                    break;
                }
                case Instruction::kLet: {
                    Process after = p;
                    after.variables[static_cast<std::size_t>(x.arguments[0].value)] =
                        1 - value(x.arguments[1], p);
                    go("_done", world, after, p.at + 1);
                    break;
                }
                case Instruction::kRepeat: {
                    Process after = p;
                    int& left = after.variables[static_cast<std::size_t>(x.kind)];
                    const bool more = left > 0;
                    left -= more ? 1 : 0;
                    go(more ? "_round" : "_ends", world, after, more ? p.at + 1 : x.otherwise);
                    break;
                }
                case Instruction::kEval: {
                    World next = world;
                    Process born;
                    born.program = programs.size() - 1;
                    born.variables[0] = value(x.given, p);
                    born.becomes = {x.kind, 0, 0};
                    for (int i = 0; i < kWidth[x.kind]; ++i) {
                        const auto field = static_cast<std::size_t>(i);
                        born.becomes[field + 1] = i == x.live ? -2 : value(x.arguments[field], p);
                    }
                    next.processes.insert(born);
                    go("_done", std::move(next), p, p.at + 1);
                    break;
                }
                case Instruction::kReturn: {
                    World next = world;
                    Tuple t = p.becomes;
                    std::replace(t.begin() + 1, t.end(), -2, value(x.arguments[0], p));
                    next.tuples.insert(t);
                    go("_done", std::move(next), p, programs[p.program].size());
                    break;
                }
                case Instruction::kSet:
                case Instruction::kJump:
                    break;
            }
        }
        return out;
    }

    void ends_of(const World& world, std::set<World>& seen,
                 std::set<std::multiset<Tuple>>& ends) const {
        if (seen.size() > 20'000 || !seen.insert(world).second) {
            return;
        }
        const auto next = steps(world);
        for (const auto& [name, after] : next) {
            ends_of(after, seen, ends);
        }
        if (next.empty()) {
            ends.insert(world.tuples);
        }
    }
};

// Writes a program as text and as instructions.
struct Author {
    RandomStream rng;
    std::string text;
    int label = 0, counters = 0;
    bool may_eval = true;

    int below(int n) { return static_cast<int>(rng.below(static_cast<std::uint64_t>(n))); }
    Argument given(int variables, std::string& out) {
        Argument a;
        if (variables > 0 && below(2) == 0) {
            a = {Argument::kVariable, below(variables)};
            out += "v" + std::to_string(a.value);
        } else {
            a = {Argument::kConstant, below(2)};
            out += std::to_string(a.value);
        }
        return a;
    }
    void lines(Program& p, int depth, const std::string& indent, int variables) {
        using I = Instruction;
        for (int i = 0, n = 1 + below(3); i < n; ++i) {
            static constexpr I::What kWhat[] = {I::kOut,  I::kOut, I::kIn,  I::kRd, I::kLet,
                                                I::kEval, I::kInp, I::kRdp, I::kIf, I::kRepeat};
            I x;
            x.what = kWhat[below(depth > 0 ? 10 : 6)];
            if ((x.what == I::kEval && !may_eval) ||
                ((x.what == I::kLet || x.what == I::kIf) && variables == 0)) {
                x.what = I::kOut;
            }
            if (x.what == I::kRepeat && counters >= 3) {
                x.what = I::kIn;
            }
            x.label = ++label;
            x.kind = below(3);
            text += indent + "l" + std::to_string(x.label) + ": ";
            int inner = variables;
            const std::string t = " t" + std::to_string(x.kind) + "(";
            if (x.what == I::kOut || x.what == I::kEval) {
                x.live = kWidth[x.kind] - 1;
                text += (x.what == I::kOut ? "out" : "eval") + t;
                for (int f = 0; f < kWidth[x.kind]; ++f) {
                    text += f == 0 ? "" : ", ";
                    if (x.what == I::kEval && f == x.live) {
                        text += "q(";
                        x.given = given(variables, text);
                        text += ")";
                    } else {
                        x.arguments[static_cast<std::size_t>(f)] = given(variables, text);
                    }
                }
                text += ")\n";
            } else if (x.what == I::kLet) {
                x.arguments[0] = {Argument::kVariable, below(variables)};
                x.arguments[1] = {Argument::kVariable, below(variables)};
                text += "let v" + std::to_string(x.arguments[0].value) + " := 1 - v" +
                        std::to_string(x.arguments[1].value) + "\n";
            } else if (x.what == I::kIf) {
                x.arguments[0] = {Argument::kVariable, below(variables)};
                x.arguments[1].value = below(2);
                text += "if v" + std::to_string(x.arguments[0].value) + " = " +
                        std::to_string(x.arguments[1].value) + " {\n";
            } else if (x.what == I::kRepeat) {
                x.kind = kVariables + counters++;
                const int rounds = below(3);
                text += "repeat " + std::to_string(rounds) + " {\n";
                I set;
                set.what = I::kSet;
                set.kind = x.kind;
                set.label = rounds;
                p.push_back(set);
            } else {
                static const std::map<I::What, const char*> kNames = {
                    {I::kIn, "in"}, {I::kRd, "rd"}, {I::kInp, "inp"}, {I::kRdp, "rdp"}};
                text += kNames.at(x.what) + t;
                for (int f = 0; f < kWidth[x.kind]; ++f) {
                    Argument& a = x.arguments[static_cast<std::size_t>(f)];
                    text += f == 0 ? "" : ", ";
                    const int k = below(4);
                    if (k == 0) {
                        a.what = Argument::kAny;
                        text += "_";
                    } else if (k < 3 && inner < kVariables) {
                        // A new variable, or an old one that no field before has got.
                        const bool old = f == 0 && variables > 0 && below(3) == 0;
                        a = {Argument::kGet, old ? below(variables) : inner++};
                        text += "get(v" + std::to_string(a.value) + ")";
                    } else {
                        a = given(variables, text);
                    }
                }
                text += x.what == I::kIn || x.what == I::kRd ? ")\n" : ") {\n";
            }
            const std::size_t here = p.size();
            p.push_back(x);
            if (x.what == I::kRepeat) {
                lines(p, depth - 1, indent + "  ", variables);
                text += indent + "}\n";
                I back;
                back.what = I::kJump;
                back.otherwise = here;
                p.push_back(back);
                p[here].otherwise = p.size();
            } else if (x.what == I::kInp || x.what == I::kRdp || x.what == I::kIf) {
                lines(p, depth - 1, indent + "  ", inner);
                text += indent + "}\n" + indent + "else {\n";
                const std::size_t jump = p.size();
                p.push_back({});
                p[jump].what = I::kJump;
                p[here].otherwise = p.size();
                lines(p, depth - 1, indent + "  ", variables);
                text += indent + "}\n";
                p[jump].otherwise = p.size();
            } else {
                variables = inner;
            }
        }
    }
    void value(Program& p, int variables) {
        Instruction x;
        x.what = Instruction::kReturn;
        x.label = ++label;
        text += "    l" + std::to_string(x.label) + ": return ";
        x.arguments[0] = given(variables, text);
        text += "\n  }\n";
        p.push_back(x);
    }
};

std::string text_of(const Tuple& t) {
    return "t" + std::to_string(t[0]) + "_" + std::to_string(t[1]) + "_" + std::to_string(t[2]);
}

TEST_CASE("random programs do only what an interpreter may do, and end where it ends [oracle]") {
    int covered = 0, choices = 0, evals = 0;
    constexpr int kPrograms = 300;
    for (std::uint64_t seed = 1; seed <= kPrograms; ++seed) {
        Author author{
            .rng = RandomStream{seed}, .text = "", .label = 0, .counters = 0, .may_eval = true};
        author.text = "until 100 s\nuse space as s\nlinda space {\n";
        for (int k = 0; k < 3; ++k) {
            author.text += "  tuple t" + std::to_string(k) + "(a: 0 .. 1" +
                           (kWidth[k] > 1 ? ", b: 0 .. 1" : "") + ")\n";
        }
        World world;
        for (int i = 0; i < 2; ++i) {
            Tuple t{author.below(3), author.below(2), 0};
            t[2] = kWidth[t[0]] > 1 ? author.below(2) : 0;
            world.tuples.insert(t);
            author.text += "  out t" + std::to_string(t[0]) + "(" + std::to_string(t[1]) +
                           (kWidth[t[0]] > 1 ? ", " + std::to_string(t[2]) : "") + ")\n";
        }
        Interpreter interpreter;
        for (std::size_t i = 0; i < 3; ++i) {
            const bool last = i == 2;  // it is begun by eval alone
            const std::string name = last ? "q" : "p" + std::to_string(i);
            author.text += (last ? "" : "  start " + name + "\n") + "  process " + name +
                           (last ? "(v0: 0 .. 1)" : "") + " {\n";
            author.may_eval = !last;
            author.counters = 0;
            Program program(1);
            author.lines(program, 1, "    ", last ? 1 : 0);
            if (last) {
                author.value(program, 1);
            } else {
                author.text += "  }\n";
                Process begins;
                begins.program = i;
                world.processes.insert(begins);
            }
            interpreter.programs.push_back(std::move(program));
            interpreter.names.push_back(name);
        }
        author.text += "}\n";
        // What is left is counted by others, in other seconds.
        for (int k = 0; k < 3; ++k) {
            for (int v = 0; v < 2 << (kWidth[k] - 1); ++v) {
                const Tuple t{k, v / kWidth[k], kWidth[k] > 1 ? v % 2 : 0};
                author.text +=
                    text_of(t) + ": s.t" + std::to_string(k) + "(a = " + std::to_string(t[1]) +
                    (kWidth[k] > 1 ? ", b = " + std::to_string(t[2]) : "") + ") -> after 1 s\n";
            }
        }
        evals += author.text.find("eval") != author.text.npos ? 1 : 0;
        INFO(author.text);
        std::set<World> seen;
        std::set<std::multiset<Tuple>> wanted, got;
        interpreter.ends_of(world, seen, wanted);
        const scene::Scene scene = from_text(author.text);
        for (std::uint64_t run = 1; run <= 40; ++run) {
            std::set<World> worlds{world};
            std::multiset<std::string> left;
            std::string told;
            for (const std::string& line : log_of(scene, 100, run)) {
                told += line + "\n";
                const std::string name = line.substr(line.find(" s ") + 3);
                if (line.rfind("0 s s.", 0) != 0) {
                    left.insert(name);
                    continue;
                }
                std::set<World> next;
                for (const World& w : worlds) {
                    for (auto& [step, after] : interpreter.steps(w)) {
                        if ("s." + step == name) {
                            next.insert(std::move(after));
                        }
                    }
                }
                worlds = std::move(next);
            }
            bool agrees = false;
            for (const World& w : worlds) {
                std::multiset<std::string> tuples;
                for (const Tuple& t : w.tuples) {
                    tuples.insert(text_of(t));
                }
                if (tuples == left && interpreter.steps(w).empty()) {
                    agrees = true;
                    got.insert(w.tuples);
                }
            }
            if (!agrees) {
                INFO(told);
                REQUIRE(agrees);
            }
        }
        covered += got == wanted ? 1 : 0;
        choices += wanted.size() > 1 ? 1 : 0;
    }
    MESSAGE("all ends seen of " << covered << " programs; " << choices << " have several, " << evals
                                << " begin processes");
    CHECK(covered >= kPrograms * 8 / 10);
    CHECK(choices >= kPrograms / 10);
    CHECK(evals >= kPrograms / 4);
}

}  // namespace
}  // namespace puppetri::notation
