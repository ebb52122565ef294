// SPDX-License-Identifier: MIT
#include <algorithm>

#include "playing.h"
#include "puppetri/notation/notation.h"

namespace puppetri::notation {
namespace {

constexpr const char* kLight = R"(use light(button) as l
event button at 5 s, 50 s
automaton light(button: event) {
  green "go"  takes 20 s starts
  yellow      takes 3 s
  red         takes 17 s
  green -> yellow on button
  yellow -> red
  red -> green
}
)";

TEST_CASE("an automaton stays in a state for its time and leaves it on its event [unit]") {
    CHECK(log_of(kLight, 100) == std::vector<std::string>{"50 s l.green_to_yellow",
                                                          "53 s l.yellow_to_red",
                                                          "70 s l.red_to_green"});
}

TEST_CASE("an automaton is the net that somebody would write for it [law]") {
    const std::string net = R"(use light(button) as l
event button at 5 s, 50 s
net light(button: event) {
  public place green takes 20 s tokens 1
  public place yellow takes 3 s
  public place red takes 17 s
  public green_to_yellow: green -> yellow on button
  public yellow_to_red: yellow -> red
  public red_to_green: red -> green
}
)";
    CHECK(log_of(kLight, 1000) == log_of(net, 1000));
    CHECK(from_text(kLight).net.hash() == from_text(net).net.hash());
}

TEST_CASE("defects of an automaton are told where they stand [unit]") {
    const Diagnostics list = defects_of(R"(use m
automaton m {
  a takes 1 s
  b takes 1 s starts quickly
  a -> c
  b -> b
}
)");
    CHECK(lines_and_codes(list, "automaton m") ==
          LinesAndCodes{{5, "never-entered"}, {6, "syntax"}, {7, "unknown-name"}});
}

TEST_CASE("states that lead to each other alone are never entered [unit]") {
    const Diagnostics list = defects_of(R"(until 9 s
use m
automaton m {
  a takes 1 s starts
  b takes 1 s
  c takes 1 s
  a -> a
  b -> c
  c -> b
}
)");
    REQUIRE(list.size() == 2);
    CHECK(list[0].code == "never-entered");
    CHECK(list[0].where.line == 7);
    CHECK(list[1].where.line == 8);
}

TEST_CASE("automata and chains do the work of a place or of a machine's state [unit]") {
    for (const char* inner : {"automaton inner {\n  a takes 2 s starts\n  b takes 1 s\n  c final\n"
                              "  a -> b\n  b -> c\n}\n",
                              "markov inner {\n  every 1 s\n  a starts\n  a2\n  b\n  c final\n"
                              "  a -> a2 1\n  a2 -> b 1\n  b -> c 1\n}\n"}) {
        const std::vector<std::string> log = log_of(
            std::string("until 20 s\nuse m\nplace p runs inner() tokens 1\nplace q\ngo: p -> q\n") +
                "machine m {\n  state s starts runs inner()\n  state t takes 1 s\n  out: s -> t\n"
                "  back: t -> s\n}\n" +
                inner,
            20);
        INFO(inner);
        CHECK(std::count(log.begin(), log.end(), "3 s go") == 1);
        CHECK(std::count(log.begin(), log.end(), "3 s m.out") == 1);
        CHECK(std::count(log.begin(), log.end(), "7 s m.out") == 1);
        CHECK(std::count(log.begin(), log.end(), "15 s m.out") == 1);
    }
}

TEST_CASE("every kind of notation is found, in alphabetical order [unit]") {
    std::string_view before;
    for (const Notation& n : notations()) {
        CHECK(before < n.kind);
        CHECK(find_notation(n.kind) == &n);
        before = n.kind;
    }
    CHECK(find_notation("camera") == nullptr);
}

}  // namespace
}  // namespace puppetri::notation
