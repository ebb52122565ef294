// SPDX-License-Identifier: MIT
// Event graphs against an interpreter with an event list.
#include <algorithm>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "playing.h"
#include "puppetri/base/random.h"

namespace puppetri::notation {
namespace {

// An event changes x and y (both modulo 7), adding its parameter; it does so with `adds_x`.
struct Node {
    int priority = 1, adds_x = 0, adds_y = 0;
    bool has_parameter = false;
};

// Taken if x mod 3 = when; 3: always.
struct Arc {
    int from = 0, to = 0, after = 0, when = 3, argument = 0;
    bool cancels = false, all = false;
};

struct Graph {
    std::vector<Node> nodes;
    std::vector<Arc> arcs;
};

// Event 0 starts. Of one instant the event with the highest priority comes first, of one event the
// occurrence that was scheduled first. An event cancels before it schedules, edge after edge.
std::vector<std::string> interpreted(const Graph& g, int until, std::size_t most) {
    struct Scheduled {
        int at, event, parameter, made_at, number;
    };
    std::vector<Scheduled> list = {{0, 0, 0, 0, 0}};
    std::vector<std::string> log;
    int x = 0, y = 0, number = 0;
    const auto first_of = [](const Scheduled& a, const Scheduled& b) {
        return std::tuple(a.at, a.made_at, a.number) < std::tuple(b.at, b.made_at, b.number);
    };
    while (!list.empty() && log.size() < most) {
        const auto next =
            std::min_element(list.begin(), list.end(), [&](const Scheduled& a, const Scheduled& b) {
                const int p = g.nodes[static_cast<std::size_t>(a.event)].priority,
                          q = g.nodes[static_cast<std::size_t>(b.event)].priority;
                return std::tuple(a.at, -p, a.made_at, a.number) <
                       std::tuple(b.at, -q, b.made_at, b.number);
            });
        const Scheduled now = *next;
        list.erase(next);
        if (now.at > until) {
            break;
        }
        const Node& node = g.nodes[static_cast<std::size_t>(now.event)];
        x = (x + node.adds_x + now.parameter) % 7;
        y = (y + node.adds_y) % 7;
        log.push_back(std::to_string(now.at) + " s e" + std::to_string(now.event));
        for (const bool cancels : {true, false}) {
            for (const Arc& a : g.arcs) {
                if (a.from != now.event || a.cancels != cancels ||
                    (a.when != 3 && x % 3 != a.when)) {
                    continue;
                }
                if (!cancels) {
                    // The delay of the edge, and y more seconds.
                    list.push_back({now.at + a.after + (a.after > 2 ? y : 0), a.to,
                                    g.nodes[static_cast<std::size_t>(a.to)].has_parameter
                                        ? (a.argument + x) % 3
                                        : 0,
                                    now.at, ++number});
                    continue;
                }
                do {
                    auto gone = list.end();
                    for (auto it = list.begin(); it != list.end(); ++it) {
                        if (it->event == a.to && (gone == list.end() || first_of(*it, *gone))) {
                            gone = it;
                        }
                    }
                    if (gone == list.end()) {
                        break;
                    }
                    list.erase(gone);
                } while (a.all);
            }
        }
    }
    return log;
}

std::string as_block(const Graph& g) {
    std::string text =
        "until 100 s\nuse graph as g\nevent_graph graph {\n  data x: 0 .. 6 = 0\n"
        "  data y: 0 .. 6 = 0\n";
    for (std::size_t i = 0; i < g.nodes.size(); ++i) {
        const Node& n = g.nodes[i];
        text += "  event e" + std::to_string(i) + (n.has_parameter ? "(p: 0 .. 9)" : "") +
                " priority " + std::to_string(n.priority) + (i == 0 ? " starts" : "") +
                " { x := (x + " + std::to_string(n.adds_x) + (n.has_parameter ? " + p" : "") +
                ") mod 7, y := (y + " + std::to_string(n.adds_y) + ") mod 7 }\n";
    }
    for (const Arc& a : g.arcs) {
        text += "  e" + std::to_string(a.from) + " -> e" + std::to_string(a.to);
        if (!a.cancels && g.nodes[static_cast<std::size_t>(a.to)].has_parameter) {
            text += "(p: (" + std::to_string(a.argument) + " + x) mod 3)";
        }
        if (a.cancels) {
            text += a.all ? " cancels all" : " cancels";
        } else if (a.after > 2) {
            text += " after " + std::to_string(a.after) + " s + y*1 s";
        } else if (a.after > 0) {
            text += " after " + std::to_string(a.after) + " s";
        }
        text += a.when < 3 ? " when x mod 3 = " + std::to_string(a.when) + "\n" : "\n";
    }
    return text + "}\n";
}

std::vector<std::string> events_only(const std::vector<std::string>& log, std::size_t most) {
    std::vector<std::string> out;
    for (const std::string& line : log) {
        const std::size_t at = line.find(" s g.e");
        if (line.find("fault") != std::string::npos) {
            out.push_back(line);
        } else if (at != std::string::npos && line.find('_', at) == std::string::npos) {
            out.push_back(line.substr(0, at) + " s " + line.substr(at + 5));
        }
        if (out.size() == most) {
            break;
        }
    }
    return out;
}

TEST_CASE("an event graph does what an event list does [oracle]") {
    RandomStream random{stream_key(5, "graphs", "test"), 0};
    const auto below = [&](int n) {
        return static_cast<int>(random.below(static_cast<std::uint64_t>(n)));
    };
    std::size_t events = 0, cancelling = 0, with_parameter = 0;
    for (int again = 0; again < 400; ++again) {
        Graph g;
        g.nodes.resize(static_cast<std::size_t>(2 + below(4)));
        const int n = static_cast<int>(g.nodes.size());
        for (int i = 0; i < n; ++i) {
            g.nodes[static_cast<std::size_t>(i)] = {1 + (i * 5 + again) % 7, below(7), below(7),
                                                    i > 0 && below(3) == 0};
        }
        for (int k = n + below(2 * n); k > 0; --k) {
            Arc a{below(n), below(n), 0, below(5), below(3), below(4) == 0, below(3) == 0};
            a.when = std::min(a.when, 3);
            a.after = a.from < a.to ? below(5) : 1 + below(4);
            cancelling += a.cancels ? 1 : 0;
            g.arcs.push_back(a);
        }
        g.arcs.push_back({0, n - 1, 1 + below(3), 3, 1, false, false});
        const auto wanted = interpreted(g, 24, 400);
        const auto got = events_only(log_of(as_block(g), 24), 400);
        if (got != wanted) {
            std::string text = as_block(g);
            for (std::size_t i = 0; i < std::max(got.size(), wanted.size()); ++i) {
                text += (i < wanted.size() ? wanted[i] : "") + "   " +
                        (i < got.size() ? got[i] : "") + "\n";
            }
            FAIL(text);
        }
        events += wanted.size();
        for (const Node& node : g.nodes) {
            with_parameter += node.has_parameter ? 1 : 0;
        }
    }
    CHECK(events > 5000);
    CHECK(cancelling > 200);
    CHECK(with_parameter > 200);
}

TEST_CASE("the delay of an edge is drawn from its own law [unit]") {
    // Of two edges to one event, one is drawn: the event list takes both.
    const std::string text = R"(until 100 s
use graph as g
event_graph graph {
  event a starts
  event b
  a -> b after 2 .. 4 s
  a -> b after 1 s
}
)";
    for (std::uint64_t seed = 1; seed < 20; ++seed) {
        std::vector<std::string> log = log_of(text, 100, seed);
        std::erase_if(
            log, [](const std::string& line) { return line.find("drawn") != std::string::npos; });
        REQUIRE(log.size() == 3);
        CHECK(log[0] == "0 s g.a");
        CHECK(log[1] == "1 s g.b");
        CHECK(std::stod(log[2]) >= 2);
        CHECK(std::stod(log[2]) <= 4);
    }
}

TEST_CASE("a movement goes on between an event and the one that it schedules [unit]") {
    const std::string head = R"(until 20 s
cast { ana: mannequin }
use graph as g
event_graph graph {
  data n: 0 .. 3 = 0
  event a starts
  event b { n := n + 1 }
  event c
  a -> b after 2 s does ana.wave() when n < 3
  b -> a after 1 s when n < 2
)";
    const scene::Scene scene = from_text(head + "  b -> c after 4 s does ana.bow()\n}\n");
    const auto acts = [&](const char* path) {
        const net::PlaceIndex p = scene.net.find_place(path);
        REQUIRE(p.value != net::PlaceIndex{}.value);
        return scene.net.action(p).value != net::ActionIndex{}.value;
    };
    CHECK(acts("g.b_list"));
    CHECK(acts("g.c_list"));
    CHECK_FALSE(acts("g.a_list"));
    std::vector<std::string> log = log_of(scene, 20);
    std::erase_if(log, [](const std::string& line) { return line.find('_') != line.npos; });
    CHECK(log == std::vector<std::string>{"0 s g.a", "2 s g.b", "3 s g.a", "5 s g.b", "6 s g.c",
                                          "9 s g.c"});
    // Two edges to one event: which of them is moving would be nobody's guess.
    const Diagnostics list = defects_of(head + "  a -> c after 1 s does ana.bow()\n  b -> c\n}\n");
    REQUIRE(list.size() == 1);
    CHECK(list[0].code == "not-together");
    CHECK(list[0].where.line == 13);
}

TEST_CASE("a graph that ends does the work of a place, and calls off what is scheduled [unit]") {
    std::vector<std::string> log = log_of(R"(place p runs graph() tokens 1
place q takes 1 s
go: p -> q
back: q -> p
event_graph graph {
  data n: 0 .. 9 = 0
  event a starts { n := 0 }
  event tick(k: 0 .. 9) { n := n + 1 }
  event late
  event over ends
  a -> tick(k: 1) after 1 s
  a -> late after 20 s
  a -> over after 3 s
  tick -> tick(k: k) after 1 s
  tick -> late after 2 .. 3 s
  over -> late
}
)",
                                          7);
    std::erase_if(log, [](const std::string& line) {
        return line.find("_to_") != line.npos || line.find("p.graph") != line.npos;
    });
    // Two ticks before it ends, perhaps one in the very instant, and never the late ones.
    std::erase_if(
        log, [](const std::string& line) { return line == "3 s p.tick" || line == "7 s p.tick"; });
    CHECK(log == std::vector<std::string>{"0 s p.a", "1 s p.tick", "2 s p.tick", "3 s p.over",
                                          "3 s go", "4 s back", "4 s p.a", "5 s p.tick",
                                          "6 s p.tick", "7 s p.over", "7 s go"});
}

TEST_CASE("defects of an event graph are told where they stand [unit]") {
    const Diagnostics list = defects_of(R"(use g
event_graph g {
  event a priority 0
  event b(who: 0 .. 3)
  event c
  a -> b
  a -> d
  a -> b(who: 1, who: 2) after 2 s
  a -> b cancels after 2 s
}
)");
    CHECK(lines_and_codes(list, "event_graph g") == LinesAndCodes{{4, "start-state"},
                                                                  {5, "never-entered"},
                                                                  {5, "out-of-range"},
                                                                  {6, "never-entered"},
                                                                  {7, "never-entered"},
                                                                  {8, "wrong-arguments"},
                                                                  {9, "unknown-name"},
                                                                  {10, "wrong-arguments"},
                                                                  {11, "syntax"}});
}

}  // namespace
}  // namespace puppetri::notation
