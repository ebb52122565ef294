// SPDX-License-Identifier: MIT
// Space-time-event scripts: cues by hand, and random scripts against times that are computed cue by
// cue, without any net.
#include <algorithm>
#include <map>

#include "playing.h"

namespace puppetri::notation {
namespace {

constexpr const char* kCast =
    "cast { ana: mannequin, rui: mannequin, ball: sphere { diameter 22 cm } }\n";

TEST_CASE("cues begin at their times, with their events, and after one another [unit]") {
    std::vector<std::string> got = log_of(std::string(kCast) + R"(use play(bell, far, table) as p
use tables as table
event bell at 4 s, 9 s
event far
net tables { public place laid takes 12 s tokens 1 }
script play(bell: event, far: event, table: tables) {
  from 1 s to 3.5 s: ana bows
  then: ana waves for 1 s
  after ana_bows + 0.25 s: rui faces ana for 1 s
  when bell: ana and rui bow for 2 s as together
  whenever bell: rui waves for 1 s
  after together and ana_waves: raise far
  with table.laid: ana looks at rui for 1 s
}
)",
                                          20);
    std::vector<std::string> wanted = std::vector<std::string>{"0 s p.start",
                                                               "1 s p.ana_bows_begins",
                                                               "3.5 s p.ana_bows_ends",
                                                               "3.5 s p.ana_waves_begins",
                                                               "3.75 s p.rui_faces_begins",
                                                               "4 s p.together_begins",
                                                               "4 s p.rui_waves_begins",
                                                               "4.5 s p.ana_waves_ends",
                                                               "4.75 s p.rui_faces_ends",
                                                               "5 s p.rui_waves_ends",
                                                               "6 s p.together_ends",
                                                               "6 s p.raise_far_begins",
                                                               "6 s p.raise_far_ends",
                                                               "9 s p.rui_waves_begins",
                                                               "10 s p.rui_waves_ends",
                                                               "12 s p.ana_looks_begins",
                                                               "13 s p.ana_looks_ends"};
    // Of one event the order is drawn.
    std::sort(got.begin(), got.end());
    std::sort(wanted.begin(), wanted.end());
    CHECK(got == wanted);
}

TEST_CASE("verbs are movements, prepositions their parameters, marks points [law]") {
    const auto same = [](const std::string& line, const std::string& does) {
        const std::string script = std::string(kCast) +
                                   "use s\nscript s {\n  mark here (1, 0, 2) m\n  at 1 s: " + line +
                                   " as cue\n}\n";
        const std::string net = std::string(kCast) + "use s\nnet s {\n  public place cue does " +
                                does + " takes 2 s\n}\n";
        const scene::Scene a = from_text(script), b = from_text(net);
        REQUIRE(a.play.actions.size() == 1);
        REQUIRE(b.play.actions.size() == 1);
        INFO(line);
        const motion::BoundCall &x = a.play.actions[0].call, &y = b.play.actions[0].call;
        CHECK(x.movement == y.movement);
        REQUIRE(x.arguments.size() == y.arguments.size());
        for (std::size_t i = 0; i < x.arguments.size(); ++i) {
            CHECK(x.arguments[i].parameter == y.arguments[i].parameter);
            CHECK(bool(x.arguments[i].value == y.arguments[i].value));
        }
    };
    same("ana waves for 2 s", "ana.wave()");
    same("ana waves(times: 2) for 2 s", "ana.wave(times: 2)");
    same("ana walks 6 steps for 2 s", "ana.walk(steps: 6)");
    same("ana catches ball for 2 s", "ana.catch(ball)");
    same("ana carries ball for 2 s", "ana.carry(ball)");
    same("ana throws ball to rui for 2 s", "ana.throw(ball, to: rui)");
    same("ana picks up ball for 2 s", "ana.pick_up(ball)");
    same("ana hands over ball to rui for 2 s", "ana.hand_over(ball, to: rui)");
    same("ana goes to here for 2 s", "ana.go(to: (1, 0, 2) m)");
    same("ana moves here to (2, 0, 2) m for 2 s", "ana.go(to: (2, 0, 2) m)");
    same("ana faces rui for 2 s", "ana.face(rui)");
}

TEST_CASE("defects of scripts are told where they stand [unit]") {
    std::string got;
    for (const Diagnostic& d : defects_of(std::string(kCast) + R"(use s(x)
script s(x: event) {
  from 3 s to 2 s: ana waves
  during 3 s: ana waves
  at 2 s: ana
  after nothing: ana waves
  after me: ana waves as me
  at 1 s: ana bows as once
  at 2 s: rui bows as once
  at 3 s: ana moves (0, 0, 0) m to (1, 0, 0) m
  at 9 s: ana moves (2, 0, 0) m to (3, 0, 0) m
}
event x
)")) {
        got += std::to_string(d.where.line) + " " + d.code + "\n";
        CHECK_FALSE(d.remedy.empty());
    }
    CHECK(got ==
          "6 ends-before-it-begins\n7 syntax\n8 syntax\n9 unknown-name\n10 cue-cycle\n"
          "12 name-twice\n14 stands-elsewhere\n");
}

TEST_CASE("random scripts begin and end as their cues say [oracle]") {
    std::uint64_t state = 7;
    const auto below = [&](long n) {
        state = state * 6364136223846793005u + 1442695040888963407u;
        return static_cast<long>((state >> 33) % static_cast<std::uint64_t>(n));
    };
    for (int round = 0; round < 150; ++round) {
        // Occurrences, in ms, at odd half milliseconds.
        std::vector<std::vector<long>> events(2);
        std::string text = kCast;
        for (int e = 0; e < 2; ++e) {
            std::string times;
            for (int i = 0; i < 3; ++i) {
                events[static_cast<std::size_t>(e)].push_back(below(20000));
            }
            std::sort(events[static_cast<std::size_t>(e)].begin(),
                      events[static_cast<std::size_t>(e)].end());
            for (const long t : events[static_cast<std::size_t>(e)]) {
                times += (times.empty() ? "" : ", ") + std::to_string(t) + ".5 ms";
            }
            text += "event e" + std::to_string(e) + " at " + times + "\n";
        }
        text += "use s(e0, e1)\nscript s(e0: event, e1: event) {\n";
        std::vector<double> begins, ends;
        std::map<std::string, std::vector<double>> wanted;
        const int cues = 1 + static_cast<int>(below(8));
        for (int i = 0; i < cues; ++i) {
            const std::string name = "c" + std::to_string(i);
            const double lasts = static_cast<double>(1 + below(5000));
            double at = 0;
            std::string line;
            const long kind = below(i == 0 ? 3 : 5);
            if (kind == 0) {
                const long t = below(9000);
                at = static_cast<double>(t);
                line = "at " + std::to_string(t) + " ms";
            } else if (kind == 1) {
                const long t = below(9000);
                at = static_cast<double>(t);
                line = "from " + std::to_string(t) + " ms to " +
                       std::to_string(t + static_cast<long>(lasts)) + " ms";
            } else if (kind == 2) {
                const auto e = static_cast<std::size_t>(below(2));
                at = static_cast<double>(events[e][0]) + 0.5;
                line = "when e" + std::to_string(e);
            } else if (kind == 3) {
                at = ends.back();
                line = "then";
            } else {
                const auto a = static_cast<std::size_t>(below(i)),
                           b = static_cast<std::size_t>(below(i));
                const long wait = 1 + below(999);
                at = std::max(ends[a], ends[b] + static_cast<double>(wait));
                line = "after c" + std::to_string(a) + " and c" + std::to_string(b) + " + " +
                       std::to_string(wait) + " ms";
            }
            text += "  " + line + ": ana waves" +
                    (kind == 1 ? "" : " for " + std::to_string(static_cast<long>(lasts)) + " ms") +
                    " as " + name + "\n";
            begins.push_back(at);
            ends.push_back(at + lasts);
            wanted["s." + name + "_begins"].push_back(at / 1000);
            wanted["s." + name + "_ends"].push_back((at + lasts) / 1000);
        }
        text += "}\n";
        std::map<std::string, std::vector<double>> got;
        for (const std::string& line : log_of(text, 200)) {
            const std::size_t space = line.rfind(' ');
            const std::string name = line.substr(space + 1);
            if (name.find("_begins") != name.npos || name.find("_ends") != name.npos) {
                got[name].push_back(std::stod(line));
            }
        }
        INFO(text);
        REQUIRE(got.size() == wanted.size());
        for (const auto& [name, times] : wanted) {
            REQUIRE(got[name].size() == times.size());
            CHECK(got[name][0] == doctest::Approx(times[0]).epsilon(1e-9));
        }
    }
}

}  // namespace
}  // namespace puppetri::notation
