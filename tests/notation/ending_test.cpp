// SPDX-License-Identifier: MIT
// Blocks that would go on for ever, with a line that ends them: what they do in a place, and in a
// state of a machine, is what the same block does by itself up to then, each time anew.
#include <algorithm>
#include <cstdlib>

#include "playing.h"

namespace puppetri::notation {
namespace {

struct Ended {
    std::string kind;    // of the block, which is called net
    std::string lines;   // of the block
    std::string ends;    // the line more
    std::string before;  // what else the scene has
    std::string last;    // the last firing, by itself: "3 s alone.step"
};

std::string told_of(const std::vector<std::string>& lines) {
    std::string text;
    for (const std::string& line : lines) {
        text += "\n" + line;
    }
    return text;
}

double seconds_of(const std::string& line) { return std::strtod(line.c_str(), nullptr); }

std::string moved(const std::string& line, double by, const std::string& to) {
    char time[40];
    std::snprintf(time, sizeof time, "%.9g s ", seconds_of(line) + by);
    const std::string prefix = "alone.";
    return time + to + line.substr(line.find(prefix) + prefix.size());
}

// Its firings in the net by itself, up to the last one.
std::vector<std::string> by_itself(const Ended& e) {
    std::vector<std::string> out;
    for (const std::string& line :
         log_of(e.before + "use net as alone\n" + e.kind + " net {\n" + e.lines + "}\n", 60)) {
        if (line.find(" alone.") != line.npos) {
            out.push_back(line);
        }
        if (line == e.last) {
            return out;
        }
    }
    FAIL("no " << e.last << told_of(out));
    return out;
}

void check(const Ended& e) {
    CAPTURE(e.lines);
    const std::vector<std::string> alone = by_itself(e);
    const double lasts = seconds_of(e.last);
    const std::string block = e.kind + " net {\n" + e.lines + e.ends + "\n}\n";
    for (const bool in_machine : {false, true}) {
        const std::string within = in_machine ? "m.s." : "p.";
        const std::string around =
            in_machine ? "use m\nmachine m {\n  state s starts runs net()\n  state t takes 1.5 s\n"
                         "  go: s -> t\n  back: t -> s\n}\n"
                       : "place p runs net() tokens 1\nplace q takes 1.5 s\ngo: p -> q\n"
                         "back: q -> p\n";
        const scene::Scene scene = from_text(e.before + around + block);
        std::vector<std::string> got, ways, wanted, wanted_ways;
        const double until = 3 * lasts + 3.2;
        for (const std::string& line : log_of(scene, until)) {
            const bool inner = line.find(" " + within) != line.npos;
            const bool way = line.find(within + e.kind + "_starts") != line.npos ||
                             line.find(within + e.kind + "_ends") != line.npos;
            const std::string name = line.substr(line.find(" s ") + 3);
            if (way || name == (in_machine ? "m.go" : "go")) {
                ways.push_back(line);
            } else if (inner && line.find("fault") == line.npos) {
                got.push_back(line);
            } else if (line.find("fault") != line.npos) {
                FAIL(line);
            }
        }
        for (int round = 0; round < 3; ++round) {
            const double at = round * (lasts + 1.5);
            for (const std::string& line : alone) {
                wanted.push_back(moved(line, at, within));
            }
            wanted_ways.push_back(moved("0 s alone." + e.kind + "_starts", at, within));
            wanted_ways.push_back(moved("0 s alone." + e.kind + "_ends", at + lasts, within));
            wanted_ways.push_back(moved("0 s alone.go", at + lasts, in_machine ? "m." : ""));
        }
        CHECK(told_of(got) == told_of(wanted));
        CHECK(told_of(ways) == told_of(wanted_ways));
        // Nothing is left in it: it has as many tokens as after its first end.
        run::Player player(scene.net);
        const auto tokens_at = [&](double seconds) {
            player.run({.until = {static_cast<std::int64_t>(
                            seconds * static_cast<double>(kTicksPerSecond))}});
            std::uint64_t sum = 0;
            for (std::uint32_t p = 0; p < scene.net.place_count(); ++p) {
                if (scene.net.place(net::PlaceIndex{p}).path.substr(0, within.size()) == within) {
                    sum += player.tokens(net::PlaceIndex{p});
                }
            }
            return sum;
        };
        CHECK(tokens_at(lasts / 2) > 0);
        CHECK(tokens_at(lasts + 1) == 0);
        CHECK(tokens_at(2 * lasts + 2.5) == 0);
    }
}

TEST_CASE("cells end after so many generations, and begin anew as they were [oracle]") {
    const std::string cast = "cast { ana: mannequin, rui: mannequin { at (2, 0, 0) m } }\n";
    check({"cells",
           "  ring 5\n  every 0.5 s\n  off\n  on\n  wolfram 30\n  starts on at 2\n",
           "  ends after 4 generations",
           {},
           "2 s alone.step"});
    check({"cells",
           "  row 2\n  every 1 s\n  figures [ana, rui]\n  calm\n  waving does me.wave() takes 1 s\n"
           "  calm -> waving when left = waving or right = waving\n  waving -> calm\n"
           "  starts waving at 1\n",
           "  ends after 3 generations", cast, "3 s alone.waving_to_calm[1]"});
}

TEST_CASE("a pulse process ends after so many steps, and begins anew as it was [oracle]") {
    check({"pulses",
           "  every 0.5 s\n  a starts 3 pulse 1 whole -100 .. 100\n  b whole -100 .. 100\n"
           "  a -> b: 2\n  b gets 5 at 0.75 s\n",
           "  ends after 3 steps",
           {},
           "1.5 s alone.step"});
    // Values begin anew, and stay when it has ended; pulses from outside are not heard then.
    const scene::Scene scene = from_text(R"(event kick at 1.2 s, 3.8 s, 5.2 s
place p runs net(kick, 3) tokens 1
place q takes 1 s
go: p -> q
back: q -> p
pulses net(kick: event, n: int) {
  ends after n steps
  every 1 s
  a starts 3 pulse 1 whole -100 .. 100
  a -> a: 1
  a gets 4 on kick
}
)");
    run::Player player(scene.net);
    const auto a_at = [&](double seconds) {
        player.run(
            {.until = {static_cast<std::int64_t>(seconds * static_cast<double>(kTicksPerSecond))}});
        return player.datum(scene.net.find_datum("p.a"));
    };
    CHECK(a_at(0.5) == 4);
    CHECK(a_at(1.5) == 5);
    CHECK(a_at(2.5) == 10);
    CHECK(a_at(3.5) == 15);  // ended at 3 s
    CHECK(a_at(3.9) == 15);
    CHECK(a_at(4.5) == 4);  // begun anew at 4 s
    CHECK(a_at(5.1) == 5);
    CHECK(a_at(6.5) == 10);
    CHECK(a_at(7.5) == 15);
}

TEST_CASE("a circuit ends when a signal is high, and begins anew as it was [oracle]") {
    check({"logic",
           "  input a toggles at [0.5, 0.8, 2] s\n  clock c period 0.75 s high 0.25 s\n"
           "  x = a and c delay 100 ms\n  late = x delay 300 ms transport\n  both = late and a\n"
           "  y = not both starts yes\n",
           "  ends when both",
           {},
           "2.4 s alone.y_falls"});
    // A formula; true at once.
    const std::vector<std::string> log = log_of(
        "use net as x\nlogic net {\n  a = b delay 1 s\n  input b starts yes\n"
        "  ends when nor(a, not b)\n}\n",
        5);
    CHECK(log == std::vector<std::string>{"0 s x.logic_starts", "0 s x.logic_ends"});
}

TEST_CASE("messages end when a node has handled one, and begin anew [oracle]") {
    const std::string lines =
        "  message hi\n  message re\n  node a takes 0.5 s\n  node b takes 0.25 s\n"
        "  node c takes 1 s\n  link a b takes 0.5 s\n  link b c takes 0.25 s one at a time\n"
        "  a sends hi to c\n  c sends re to b every 2 s from 0.5 s\n  b sends hi to a at [1, 1.1] "
        "s\n"
        "  c answers hi with re\n";
    check({"messages", lines, "  ends when c has handled hi", {}, "2 s alone.c_answers_hi"});
    // The answer comes back at 3.5 s; the other messages that a handles end nothing.
    const std::string block =
        "messages net {\n" + lines + "  ends when a has handled re\n}\nuse net as x\n";
    const std::vector<std::string> log = log_of(block, 60);
    REQUIRE(log.size() > 2);
    CHECK(log[log.size() - 2] == "3.5 s x.a_gets_re");
    CHECK(log.back() == "3.5 s x.messages_ends");
    CHECK(std::count(log.begin(), log.end(), "2 s x.a_gets") == 1);
    CHECK(std::count(log.begin(), log.end(), "2.5 s x.a_gets") == 1);
}

TEST_CASE("a queue ends after so many customers have left, and begins anew [oracle]") {
    check({"queue",
           "  data served: 0 .. 99 = 0\n  source door every 1 s closes 3.5 s\n"
           "  station desk serves 1.25 s room 2 lost customers 1\n  sink street\n"
           "  door -> desk\n  desk -> street { served := served + 1 }\n",
           "  ends after 3 customers",
           {},
           "3.75 s alone.desk_to_street"});
    check({"queue",
           "  source door {\n    at 0 s every 1 s\n    at 2.5 s closed\n"
           "    at 4 s every 0.5 s\n  }\n"
           "  delay bench takes 0.25 s\n  sink street\n  door -> bench\n  bench -> street\n",
           "  ends after 4 customers",
           {},
           "5.25 s alone.bench_to_street"});
    check({"queue",
           "  customer Client(rank: 0 .. 2 = 1)\n  source door every 0.7 s first 0.2 s\n"
           "  station desk servers 1 serves 1.1 s order most rank preempts "
           "customers 2 (rank = 2)\n"
           "  station pay serves 0.3 s breaks every 2 s first 0.5 s for 0.55 s\n"
           "  sink street\n  inside shop\n  door -> desk\n  desk -> pay takes 0.15 s\n"
           "  pay -> street\n",
           "  ends after 3 customers",
           {},
           "3.75 s alone.pay_to_street"});
    // More than enough at once.
    const std::vector<std::string> log = log_of(
        "use net as x\nqueue net {\n  source door every 1 s batch 3\n  sink street\n"
        "  door -> street\n  ends after 4 customers\n}\n",
        9);
    CHECK(log == std::vector<std::string>{"0 s x.queue_starts", "1 s x.door_to_street",
                                          "2 s x.door_to_street", "2 s x.queue_ends"});
}

TEST_CASE("wrong lines about the end are told where they stand [unit]") {
    const auto codes = [](const std::string& block) {
        std::vector<std::pair<std::uint32_t, std::string>> out;
        for (const Diagnostic& d : defects_of("use net as x\n" + block)) {
            out.emplace_back(d.where.line, d.code);
            CHECK_FALSE(d.remedy.empty());
        }
        return out;
    };
    using Codes = std::vector<std::pair<std::uint32_t, std::string>>;
    const std::string pulses = "pulses net {\n  every 1 s\n  a pulse 1\n  a -> a: 0.5\n";
    CHECK(codes(pulses + "  ends after 2 steps\n  ends after 3 steps\n}\n") ==
          Codes{{9, "name-twice"}});
    CHECK(codes(pulses + "  ends after 0 steps\n}\n") == Codes{{8, "out-of-range"}});
    CHECK(codes(pulses + "  ends after 2\n}\n") == Codes{{8, "syntax"}});
    CHECK(codes(pulses + "  ends\n}\n") == Codes{{8, "syntax"}});
    CHECK(codes(pulses + "  ends after 1 step\n}\n").empty());
    const Diagnostics endless = defects_of("place p runs net() tokens 1\n" + pulses + "}\n");
    REQUIRE(endless.size() == 1);
    CHECK(endless[0].code == "no-finish");
    CHECK(endless[0].where.line == 3);
    const std::string logic = "logic net {\n  input a\n  b = not a delay 1 s\n";
    CHECK(codes(logic + "  ends when c\n}\n") == Codes{{7, "unknown-name"}});
    CHECK(codes(logic + "  ends when a\n  ends when b\n}\n") == Codes{{8, "name-twice"}});
    CHECK(codes(logic + "  ends after 3 steps\n}\n") == Codes{{7, "syntax"}});
    const std::string messages =
        "messages net {\n  message hi\n  node a takes 1 s\n  node b takes 1 s\n"
        "  link a b takes 1 s\n  a sends hi to b\n";
    CHECK(codes(messages + "  ends when c has handled hi\n}\n") == Codes{{10, "unknown-name"}});
    CHECK(codes(messages + "  ends when b has handled ho\n}\n") == Codes{{10, "unknown-name"}});
    CHECK(codes(messages + "  ends when b handles hi\n}\n") == Codes{{10, "syntax"}});
    CHECK(codes("enum Colour { red, green }\nqueue net {\n  data c: Colour\n"
                "  source door every 1 s\n  sink street\n  door -> street { c := green }\n"
                "  ends after 3 customers\n}\n") == Codes{{6, "no-value"}});
}

}  // namespace
}  // namespace puppetri::notation
