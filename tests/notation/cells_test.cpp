// SPDX-License-Identifier: MIT
// Cellular automata against arrays: a program of a few lines that keeps two arrays and nothing
// else.
#include <array>
#include <functional>
#include <set>

#include "playing.h"
#include "puppetri/base/random.h"
#include "puppetri/proof/timed_exact.h"

namespace puppetri::notation {
namespace {

struct Array {
    int columns = 0, rows = 1;
    bool wraps = true;
    int outside = 0;
    std::vector<int> cells;
    int at(int column, int row) const {
        if (wraps) {
            column = (column + 8 * columns) % columns;
            row = (row + 8 * rows) % rows;
        } else if (column < 0 || column >= columns || row < 0 || row >= rows) {
            return outside;
        }
        return cells[static_cast<std::size_t>(row * columns + column)];
    }
    void step(const std::function<int(int, int)>& next) {
        std::vector<int> made;
        for (int row = 0; row < rows; ++row) {
            for (int column = 0; column < columns; ++column) {
                made.push_back(next(column, row));
            }
        }
        cells = made;
    }
    std::string pattern(const char* shown) const {
        std::string text = "[";
        for (int row = 0; row < rows; ++row) {
            text += row == 0 ? "\"" : ", \"";
            for (int column = 0; column < columns; ++column) {
                text += shown[at(column, row)];
            }
            text += "\"";
        }
        return text + "]";
    }
};

// The cells of the net, in the array's order, every second from 0 on.
class Played {
 public:
    Played(const std::string& body, const Array& shape, bool flat)
        : scene_(from_text(body)), player_(scene_.net) {
        for (int row = 1; row <= shape.rows; ++row) {
            for (int column = 1; column <= shape.columns; ++column) {
                const std::string name = "l.cell" + (flat ? "[" + std::to_string(row) + "]" : "") +
                                         "[" + std::to_string(column) + "]";
                data_.push_back(scene_.net.find_datum(name));
                REQUIRE(data_.back().valid());
            }
        }
    }
    std::vector<int> after(int seconds) {
        player_.run({.until = {seconds * kTicksPerSecond}});
        std::vector<int> out;
        for (const net::DatumIndex d : data_) {
            out.push_back(static_cast<int>(player_.datum(d)));
        }
        return out;
    }

 private:
    scene::Scene scene_;
    run::Player player_;
    std::vector<net::DatumIndex> data_;
};

TEST_CASE("elementary rules are those of Wolfram's numbers [oracle]") {
    for (const int rule : {30, 110, 90, 184, 0, 255, 45, 73}) {
        Array a{.columns = 17, .cells = std::vector<int>(17, 0)};
        a.cells[5] = a.cells[6] = a.cells[11] = 1;
        const std::string body =
            "use r as l\ncells r {\n ring 17\n every 1 s\n off\n on\n wolfram " +
            std::to_string(rule) + "\n starts on at [6, 7, 12]\n}\n";
        Played net(body, a, false);
        for (int t = 0; t <= 20; ++t) {
            CHECK_MESSAGE(net.after(t) == a.cells, "rule ", rule, " at ", t);
            a.step([&](int c, int) {
                return (rule >> (4 * a.at(c - 1, 0) + 2 * a.at(c, 0) + a.at(c + 1, 0))) & 1;
            });
        }
    }
}

const std::string kLife =
    " every 1 s\n dead\n alive\n dead -> alive when count(alive) = 3\n"
    " alive -> dead when count(alive) < 2 or count(alive) > 3\n";

TEST_CASE("Life: a glider is one cell further down and right after four steps [law]") {
    const std::vector<std::string> glider = {".#......", "..#.....", "###.....", "........",
                                             "........", "........", "........", "........"};
    Array a{.columns = 8, .rows = 8, .cells = {}};
    for (const std::string& line : glider) {
        for (const char c : line) {
            a.cells.push_back(c == '#');
        }
    }
    Played net("use life as l\ncells life {\n torus (8, 8)\n" + kLife + " pattern " +
                   a.pattern(".#") + "\n}\n",
               a, true);
    for (int t = 0; t < 40; t += 4) {
        Array moved = a;
        moved.step([&](int c, int r) { return a.at(c - t / 4, r - t / 4); });
        CHECK(net.after(t) == moved.cells);
    }
}

TEST_CASE("Life: a blinker comes back after two steps, and not after one [law]") {
    Array a{.columns = 5, .rows = 5, .cells = std::vector<int>(25, 0)};
    a.cells[11] = a.cells[12] = a.cells[13] = 1;
    Played net("use life as l\ncells life {\n grid (5, 5)\n" + kLife +
                   " starts alive at [(2, 3), (3, 3), (4, 3)]\n}\n",
               a, true);
    std::vector<int> upright(25, 0);
    upright[7] = upright[12] = upright[17] = 1;
    CHECK(net.after(0) == a.cells);
    CHECK(net.after(1) == upright);
    CHECK(net.after(2) == a.cells);
}

TEST_CASE("random automata of three states do what arrays do, on every shape [oracle]") {
    RandomStream random(stream_key(7, "cells", "test"));
    const auto pick = [&](int n) { return static_cast<int>(random.bits() % unsigned(n)); };
    const char* names[] = {"a", "b", "c"};
    for (int round = 0; round < 40; ++round) {
        const bool flat = pick(2) == 1;
        const bool diamond = pick(2) == 1;
        const int radius = 1 + pick(2);
        Array a{.columns = 5 + pick(4),
                .rows = flat ? 5 + pick(3) : 1,
                .wraps = pick(2) == 1,
                .outside = pick(3),
                .cells = {}};
        for (int i = 0; i < a.columns * a.rows; ++i) {
            a.cells.push_back(pick(3));
        }
        struct Rule {
            int from, to, counted, most, right, down, sees;
        };
        std::vector<Rule> rules;
        std::string text;
        for (int i = 0; i < 4; ++i) {
            const Rule r{pick(3), pick(3), pick(3), pick(4), pick(3) - 1, flat ? pick(3) - 1 : 0,
                         pick(3)};
            rules.push_back(r);
            text += std::string(" ") + names[r.from] + " -> " + names[r.to] + " when count(" +
                    names[r.counted] + ") > " + std::to_string(r.most) + " or cell(" +
                    std::to_string(r.right) +
                    (flat ? ", " + std::to_string(r.down) : std::string()) +
                    ") = " + names[r.sees] + " and not me = c\n";
        }
        const std::string body =
            std::string("use r as l\ncells r {\n ") +
            (flat ? (a.wraps ? "torus (" : "grid (") + std::to_string(a.columns) + ", " +
                        std::to_string(a.rows) + ")"
                  : (a.wraps ? "ring " : "row ") + std::to_string(a.columns)) +
            "\n every 1 s\n neighbours " + std::to_string(radius) +
            (diamond ? " von_neumann" : "") + "\n" +
            (a.wraps ? "" : std::string(" outside ") + names[a.outside] + "\n") +
            " a shown \"0\"\n b shown \"1\"\n c shown \"2\"\n" + text + " pattern " +
            a.pattern("012") + "\n}\n";
        Played net(body, a, flat);
        for (int t = 0; t <= 12; ++t) {
            REQUIRE_MESSAGE(net.after(t) == a.cells, body, "at ", t);
            a.step([&](int c, int r) {
                const int me = a.at(c, r);
                for (const Rule& rule : rules) {
                    int counted = 0;
                    for (int y = flat ? -radius : 0; y <= (flat ? radius : 0); ++y) {
                        for (int x = -radius; x <= radius; ++x) {
                            const bool near = !diamond || std::abs(x) + std::abs(y) <= radius;
                            counted +=
                                near && (x != 0 || y != 0) && a.at(c + x, r + y) == rule.counted;
                        }
                    }
                    if (me == rule.from &&
                        (counted > rule.most ||
                         (a.at(c + rule.right, r + rule.down) == rule.sees && me != 2))) {
                        return rule.to;
                    }
                }
                return me;
            });
        }
    }
}

TEST_CASE("an automaton has as many states in which time passes as configurations [oracle]") {
    Array a{.columns = 9, .cells = std::vector<int>(9, 0)};
    a.cells[4] = 1;
    std::set<std::vector<int>> seen;
    while (seen.insert(a.cells).second) {
        a.step([&](int c, int) { return a.at(c - 1, 0) ^ a.at(c + 1, 0); });
    }
    const scene::Scene scene = from_text(
        "use r as l\ncells r {\n ring 9\n every 1 s\n off\n on\n wolfram 90\n starts on at 5\n}\n");
    const proof::TimedGraph made =
        proof::timed_exact_graph({.net = scene.net, .budget = proof::Budget{}});
    REQUIRE(made.available());
    std::size_t settled = 0;
    for (std::uint32_t s = 0; s < made.graph.size(); ++s) {
        settled += (made.graph.flags[s] & proof::Graph::kSettled) != 0;
    }
    CHECK(settled == seen.size());
}

const std::string kWave =
    "cast {\n ana: mannequin\n rui: mannequin { at (1, 0, 0) m }\n eve: mannequin { at (2, 0, 0) m "
    "}\n}\nuse wave as l\ncells wave {\n ring 3\n every 1 s\n figures [ana, rui, eve]\n sits\n "
    "stands does me.wave() takes 1 s\n sits -> stands when left = stands\n stands -> sits\n starts "
    "stands at 1\n}\n";

TEST_CASE("figures follow their cells in the same instant [unit]") {
    CHECK(log_of(kWave, 2) == std::vector<std::string>{"1 s l.step", "1 s l.sits_to_stands[2]",
                                                       "1 s l.stands_to_sits[1]", "2 s l.step",
                                                       "2 s l.sits_to_stands[3]",
                                                       "2 s l.stands_to_sits[2]"});
}

TEST_CASE("a state that continues another is no new movement [unit]") {
    std::string longer = kWave;
    const std::string more =
        " stays continues stands\n sits -> stands when left = stands\n stands -> stays\n stays -> "
        "sits\n";
    const std::size_t at = longer.find(" sits -> stands");
    longer.replace(at, longer.find(" starts") - at, more);
    CHECK(log_of(longer, 3) == std::vector<std::string>{"1 s l.step", "1 s l.sits_to_stands[2]",
                                                        "2 s l.step", "2 s l.sits_to_stands[3]",
                                                        "2 s l.stays_to_sits[1]", "3 s l.step",
                                                        "3 s l.stays_to_sits[2]",
                                                        "3 s l.sits_to_stands[1]"});
}

TEST_CASE("defects of cells are told where they stand [unit]") {
    const Diagnostics list = defects_of(R"(use c as l
cells c {
  ring 40
  every 1 s
  off
  on "lit" shown "ab"
  strange
  off -> on when up = on
  off -> green
  on -> off when count(left) = 2
  starts on at 41
  pattern ["?"]
  off -> on when cell(99) = on
}
)");
    CHECK(lines_and_codes(list) == LinesAndCodes{{8, "syntax"},
                                                 {9, "never-entered"},
                                                 {10, "cell-expected"},
                                                 {11, "unknown-name"},
                                                 {12, "cell-expected"},
                                                 {13, "out-of-range"},
                                                 {14, "unknown-name"},
                                                 {15, "cell-expected"}});
    CHECK_FALSE(defects_of("use c as l\ncells c {\n every 1 s\n a\n b\n a -> b\n}\n").empty());
    CHECK_FALSE(defects_of("use c as l\ncells c {\n ring 3\n a\n b\n a -> b\n}\n").empty());
    CHECK_FALSE(
        defects_of("use c as l\ncells c {\n torus (200, 200)\n every 1 s\n a\n b\n a -> b\n}\n")
            .empty());
}

TEST_CASE(
    "rules that would fill the memory are refused, and so are names and lines of odd forms "
    "[hostile]") {
    const auto first_code = [](const std::string& body) {
        const Diagnostics list = defects_of(body);
        REQUIRE_FALSE(list.empty());
        return list[0].code;
    };
    CHECK(
        first_code(
            "use c as l\ncells c {\n torus (100, 100)\n every 1 s\n neighbours 10\n a\n b\n a -> b "
            "when count(b) > 3\n}\n") == "net-too-large");
    CHECK(first_code("use c as l\ncells c {\n ring 3\n every 1 s\n a.x\n b\n a -> b\n}\n") ==
          "syntax");
    CHECK(first_code("use c as l\ncells c {\n ring 3\n every 1 s\n a { b 1 }\n b\n a -> b\n}\n") ==
          "syntax");
    CHECK(first_code("use c as l\nlogic c {\n a[1] = yes delay 1 s\n}\n") == "syntax");
    CHECK(first_code("use c as l\nmarkov c {\n a starts { }\n}\n") == "syntax");
    CHECK(first_code("use c as l\nmessages c {\n a.b sends x to y\n}\n") == "syntax");
    CHECK(first_code("use c as l\npulses c {\n every 1 s\n a.b starts 1\n}\n") == "syntax");
}

}  // namespace
}  // namespace puppetri::notation
