// SPDX-License-Identifier: MIT
// Extended state machines: each sentence of their semantics, against nets written by hand and
// against a direct interpreter of the machines.
#include <algorithm>
#include <map>
#include <random>
#include <set>

#include "playing.h"
#include "puppetri/notation/notation.h"

namespace puppetri::notation {
namespace {

using Codes = std::vector<std::pair<std::uint32_t, std::string>>;

Codes codes_of(const std::string& body) {
    Codes out;
    for (const Diagnostic& d : defects_of(body)) {
        out.emplace_back(d.where.line, d.code);
        CHECK_FALSE(d.remedy.empty());
        CHECK_FALSE(d.element.empty());
    }
    return out;
}

constexpr const char* kTwo = R"(enum Command { lift, stop }
channel orders of Command
use worker(orders) as w
use boss(orders) as b
machine worker(orders: channel) {
  data done: 0 .. 9
  state idle starts
  state busy takes 2 s
  obey: idle -> busy receive orders?lift set done := done + 1
  ends: busy -> idle
}
machine boss(orders: channel) {
  state here starts
  state there takes 3 s
  lift: here -> there send orders!lift
  back: there -> here
}
)";

TEST_CASE("a send and its receive are one transition of the net [unit]") {
    CHECK(log_of(kTwo, 4) == std::vector<std::string>{"0 s b.lift|w.obey", "2 s w.ends",
                                                      "3 s b.back", "3 s b.lift|w.obey"});
}

TEST_CASE("machines are the net that somebody would write for them [law]") {
    const std::string net = R"(data 'w.done': 0 .. 9
place 'w.idle' tokens 1
place 'w.busy' takes 2 s
place 'b.here' tokens 1
place 'b.there' takes 3 s
'b.lift|w.obey': 'b.here' + 'w.idle' -> 'b.there' + 'w.busy' set 'w.done' := 'w.done' + 1
'w.ends': 'w.busy' -> 'w.idle'
'b.back': 'b.there' -> 'b.here'
)";
    CHECK(log_of(kTwo, 100) == log_of(net, 100));
}

TEST_CASE("a message goes into a variable, and several variables are set at once [unit]") {
    const scene::Scene scene = from_text(R"(channel c of 0 .. 9
use a(c)
use b(c)
machine a(c: channel) {
  data x: 0 .. 9 = 1
  data y: 0 .. 9 = 2
  state s starts
  state t takes 1 s
  state u final
  swap: s -> t set x := y, y := x
  tell: t -> u send c!10*x div 4 set x := 0
}
machine b(c: channel) {
  data got: 0 .. 9
  data twice: 0 .. 18
  state s starts
  state t
  state u final
  hear:  s -> t receive c?got
  think: t -> u set twice := 2*got
}
)");
    run::Player player(scene.net, {});
    player.run({.until = {5 * kTicksPerSecond}});
    const auto value = [&](const char* path) { return player.datum(scene.net.find_datum(path)); };
    CHECK(value("a.y") == 1);
    CHECK(value("b.got") == 5);  // of the sender, before its own assignments: x = 2
    CHECK(value("a.x") == 0);
    CHECK(value("b.twice") == 10);
    CHECK(player.tokens(scene.net.find_place("b.u")) == 1);
}

TEST_CASE("who stays in a state does not begin it anew [unit]") {
    // Asked every second, the worker goes on working, and is done after 3.5 s; `again` begins anew.
    const std::string asked = R"(channel c
use worker(c)
use asker(c)
machine worker(c: channel) {
  state works takes 3.5 s starts
  state done final
  tell: works -> works send c
  ends: works -> done
}
machine asker(c: channel) {
  state s starts
  ask: s -> s receive c poll every 1 s
}
)";
    CHECK(log_of(asked, 10) ==
          std::vector<std::string>{"1 s worker.tell|asker.ask", "2 s worker.tell|asker.ask",
                                   "3 s worker.tell|asker.ask", "3.5 s worker.ends"});
    std::string anew = asked;
    anew.replace(anew.find("tell: works"), 11, "tell: now works");
    const auto log = log_of(anew, 5.2);
    CHECK(std::count(log.begin(), log.end(), "3.5 s worker.ends") == 0);
    CHECK(log.size() == 5);
}

TEST_CASE("a poll looks at its instants only, after everything else of the instant [unit]") {
    // At 2 s `ready` comes first, and the poll of 2 s sees it.
    CHECK(log_of(R"(use m
machine m {
  data ready: bool
  state waits starts
  state rests final
  look: waits -> rests when ready poll every 0.5 s
}
place p takes 1.9 s tokens 1
go: p -> 'p 2' set m.ready := yes
place 'p 2'
)",
                 5) == std::vector<std::string>{"1.9 s go", "2 s m.look"});
}

TEST_CASE("what two machines say to each other can be more than one thing [unit]") {
    // The teller chooses; the receiver has one action for each and one for the rest.
    const scene::Scene scene = from_text(R"(enum Word { yes_, no_, maybe }
channel c of Word
use a(c)
use b(c)
machine a(c: channel) {
  state s starts
  state t final
  say_yes:   s -> t send c!yes_
  say_maybe: s -> t send c!maybe
}
machine b(c: channel) {
  state s starts
  state t final
  on_yes: s -> t receive c?yes_
  on_any: s -> t receive c
}
)");
    std::set<std::string> paths;
    for (std::uint32_t t = 0; t < scene.net.transition_count(); ++t) {
        paths.insert(std::string(scene.net.transition({t}).path));
    }
    CHECK(paths == std::set<std::string>{"a.say_yes|b.on_yes", "a.say_yes|b.on_any",
                                         "a.say_maybe|b.on_any"});
}

TEST_CASE("a state runs a machine, from its first state to a final one [unit]") {
    CHECK(log_of(R"(use outer as o
machine outer {
  state begins takes 1 s starts
  state works runs inner(2 s)
  state ends final
  a: begins -> works
  b: works -> ends
}
machine inner(d: time) {
  state one takes d starts
  state two takes 1 s final
  on: one -> two
}
)",
                 20) == std::vector<std::string>{"1 s o.a", "3 s o.works.on", "4 s o.b"});
}

TEST_CASE("what a place cannot run of machines is told [unit]") {
    const auto codes = [](const std::string& one, const std::string& two) {
        return codes_of(
            "place p runs m tokens 1\nplace q\nt: p -> q\nmachine m {\n"
            "  state a takes 1 s starts " +
            one + "\n  state b " + two + "\n  state c final\n  t: a -> b\n  u: a -> c\n}\n");
    };
    CHECK(codes("", "").empty());
    CHECK(codes("", "final").front() == std::pair<std::uint32_t, std::string>{3, "many-finals"});
    CHECK(
        codes_of("place p runs m tokens 1\nplace q\nt: p -> q\nmachine m {\n  state a starts\n}\n")
            .front() == std::pair<std::uint32_t, std::string>{3, "no-finish"});
}

TEST_CASE("machines rest when all that can have ended have [unit]") {
    const std::string text = R"(use m(1 s) as a
use m(2 s) as b
machine m(d: time) {
  state s takes d starts
  state t final
  go: s -> t
}
)";
    const scene::Scene scene = from_text(text);
    REQUIRE(scene.net.declarations().finals.size() == 1);
    CHECK(scene.net.declarations().finals[0].condition.nodes.back().op == net::FormulaOp::kAnd);
}

TEST_CASE("a name of a message means the message, also where a state is called so [unit]") {
    CHECK(log_of(R"(enum Phase { support, transfer }
channel says of Phase
use leg(says)
use other(says)
machine leg(says: channel) {
  state support takes 1 s starts
  state transfer final
  go: support -> transfer send says!transfer
}
machine other(says: channel) {
  data support_: Phase
  data seen: Phase
  state transfer starts
  state support final
  hear: transfer -> support receive says?transfer
}
)",
                 5) == std::vector<std::string>{"1 s leg.go|other.hear"});
}

TEST_CASE("nets speak on channels as machines do [unit]") {
    CHECK(log_of(R"(channel c
use giver(c)
place p takes 1 s tokens 1
place q
take: p -> q receive c
net giver(c: channel) {
  place p takes 2 s tokens 1
  give: p -> send c
}
)",
                 5) == std::vector<std::string>{"2 s giver.give|take"});
}

// ---- bad input

// Two machines that are fine, in which one line is replaced. Line numbers count from "language 1".
std::string pair_with(const std::string& old, const std::string& now) {
    std::string text = R"(enum Word { hi, bye }
channel c of Word
channel d
use a(c, d)
use b(c, d)
machine a(c: channel, d: channel) {
  state s takes 1 s starts
  state t takes 1 s
  one: s -> t send c!hi
  two: t -> s receive d
}
machine b(c: channel, d: channel) {
  data w: Word
  state s takes 1 s starts
  state t takes 1 s
  one: s -> t receive c?w
  two: t -> s send d
}
)";
    const std::size_t at = text.find(old);
    REQUIRE(at != std::string::npos);
    text.replace(at, old.size(), now);
    return text;
}

TEST_CASE("bad input of machines is told where it stands, with a remedy [unit]") {
    CHECK(codes_of(pair_with("two: t", "two: t")).empty());
    // An unmatched end.
    CHECK(codes_of(pair_with(" receive d\n", "\n")) == Codes{{19, "unmatched-channel-end"}});
    CHECK(codes_of(pair_with(" send d\n", "\n")) == Codes{{12, "unmatched-channel-end"}});
    // Two senders, two receivers.
    CHECK(codes_of(pair_with("use b(c, d)\n", "use b(c, d)\nuse a(c, d) as a2\n")) ==
          Codes{{12, "two-senders"}, {13, "two-receivers"}});
    // No channel inside of a machine.

    CHECK(codes_of(R"(channel c
use a(c)
machine a(c: channel) {
  state s takes 1 s starts
  tell: s -> s send c
  hear: s -> s receive c
}
)") == Codes{{8, "channel-within"}});
    // A rendezvous that can never happen.
    CHECK(codes_of(pair_with("receive c?w", "receive c?bye")) ==
          Codes{{11, "rendezvous-never"}, {18, "rendezvous-never"}});
    // A state that is never entered.
    CHECK(codes_of(pair_with("  one: s -> t send", "  state u\n  one: s -> t send")) ==
          Codes{{11, "never-entered"}});
    // A poll in no time.
    CHECK(codes_of(pair_with("send d\n", "send d poll every 0 s\n")) ==
          Codes{{19, "zero-time-poll"}});
    // What a machine is.
    CHECK(codes_of(pair_with("one: s -> t send", "one: s + t -> t send")) ==
          Codes{{10, "never-entered"}, {11, "machine-transition"}});
    CHECK(codes_of(pair_with("state s takes 1 s starts", "state s takes 1 s")) ==
          Codes{{8, "start-state"}});
    CHECK(codes_of(pair_with("one: s -> t send", "one: s -> x send")) ==
          Codes{{10, "never-entered"}, {11, "unknown-name"}});
    CHECK(codes_of(pair_with("  state t takes", "  place t takes")).front().second == "misplaced");
    // Messages.
    CHECK(codes_of(pair_with("send c!hi", "send c")) == Codes{{11, "missing-message"}});
    CHECK(codes_of(pair_with("send d\n", "send d!hi\n")) == Codes{{19, "message-on-signal"}});
    CHECK(codes_of(pair_with("send c!hi", "send e!hi")).front() ==
          std::pair<std::uint32_t, std::string>{11, "unknown-name"});
    CHECK(codes_of(pair_with("data w: Word", "data w: bool")).front() ==
          std::pair<std::uint32_t, std::string>{18, "wrong-type"});
    CHECK(codes_of(pair_with("send c!hi", "send c!hi receive d")).front() ==
          std::pair<std::uint32_t, std::string>{11, "conflicting-clauses"});
    CHECK(codes_of(pair_with("send c!hi", "send c!hi for 2 s")) ==
          Codes{{11, "holding-on-channel"}});
}

TEST_CASE("a rule of a firing speaks of any rendezvous that it takes part in [unit]") {
    // b takes either message: a.one and a.other are two transitions with b.any.
    const std::string text = R"(enum Word { hi, bye }
channel c of Word
use a(c)
use b(c)
machine a(c: channel) {
  state s takes 1 s starts
  one:   s -> s send c!hi
  other: s -> s send c!bye
}
machine b(c: channel) {
  state s takes 1 s starts
  state t takes 1 s
  any:  s -> t receive c
  back: t -> s
}
)";
    CHECK(codes_of(text + "rule turns alternate(b.any, b.back)\nrule some quasi_live(b.any)\n")
              .empty());
    CHECK(codes_of(text + "rule always_ live(b.any)\n") == Codes{{18, "rule-of-many"}});
    CHECK(codes_of(text + "rule all live\n").empty());
}

TEST_CASE("a ring of actions in no time is told, unless something in it waits or counts [unit]") {
    const auto codes = [](const std::string& back, const std::string& state = "state l2") {
        return codes_of(R"(enum Phase { up, down }
channel says of Phase
use leg(says)
use control(says)
machine leg(says: channel) {
  state s takes 1 s starts
  state t takes 1 s
  lift: s -> t
  land: t -> s
  tell_s: s -> s send says!down
  tell_t: t -> t send says!up
}
machine control(says: channel) {
  data seen: Phase
  data asked: 0 .. 1000
  state l1 starts
  )" + state + R"(
  state l3 final
  ask: l1 -> l2 receive says?seen
  back: l2 -> l1 when seen = up )" +
                        back + R"(
  go: l2 -> l3 when seen = down
}
)");
    };
    CHECK(codes("") == Codes{{22, "zero-time-poll"}});
    CHECK(codes("poll every 0.1 s").empty());
    CHECK(codes("after 0.1 s").empty());
    CHECK(codes("", "state l2 takes 0.1 s").empty());
    CHECK(codes("set asked := 3") == Codes{{22, "zero-time-poll"}});
    CHECK(codes("set asked := asked + 1").empty());  // ends, if only at the limit
}

// ---- against a direct interpreter

struct Action {
    int from, to;
    int channel;  // -1: assigns
    bool sends;
    int message;  // sent, wanted or assigned; -1: the variable
    int guard;    // the variable must be this; -1: none
};

TEST_CASE("random machines do what a direct interpreter of them says [oracle]") {
    std::mt19937 random(5);
    const auto below = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
    int met = 0, alone = 0, stayed = 0, stuck = 0;
    for (int round = 0; round < 60; ++round) {
        constexpr int kStates = 3;
        std::vector<Action> actions[2];
        // Channel 0 goes from machine 0 to 1, channel 1 back; both have both ends.
        for (int k = 0; k < 2; ++k) {
            for (int a = 0; a < 7; ++a) {
                Action action{below(kStates), below(kStates), below(3) - 1, false, 0, below(4) - 1};
                if (a < 2) {
                    action.channel = a;
                }
                action.sends = action.channel == k;
                action.message = action.channel < 0 ? below(3) : below(4) - 1;
                actions[k].push_back(action);
            }
        }
        std::string text =
            "channel c0 of 0 .. 2\nchannel c1 of 0 .. 2\nuse m0(c0, c1) as m0\n"
            "use m1(c0, c1) as m1\n";
        for (int k = 0; k < 2; ++k) {
            text += "machine m" + std::to_string(k) +
                    "(c0: channel, c1: channel) {\n  data v: 0 .. 2\n";
            for (int s = 0; s < kStates; ++s) {
                text += "  state s" + std::to_string(s) + (s == 0 ? " starts" : "") + "\n";
            }
            for (std::size_t a = 0; a < actions[k].size(); ++a) {
                const Action& x = actions[k][a];
                text += "  t" + std::to_string(a) + ": s" + std::to_string(x.from) + " -> s" +
                        std::to_string(x.to);
                text += x.guard < 0 ? "" : " when v = " + std::to_string(x.guard);
                const std::string message = x.message < 0 ? "v" : std::to_string(x.message);
                text += x.channel < 0
                            ? " set v := " + message
                            : (x.sends ? " send c" : " receive c") + std::to_string(x.channel) +
                                  (x.sends ? "!" : "?") + message;
                text += "\n";
            }
            text += "}\n";
        }
        const scene::Scene scene = from_text(text);
        run::Player player(scene.net, {.seed = static_cast<std::uint64_t>(round)});
        int state[2] = {0, 0}, variable[2] = {0, 0};
        const auto name = [](int k, std::size_t a) {
            return "m" + std::to_string(k) + ".t" + std::to_string(a);
        };
        const auto may = [&](int k, const Action& x) {
            return x.from == state[k] && (x.guard < 0 || x.guard == variable[k]);
        };
        for (int step = 0; step < 25; ++step) {
            struct Pair {
                int sender;
                const Action *first, *second;
            };
            std::map<std::string, Pair> wanted;
            for (int k = 0; k < 2; ++k) {
                for (std::size_t a = 0; a < actions[k].size(); ++a) {
                    const Action& x = actions[k][a];
                    if (!may(k, x) || (x.channel >= 0 && !x.sends)) {
                        continue;
                    }
                    if (x.channel < 0) {
                        wanted[name(k, a)] = {k, &x, nullptr};
                        continue;
                    }
                    const int message = x.message < 0 ? variable[k] : x.message;
                    for (std::size_t b = 0; b < actions[1 - k].size(); ++b) {
                        const Action& y = actions[1 - k][b];
                        if (may(1 - k, y) && y.channel == x.channel && !y.sends &&
                            (y.message < 0 || y.message == message)) {
                            wanted[name(k, a) + "|" + name(1 - k, b)] = {k, &x, &y};
                        }
                    }
                }
            }
            for (std::uint32_t t = 0; t < scene.net.transition_count(); ++t) {
                const std::string path(scene.net.transition({t}).path);
                REQUIRE_MESSAGE(player.fireable({t}) == (wanted.count(path) != 0), path);
            }
            if (wanted.empty() || player.step() != run::Stop::kNone) {
                ++stuck;
                break;
            }
            const auto fired = wanted.find(std::string(scene.net.transition(player.last()).path));
            REQUIRE(fired != wanted.end());
            const auto& [k, x, y] = fired->second;
            const int message = x->message < 0 ? variable[k] : x->message;
            stayed += x->from == x->to ? 1 : 0;
            state[k] = x->to;
            if (y == nullptr) {
                variable[k] = x->message;
                ++alone;
            } else {
                state[1 - k] = y->to;
                if (y->message < 0) {
                    variable[1 - k] = message;
                }
                ++met;
            }
            for (int m = 0; m < 2; ++m) {
                const std::string path = "m" + std::to_string(m);
                REQUIRE(player.datum(scene.net.find_datum(path + ".v")) == variable[m]);
                REQUIRE(player.tokens(
                            scene.net.find_place(path + ".s" + std::to_string(state[m]))) == 1);
            }
        }
    }
    CHECK(met > 30);  // the test is about these
    CHECK(alone > 100);
    CHECK(stayed > 50);
    CHECK(stuck > 0);
}

}  // namespace
}  // namespace puppetri::notation
