// SPDX-License-Identifier: MIT
// TOOKIMA scripts: what they mean, against a direct sampler, and what their slips are told as.
#include <algorithm>
#include <cstdlib>
#include <map>
#include <optional>
#include <random>

#include "playing.h"

namespace puppetri::notation {
namespace {

scene::MemoryFiles file_of(const std::string& script) {
    scene::MemoryFiles files;
    files.add("script.tookima", script);
    return files;
}

// Without the turns, which say nothing.
std::vector<std::string> actions_of(const std::string& script, double seconds = 1e4) {
    scene::MemoryFiles files = file_of(script);
    Checked<scene::Scene> loaded = scene::load(files, "script.tookima");
    if (!loaded) {
        FAIL(told(loaded.error()));
    }
    std::vector<std::string> out;
    for (std::string& line : log_of(*loaded, seconds)) {
        const bool turn =
            line.find(" sample") != std::string::npos || line.find(".waits") != std::string::npos;
        if (!turn) {
            out.push_back(std::move(line));
        }
    }
    return out;
}

using Codes = std::vector<std::pair<std::uint32_t, std::string>>;

// Line and code of everything that is told, without the note of functions that are bound to nobody.
Codes codes_of(const std::string& script) {
    scene::MemoryFiles files = file_of(script);
    Codes out;
    for (const Diagnostic& d : scene::check(files, "script.tookima")) {
        if (d.code != "unbound-function") {
            out.emplace_back(d.where.line, d.code);
            CHECK_FALSE(d.remedy.empty());
        }
    }
    return out;
}

// Line 12 begins the controller.
constexpr const char* kLegs = R"(DEF_ESM(CTRL, "L0") /* a comment */
DEF_ESM(LEFT_LEG, "SL")
DEF_ESM(RIGHT_LEG, "SR")
DEF_EVENT(BL) DEF_EVENT(BR)
DEF_CHANNEL(ML) DEF_CHANNEL(MR)
DEF_CHANNEL(CL) DEF_CHANNEL(CR)
TIME_INTERVAL(0., 11.)
SAMPLES(12)
FUNCTION(move_right_leg)
FUNCTION(move_left_leg) // another
START_SIMULATION
BEGIN_ESM(CTRL)
CHANNEL(ML) CHANNEL(MR) CHANNEL(CL) CHANNEL(CR)
ACTION(CTRL, "L0", TRUE, CR="AR", "L2")
ACTION(CTRL, "L1", MATCH(ML, "SL"), CR="AR", "L2")
ACTION(CTRL, "L2", MATCH(MR, "SR"), CL="AL", "L1")
END_ESM
BEGIN_ESM(LEFT_LEG)
CHANNEL(ML) CHANNEL(CL)
EVENT(BL)
ACTION(LEFT_LEG, "SL", MATCH(CL, "AL"), move_left_leg(), "TL")
ACTION(LEFT_LEG, "TL", BL, ML="SL", "SL")
END_ESM
BEGIN_ESM(RIGHT_LEG)
CHANNEL(MR) CHANNEL(CR)
EVENT(BR)
ACTION(RIGHT_LEG, "SR", MATCH(CR, "AR"),
       move_right_leg(), "TR")
ACTION(RIGHT_LEG, "TR", BR, MR="SR", "SR")
END_ESM
END_SIMULATION
)";

std::string legs_with(const std::string& old, const std::string& now) {
    std::string text = kLegs;
    const std::size_t at = text.find(old);
    REQUIRE(at != std::string::npos);
    text.replace(at, old.size(), now);
    return text;
}

TEST_CASE("a script runs by itself, sampled: twelve instants from 0 to 11 s [unit]") {
    CHECK(codes_of(kLegs).empty());
    // By hand: a message is seen an instant later, a leg is an instant in the air.
    CHECK(actions_of(kLegs) ==
          std::vector<std::string>{
              "0 s CTRL.L0_to_L2", "1 s RIGHT_LEG.SR_to_TR", "2 s RIGHT_LEG.TR_to_SR",
              "3 s CTRL.L2_to_L1", "4 s LEFT_LEG.SL_to_TL", "5 s LEFT_LEG.TL_to_SL",
              "6 s CTRL.L1_to_L2", "7 s RIGHT_LEG.SR_to_TR", "8 s RIGHT_LEG.TR_to_SR",
              "9 s CTRL.L2_to_L1", "10 s LEFT_LEG.SL_to_TL", "11 s LEFT_LEG.TL_to_SL"});
    // The instants are exact, whatever their number.
    const auto thirds = actions_of(legs_with("SAMPLES(12)", "SAMPLES(34)"));
    CHECK(thirds[1] == "0.333333333 s RIGHT_LEG.SR_to_TR");
    CHECK(thirds.back() == "11 s CTRL.L2_to_L1");
}

TEST_CASE("actions that are TRUE come after those that wait for something [unit]") {
    // As printed: the leg reports at every instant, with its report first in the script.
    const std::string reports = legs_with(
        "ACTION(LEFT_LEG, \"SL\", MATCH",
        "ACTION(LEFT_LEG, \"SL\", TRUE, ML=LEFT_LEG, \"SL\")\nACTION(LEFT_LEG, \"SL\", MATCH");
    const auto log = actions_of(reports, 4.5);
    CHECK(std::count(log.begin(), log.end(), "4 s LEFT_LEG.SL_to_TL") == 1);
    CHECK(std::count(log.begin(), log.end(), "3 s LEFT_LEG.SL_to_SL") == 1);
    CHECK(std::count(log.begin(), log.end(), "4 s LEFT_LEG.SL_to_SL") == 0);
}

TEST_CASE(
    "events that no movement brings about come from outside, and are kept until seen [unit]") {
    scene::MemoryFiles files;
    files.add("light.tookima", R"(DEF_ESM(LIGHT, "off")
DEF_EVENT(BUTTON)
TIME_INTERVAL(0., 10.)
SAMPLES(6)
START_SIMULATION
BEGIN_ESM(LIGHT)
EVENT(BUTTON)
ACTION(LIGHT, "off", BUTTON, NO_TASK, "on")
ACTION(LIGHT, "on", TRUE, NO_TASK, "off")
END_ESM
END_SIMULATION
)");
    files.add("scene.pup",
              "language 1\nscene \"s\"\nuse \"light.tookima\" as l\nplace p takes 3 s "
              "tokens 1\nplace q\ngo: p -> q raises l.BUTTON\n");
    Checked<scene::Scene> loaded = scene::load(files, "scene.pup");
    if (!loaded) {
        FAIL(told(loaded.error()));
    }
    std::vector<std::string> changes;
    for (const std::string& line : log_of(*loaded, 20)) {
        if (line.find("LIGHT.o") != std::string::npos) {
            changes.push_back(line);
        }
    }
    CHECK(changes == std::vector<std::string>{"4 s l.LIGHT.off_to_on", "6 s l.LIGHT.on_to_off"});
}

// Without its turns; in a place `s`, or a machine's state `m.s`, that runs the script three times.
std::vector<std::string> log_of_runs(const scene::Scene& scene) {
    std::vector<std::string> out;
    for (const std::string& line : log_of(scene, 37)) {
        if (line.find(".sample") == line.npos && line.find(".waits") == line.npos) {
            out.push_back(line);
        }
    }
    return out;
}

TEST_CASE("a script is run by a place or by a state of a machine, again and again [unit]") {
    // Steps that take an instant, without a movement; checked by hand above with one.
    std::string steps = kLegs;
    for (const auto& [old, now] : {std::pair{"move_left_leg(), ", "NO_TASK, "},
                                   {"move_right_leg(), ", "NO_TASK, "},
                                   {"\"TL\", BL,", "\"TL\", TRUE,"},
                                   {"\"TR\", BR,", "\"TR\", TRUE,"}}) {
        const std::size_t at = steps.find(old);
        REQUIRE(at != std::string::npos);
        steps.replace(at, std::string(old).size(), now);
    }
    REQUIRE(actions_of(steps) == actions_of(kLegs));
    const std::vector<std::string> alone = actions_of(kLegs);
    for (const bool in_machine : {false, true}) {
        for (const bool moves : {false, true}) {
            CAPTURE(in_machine);
            CAPTURE(moves);
            const std::string runs =
                moves ? "runs script_once(LEFT_LEG: ana.left_leg, RIGHT_LEG: ana.right_leg)"
                      : "runs script_once()";
            scene::MemoryFiles files = file_of(moves ? kLegs : steps);
            files.add("scene.pup",
                      "language 1\nscene \"s\"\ncast { ana: mannequin }\n"
                      "import script_once from \"script.tookima\"\n" +
                          (in_machine
                               ? "use m\nmachine m {\n  state s starts " + runs +
                                     "\n  state t takes 1.5 s\n  go: s -> t\n  back: t -> s\n}\n"
                               : "place s " + runs +
                                     " tokens 1\nplace t takes 1.5 s\ngo: s -> t\nback: t -> s\n"));
            Checked<scene::Scene> loaded = scene::load(files, "scene.pup");
            if (!loaded) {
                FAIL(told(loaded.error()));
            }
            const std::string within = in_machine ? "m.s." : "s.";
            if (moves) {
                // Nobody performs movements here: its beginning is played.
                CHECK(log_of(*loaded, 0.5).front() == "0 s " + within + "script_starts");
                run::Player player(loaded->net);
                player.run({.until = {kTicksPerSecond / 2}});
                for (const char* place : {"CTRL.L2", "LEFT_LEG.SL", "RIGHT_LEG.SR", "rest"}) {
                    CHECK(player.tokens(loaded->net.find_place(within + place)) == 1);
                }
                CHECK(player.tokens(loaded->net.find_place(within + "instants")) == 11);
                continue;
            }
            std::vector<std::string> wanted;
            for (int round = 0; round < 3; ++round) {
                const auto add = [&](double after, const std::string& what) {
                    char time[40];
                    std::snprintf(time, sizeof time, "%.9g s ", 12.5 * round + after);
                    wanted.push_back(time + what);
                };
                if (round > 0) {
                    add(0, in_machine ? "m.back" : "back");
                }
                add(0, within + "script_starts");
                for (const std::string& line : alone) {
                    add(std::strtod(line.c_str(), nullptr),
                        within + line.substr(line.find(" s ") + 3));
                }
                add(11, within + "script_ends");
                add(11, in_machine ? "m.go" : "go");
            }
            CHECK(log_of_runs(*loaded) == wanted);
            // What was said last is not heard when it begins again, and no token is left.
            run::Player player(loaded->net);
            player.run({.until = {12 * kTicksPerSecond}});
            const auto said = loaded->net.find_datum(within + "ML said");
            CHECK(player.datum(said) != 0);
            for (std::uint32_t p = 0; p < loaded->net.place_count(); ++p) {
                const net::PlaceIndex place{p};
                if (loaded->net.place(place).path.substr(0, within.size()) == within) {
                    CHECK(player.tokens(place) == 0);
                }
            }
            player.run({.until = {13 * kTicksPerSecond}});
            CHECK(player.datum(said) == 0);
        }
    }
}

TEST_CASE("what happens while nobody runs a script is not heard by it [unit]") {
    scene::MemoryFiles files;
    files.add("light.tookima", R"(DEF_ESM(LIGHT, "off")
DEF_EVENT(BUTTON)
TIME_INTERVAL(0., 4.)
SAMPLES(3)
START_SIMULATION
BEGIN_ESM(LIGHT)
EVENT(BUTTON)
ACTION(LIGHT, "off", BUTTON, NO_TASK, "on")
END_ESM
END_SIMULATION
)");
    files.add("scene.pup",
              "language 1\nscene \"s\"\nimport light_once from \"light.tookima\"\n"
              "place l runs light_once() tokens 1\nplace q takes 2 s\ngo: l -> q\nback: q -> l\n"
              "event push at 1 s, 5 s, 11 s\npushes: -> on push raises l.BUTTON\n");
    Checked<scene::Scene> loaded = scene::load(files, "scene.pup");
    if (!loaded) {
        FAIL(told(loaded.error()));
    }
    std::vector<std::string> changes;
    for (const std::string& line : log_of(*loaded, 16)) {
        if (line.find("LIGHT.o") != std::string::npos || line.find("script_") != line.npos) {
            changes.push_back(line);
        }
    }
    // Off again when it begins; pushed at 1 s, in vain at 11 s, when it has ended, and at 5 s.
    CHECK(changes == std::vector<std::string>{"0 s l.script_starts", "2 s l.LIGHT.off_to_on",
                                              "4 s l.script_ends", "6 s l.script_starts",
                                              "10 s l.script_ends", "12 s l.script_starts",
                                              "16 s l.script_ends"});
}

TEST_CASE("slips of printed scripts are told with line and remedy, and the rest loads [unit]") {
    const auto log = actions_of(kLegs);
    const auto loads = [&](const std::string& text) { return actions_of(text) == log; };
    // A channel listed under another name than it is used by, as in the paper's right leg.
    const std::string other =
        legs_with("CHANNEL(MR) CHANNEL(CR)\nEVENT(BR)", "CHANNEL(CH1R) CHANNEL(CH2R)\nEVENT(BR)");
    CHECK(codes_of(other) == Codes{{25, "other-name"}, {25, "other-name"}});
    CHECK(loads(other));
    const std::string unlisted = legs_with("CHANNEL(MR) CHANNEL(CR)\nEVENT(BR)", "EVENT(BR)");
    CHECK(codes_of(unlisted).size() == 2);
    CHECK(loads(unlisted));
    const std::string undeclared = legs_with("DEF_CHANNEL(ML) ", "");
    CHECK(codes_of(undeclared) == Codes{{15, "undeclared"}});
    CHECK(loads(undeclared));
    CHECK(codes_of(legs_with("FUNCTION(move_right_leg)", "FUNCTION(move_rigth_leg)")) ==
          Codes{{28, "undeclared"}});
    CHECK(loads(legs_with("DEF_EVENT(BL)", "")));
    // Words that printing took apart, quotes and ends that it lost.
    CHECK(codes_of(legs_with("DEF_EVENT(BL)", "DEF EVENT(BL)")) == Codes{{4, "written-apart"}});
    CHECK(codes_of(legs_with("END_ESM\nEND_SIM", "END ESM\nEND_SIM")) ==
          Codes{{30, "written-apart"}});
    CHECK(loads(legs_with("END_SIMULATION\n", "")));
    CHECK(codes_of(legs_with("CL=\"AL\"", "CL=AL")) == Codes{{16, "quotes-missing"}});
    CHECK(loads(legs_with("CL=\"AL\"", "CL=AL")));
    CHECK(codes_of(legs_with("ACTION(CTRL, \"L1\"", "ACTION(CONTROL, \"L1\"")) ==
          Codes{{15, "other-machine"}});
    CHECK(loads(legs_with("ACTION(CTRL, \"L1\"", "ACTION(CONTROL, \"L1\"")));
}

TEST_CASE("what cannot be meant is an error [unit]") {
    const auto tells = [](const std::string& old, const std::string& now, std::uint32_t line,
                          const std::string& code) {
        const Codes codes = codes_of(legs_with(old, now));
        return std::find(codes.begin(), codes.end(), Codes::value_type{line, code}) != codes.end();
    };
    CHECK(tells("DEF_ESM(CTRL, \"L0\")", "", 12, "unknown-name"));
    CHECK(tells("SAMPLES(12)", "SAMPLES(1)", 8, "wrong-samples"));
    CHECK(tells("SAMPLES(12)", "SAMPLES(1.5)", 8, "wrong-samples"));
    CHECK(tells("SAMPLES(12)", "SAMPLES(99999999)", 8, "wrong-samples"));
    CHECK(tells("0., 11.", "11., 0.", 7, "wrong-interval"));
    CHECK(tells("MATCH(CL, \"AL\")", "MATCH(CL \"AL\")", 21, "syntax"));
    CHECK(tells("move_left_leg(), ", "move_left_leg, ", 21, "syntax"));
    CHECK(tells("move_left_leg(), ", "move_left_leg(3), ", 21, "too-many-arguments"));
    CHECK(tells("START_SIMULATION", "STRAT_SIMULATION", 11, "unknown-keyword"));
    CHECK(tells("/* a comment */", "/* a comment", 1, "unterminated-text"));
    CHECK(tells("ML=\"SL\", \"SL\")", "CR=\"SL\", \"SL\")", 22, "two-senders"));
    CHECK(tells("MATCH(CR, \"AR\")", "MATCH(CL, \"AR\")", 27, "two-receivers"));
    CHECK(tells("MATCH(CL, \"AL\")", "MATCH(ML, \"AL\")", 21, "two-receivers"));
    CHECK(tells("MATCH(CL, \"AL\")", "MATCH(ML, \"AL\")", 21, "channel-within"));
    CHECK(tells("ML=\"SL\", \"SL\")", "ML=RIGHT_LEG, \"SL\")", 22, "other-state"));
    // What happens never, and what nobody looks at.
    CHECK(tells("MATCH(CL, \"AL\")", "MATCH(CL, \"AX\")", 21, "rendezvous-never"));
    CHECK(tells("\"TL\", BL", "\"TX\", BL", 22, "never-entered"));
    CHECK(tells("ML=\"SL\", \"SL\")", "NO_TASK, \"SL\")", 15, "unmatched-channel-end"));
}

TEST_CASE("no truncation and no corruption of a script does any harm [hostile]") {
    const std::string text = kLegs;
    const auto harmless = [](const std::string& script) {
        scene::MemoryFiles files = file_of(script);
        for (const Diagnostic& d : scene::check(files, "script.tookima")) {
            REQUIRE_FALSE(d.code.empty());
            REQUIRE_FALSE(d.message.empty());
        }
    };
    const bool everything = std::getenv("PUPPETRI_LONG") != nullptr;
    for (std::size_t n = 0; n < text.size(); n += everything ? 1 : 5) {
        harmless(text.substr(0, n));
    }
    std::mt19937 random(3);
    const std::string bytes =
        "\"(),=;/*\\\n \0\xff\xc3_A0.-"
        "E";
    for (int k = 0; k < (everything ? 20'000 : 400); ++k) {
        std::string broken = text;
        for (int edits = 1 + static_cast<int>(random() % 3); edits > 0; --edits) {
            const std::size_t at = random() % broken.size();
            switch (random() % 3) {
                case 0:
                    broken[at] = bytes[random() % bytes.size()];
                    break;
                case 1:
                    broken.erase(at, 1 + random() % 12);
                    break;
                default:
                    broken.insert(at, broken.substr(random() % broken.size(), 1 + random() % 20));
            }
        }
        harmless(broken);
    }
    harmless(std::string(100'000, '('));
    harmless("DEF_ESM" + std::string(50'000, '"'));
}

// ---- against a direct sampler

struct Action {
    int from, to;
    int when;  // 0: TRUE, 1: MATCH(the channel that comes in), 2: the event
    int wanted;
    int task;  // 0: nothing, 1: a message, 2: the present state, 3: the call
    int sent;
};

TEST_CASE("random scripts do what a direct sampler says [oracle]") {
    std::mt19937 random(23);
    const auto below = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
    int calls = 0, events = 0, matches = 0;
    for (int round = 0; round < 60; ++round) {
        // Machine k hears channel k and sends on channel k + 1, in a ring.
        const int count = 2 + below(2), samples = 14;
        std::vector<std::vector<Action>> machines(static_cast<std::size_t>(count));
        std::string text;
        for (int k = 0; k < count; ++k) {
            text += "DEF_ESM(M" + std::to_string(k) + ", \"q0\") DEF_CHANNEL(C" +
                    std::to_string(k) + ") DEF_EVENT(E" + std::to_string(k) + ") FUNCTION(f" +
                    std::to_string(k) + ")\n";
        }
        text +=
            "TIME_INTERVAL(0., 26.) SAMPLES(" + std::to_string(samples) + ")\nSTART_SIMULATION\n";
        for (int k = 0; k < count; ++k) {
            const std::string me = std::to_string(k), to = std::to_string((k + 1) % count);
            text += "BEGIN_ESM(M" + me + ")\nCHANNEL(C" + me + ") CHANNEL(C" + to + ") EVENT(E" +
                    me + ")\n";
            auto& actions = machines[static_cast<std::size_t>(k)];
            for (int a = 0; a < 6; ++a) {
                actions.push_back({below(3), below(3), below(3), below(3), below(4), below(3)});
            }
            // State q3 begins with the movement, and its event is the movement's end.
            actions.push_back({below(3), 3, below(2), below(3), 3, 0});
            actions.push_back({3, below(3), 2, 0, below(3), below(3)});
            for (Action& x : actions) {
                if (x.when == 2 && x.from != 3) {
                    x.when = 1;
                }
                if (x.task == 3 && x.to != 3) {
                    x.task = 0;
                }
                text += "ACTION(M" + me + ", \"q" + std::to_string(x.from) + "\", " +
                        (x.when == 0   ? "TRUE"
                         : x.when == 1 ? "MATCH(C" + me + ", \"q" + std::to_string(x.wanted) + "\")"
                                       : "E" + me) +
                        ", " +
                        (x.task == 0   ? "NO_TASK"
                         : x.task == 1 ? "C" + to + "=\"q" + std::to_string(x.sent) + "\""
                         : x.task == 2 ? "C" + to + "=M" + me
                                       : "f" + me + "()") +
                        ", \"q" + std::to_string(x.to) + "\")\n";
            }
            text += "END_ESM\n";
        }
        text += "END_SIMULATION\n";
        // The sampler. The call lasts from one instant to the next.
        std::vector<int> state(static_cast<std::size_t>(count), 0);
        std::vector<std::optional<int>> heard(static_cast<std::size_t>(count)), said = heard,
                                                                                begun = heard;
        std::vector<std::string> wanted;
        for (int i = 0; i < samples; ++i) {
            heard = said;
            said.assign(static_cast<std::size_t>(count), std::nullopt);
            for (int k = 0; k < count; ++k) {
                const auto me = static_cast<std::size_t>(k);
                const auto& actions = machines[me];
                const Action* chosen = nullptr;
                for (const bool always : {false, true}) {
                    for (const Action& x : actions) {
                        const bool holds = x.when == 0 || (x.when == 1 && heard[me] == x.wanted) ||
                                           (x.when == 2 && begun[me] && *begun[me] < i);
                        const bool moving = begun[me] && *begun[me] == i;
                        if (chosen == nullptr && (x.when == 0) == always && x.from == state[me] &&
                            holds && !(x.task == 3 && moving)) {
                            chosen = &x;
                        }
                    }
                }
                if (chosen == nullptr) {
                    continue;
                }
                const std::string base = "M" + std::to_string(k) + ".q" +
                                         std::to_string(chosen->from) + "_to_q" +
                                         std::to_string(chosen->to);
                // The second action between two states is `_2`; conditions go first.
                int same = 0;
                for (const bool always : {false, true}) {
                    for (const Action& x : actions) {
                        if ((x.when == 0) == always && &x <= chosen && x.from == chosen->from &&
                            x.to == chosen->to && (x.when == 0) == (chosen->when == 0)) {
                            ++same;
                        } else if ((x.when == 0) == always && chosen->when == 0 && x.when != 0 &&
                                   x.from == chosen->from && x.to == chosen->to) {
                            ++same;
                        }
                    }
                }
                wanted.push_back(std::to_string(2 * i) + " s " + base +
                                 (same > 1 ? "_" + std::to_string(same) : ""));
                matches += chosen->when == 1 ? 1 : 0;
                if (chosen->when == 2) {
                    begun[me].reset();
                    ++events;
                }
                const auto next = static_cast<std::size_t>((k + 1) % count);
                if (chosen->task == 1) {
                    said[next] = chosen->sent;
                } else if (chosen->task == 2) {
                    said[next] = chosen->from;
                } else if (chosen->task == 3) {
                    begun[me] = i;
                    ++calls;
                }
                state[me] = chosen->to;
            }
        }
        REQUIRE(actions_of(text, 100) == wanted);
    }
    CHECK(calls > 50);  // the test is about these
    CHECK(events > 30);
    CHECK(matches > 50);
}

}  // namespace
}  // namespace puppetri::notation
