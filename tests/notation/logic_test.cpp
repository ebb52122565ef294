// SPDX-License-Identifier: MIT
// Digital circuits against a simulator of their own: arrays of signals and of changes to come.
#include <deque>
#include <map>
#include <set>

#include "playing.h"
#include "puppetri/base/random.h"
#include "puppetri/proof/timed_exact.h"

namespace puppetri::notation {
namespace {

constexpr std::int64_t kMs = kTicksPerSecond / 1000;

struct Gate {
    int op = 0, a = 0, b = 0;  // signals
    int rise = 0, fall = 0;    // ms; 0: at once
    bool transport = false;
    bool value(const std::vector<bool>& s) const {
        const bool x = s[static_cast<std::size_t>(a)], y = s[static_cast<std::size_t>(b)];
        switch (op) {
            case 0:
                return x && y;
            case 1:
                return x || y;
            case 2:
                return x != y;
            case 3:
                return !(x && y);
            case 4:
                return !(x || y);
            case 5:
                return x == y;
            case 6:
                return !x;
            default:
                return x;
        }
    }
    std::string text(const std::vector<std::string>& names) const {
        const std::string x = names[static_cast<std::size_t>(a)],
                          y = names[static_cast<std::size_t>(b)];
        const char* calls[] = {"", "", "xor", "nand", "nor", "xnor"};
        return op == 0   ? x + " and " + y
               : op == 1 ? x + " or " + y
               : op == 6 ? "not " + x
               : op == 7 ? "buf(" + x + ")"
                         : std::string(calls[op]) + "(" + x + ", " + y + ")";
    }
};

// Inputs first, then gates, which read anything; those without delay read among such only earlier
// ones.
struct Circuit {
    std::vector<std::set<int>> toggles;  // of each input, ms
    std::vector<Gate> gates;

    // Settled values after each millisecond.
    std::vector<std::vector<bool>> simulate(int until) const {
        const std::size_t inputs = toggles.size();
        std::vector<bool> s(inputs + gates.size(), false);
        struct Change {
            int at;
            bool value;
        };
        std::vector<std::deque<Change>> coming(gates.size());
        std::vector<bool> sent(gates.size(), false);
        std::vector<std::vector<bool>> out;
        const auto settle = [&](int now) {
            for (std::size_t g = 0; g < gates.size(); ++g) {
                if (gates[g].rise == 0) {
                    s[inputs + g] = gates[g].value(s);
                }
            }
            for (std::size_t g = 0; g < gates.size(); ++g) {
                const Gate& gate = gates[g];
                const bool wanted = gate.rise != 0 && gate.value(s);
                const int after = now + (wanted ? gate.rise : gate.fall);
                if (gate.rise == 0) {
                    continue;
                }
                if (gate.transport) {
                    if (wanted != sent[g]) {
                        coming[g].push_back({after, wanted});
                        sent[g] = wanted;
                    }
                } else if (!coming[g].empty()) {
                    if (wanted == s[inputs + g]) {
                        coming[g].clear();
                    }
                } else if (wanted != s[inputs + g]) {
                    coming[g].push_back({after, wanted});
                }
            }
        };
        for (int now = 0; now <= until; ++now) {
            for (std::size_t g = 0; g < gates.size(); ++g) {
                while (!coming[g].empty() && coming[g].front().at == now) {
                    s[inputs + g] = coming[g].front().value;
                    coming[g].pop_front();
                }
            }
            settle(now);
            for (std::size_t i = 0; i < inputs; ++i) {
                if (toggles[i].count(now) != 0) {
                    s[i] = !s[i];
                    settle(now);
                }
            }
            out.push_back(s);
        }
        return out;
    }

    std::vector<std::string> names() const {
        std::vector<std::string> out;
        for (std::size_t i = 0; i < toggles.size(); ++i) {
            out.push_back("in" + std::to_string(i));
        }
        for (std::size_t g = 0; g < gates.size(); ++g) {
            out.push_back("g" + std::to_string(g));
        }
        return out;
    }

    std::string text() const {
        const std::vector<std::string> all = names();
        std::string out = "use c as x\nlogic c {\n";
        for (std::size_t i = 0; i < toggles.size(); ++i) {
            out += " input " + all[i];
            std::string list;
            for (const int t : toggles[i]) {
                list += (list.empty() ? "" : ", ") + std::to_string(t);
            }
            out += (list.empty() ? "" : " toggles at [" + list + "] ms") + std::string("\n");
        }
        for (std::size_t g = 0; g < gates.size(); ++g) {
            const Gate& gate = gates[g];
            out += " g" + std::to_string(g) + " = " + gate.text(all);
            if (gate.rise != 0 && gate.rise == gate.fall) {
                out += " delay " + std::to_string(gate.rise) + " ms";
            } else if (gate.rise != 0) {
                out += " rise " + std::to_string(gate.rise) + " ms fall " +
                       std::to_string(gate.fall) + " ms";
            }
            out += gate.transport ? " transport\n" : "\n";
        }
        return out + "}\n";
    }
};

void compare(const Circuit& circuit, int until) {
    const std::string text = circuit.text();
    const scene::Scene scene = from_text(text);
    run::Player player(scene.net);
    const std::vector<std::string> names = circuit.names();
    const auto wanted = circuit.simulate(until);
    for (int now = 0; now <= until; ++now) {
        REQUIRE(player.run({.until = {now * kMs}}) != run::Stop::kFault);
        for (std::size_t i = 0; i < names.size(); ++i) {
            const bool got = player.datum(scene.net.find_datum("x." + names[i])) != 0;
            REQUIRE_MESSAGE(got == wanted[static_cast<std::size_t>(now)][i], text, names[i], " at ",
                            now, " ms");
        }
    }
}

TEST_CASE(
    "random circuits with rings, zero delays, both kinds of delay and coincidences [oracle]") {
    RandomStream random(stream_key(11, "logic", "test"));
    const auto pick = [&](int n) { return static_cast<int>(random.bits() % unsigned(n)); };
    for (int round = 0; round < 150; ++round) {
        Circuit c;
        c.toggles.resize(static_cast<std::size_t>(1 + pick(3)));
        for (std::set<int>& t : c.toggles) {
            for (int i = pick(8); i > 0; --i) {
                t.insert(pick(60));  // coincidences with each other and with changes of gates
            }
        }
        const int inputs = static_cast<int>(c.toggles.size()), gates = 1 + pick(8);
        std::vector<int> quick;  // what gates without delay may read
        for (int i = 0; i < inputs; ++i) {
            quick.push_back(i);
        }
        for (int g = 0; g < gates; ++g) {
            Gate made{.op = pick(8), .a = pick(inputs + gates), .b = pick(inputs + gates)};
            if (pick(4) == 0) {
                made.a = quick[static_cast<std::size_t>(pick(static_cast<int>(quick.size())))];
                made.b = quick[static_cast<std::size_t>(pick(static_cast<int>(quick.size())))];
                quick.push_back(inputs + g);
            } else {
                made.rise = 1 + pick(4);
                made.transport = pick(3) == 0;
                made.fall = made.transport ? made.rise : 1 + pick(4);
            }
            c.gates.push_back(made);
        }
        compare(c, 70);
    }
}

TEST_CASE("a full adder of gates adds, whatever the order of the toggles [oracle]") {
    for (int bits = 0; bits < 8; ++bits) {
        const auto input = [&](int i) { return (bits >> i & 1) != 0 ? "yes" : "no"; };
        const scene::Scene scene =
            from_text(std::string("use adder as x\nlogic adder {\n input a starts ") + input(0) +
                      "\n input b starts " + input(1) + "\n input c starts " + input(2) +
                      "\n half = xor(a, b) delay 3 ms\n both = a and b delay 2 ms\n sum = "
                      "xor(half, c) delay 3 ms\n passes = half and c delay 2 ms\n carry = both or "
                      "passes delay 2 ms\n}\n");
        run::Player player(scene.net);
        player.run({.until = {20 * kMs}});
        const int total = (bits & 1) + (bits >> 1 & 1) + (bits >> 2 & 1);
        CHECK(player.datum(scene.net.find_datum("x.sum")) == total % 2);
        CHECK(player.datum(scene.net.find_datum("x.carry")) == total / 2);
    }
}

TEST_CASE("a ring oscillator has a period of twice the sum of its delays [law]") {
    const std::vector<std::string> log = log_of(
        "use ring as x\nlogic ring {\n a = not c delay 10 ms\n b = not a delay 20 ms starts yes\n "
        "c = not b "
        "delay 33 ms\n}\n",
        1);
    std::vector<double> rises;
    for (const std::string& line : log) {
        if (line.find(" x.a_rises") != std::string::npos) {
            rises.push_back(std::stod(line));
        }
    }
    REQUIRE(rises.size() >= 7);
    for (std::size_t i = 1; i < rises.size(); ++i) {
        CHECK(rises[i] - rises[i - 1] == doctest::Approx(2 * (0.010 + 0.020 + 0.033)));
    }
}

TEST_CASE("what is shorter than an inertial delay is swallowed; one just as long passes [unit]") {
    const auto rises = [](const char* gate, const char* times) {
        int n = 0;
        for (const std::string& line :
             log_of(std::string("use c as x\nlogic c {\n input a toggles at ") + times +
                        " ms\n y = buf(a) delay 5 ms" + gate + "\n}\n",
                    1)) {
            n += line.find("x.y_rises") != std::string::npos ? 1 : 0;
        }
        return n;
    };
    CHECK(rises("", "[10, 14]") == 0);
    CHECK(rises("", "[10, 15]") == 1);
    CHECK(rises("", "[10, 14, 16, 30]") == 1);
    CHECK(rises(" transport", "[10, 14]") == 1);
    CHECK(rises(" transport", "[10, 11, 12, 13]") == 2);
}

TEST_CASE("a latch of two gates remembers [unit]") {
    const std::vector<std::string> log = log_of(R"(use latch as x
logic latch {
  input s toggles at [1, 1.1, 5, 5.1] s
  input r toggles at [3, 3.1] s
  q = nor(r, nq) delay 2 ms
  nq = nor(s, q) delay 2 ms starts yes
}
)",
                                                10);
    std::vector<std::string> changes;
    for (const std::string& line : log) {
        if (line.find("x.q_rises") != std::string::npos ||
            line.find("x.q_falls") != std::string::npos) {
            changes.push_back(line);
        }
    }
    CHECK(changes ==
          std::vector<std::string>{"1.004 s x.q_rises", "3.002 s x.q_falls", "5.004 s x.q_rises"});
}

TEST_CASE("clocks and events drive circuits, and circuits raise events [unit]") {
    CHECK(log_of(R"(use c(push, lit, out) as x
event push at 0.5 s, 3.2 s
event lit
event out
place dark tokens 1
place light
on: dark -> light on lit
off: light -> dark on out
logic c(push: event, lit: event, out: event) {
  clock k period 2 s high 0.5 s
  input a toggles on push
  y = a and k delay 10 ms raises lit drops out
}
)",
                 4.1) ==
          std::vector<std::string>{"0.5 s x.a_toggles", "1.5 s x.k_rises", "1.5 s x.y_starts_up",
                                   "1.51 s x.y_rises", "1.51 s on", "2 s x.k_falls",
                                   "2 s x.y_starts_down", "2.01 s x.y_falls", "2.01 s off",
                                   "3.2 s x.a_toggles", "3.5 s x.k_rises", "4 s x.k_falls"});
}

TEST_CASE("rings without delay and half-said delays are told where they stand [unit]") {
    const Diagnostics list = defects_of(R"(use c as x
logic c {
  input i
  a = not b
  b = c or i
  c = a and i
  d = i rise 1 ms
  e = i rise 1 ms fall 2 ms transport
  f = nand(i) delay 1 ms
  clock k
  i = a delay 1 ms
  g = i delay 0 s
  what is this
}
)");
    std::set<std::pair<std::uint32_t, std::string>> got;
    for (const Diagnostic& d : list) {
        got.emplace(d.where.line, d.code);
        CHECK_FALSE(d.remedy.empty());
    }
    CHECK(got == std::set<std::pair<std::uint32_t, std::string>>{{6, "zero-delay-loop"},
                                                                 {9, "one-delay"},
                                                                 {10, "one-delay"},
                                                                 {11, "wrong-count"},
                                                                 {12, "no-period"},
                                                                 {13, "name-twice"},
                                                                 {15, "syntax"}});
}

TEST_CASE("twelve gates that change together have a graph that does not multiply orders [law]") {
    // With orders left open the instant alone would have 2^12 states.
    std::string text = "use c as x\nlogic c {\n clock k period 2 s\n";
    for (int i = 0; i < 12; ++i) {
        text += " g" + std::to_string(i) + " = buf(k) delay 10 ms\n";
    }
    const scene::Scene scene = from_text(text + "}\n");
    const proof::TimedGraph made =
        proof::timed_exact_graph({.net = scene.net, .budget = proof::Budget{}});
    REQUIRE(made.available());
    CHECK(made.graph.size() < 100);
}

}  // namespace
}  // namespace puppetri::notation
