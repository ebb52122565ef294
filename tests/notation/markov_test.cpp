// SPDX-License-Identifier: MIT
#include "playing.h"

namespace puppetri::notation {
namespace {

TEST_CASE("a chain in steps is the net that somebody would write for it [law]") {
    const std::string chain = R"(use weather as w
markov weather {
  every 2 s
  sunny starts
  rain "umbrellas"
  sunny -> sunny 0.8
  sunny -> rain else
  rain -> sunny 1/3
  rain -> rain 2/3
}
)";
    const std::string net = R"(use weather as w
net weather {
  public place sunny takes 2 s tokens 1
  public place rain "umbrellas" takes 2 s
  public sunny_to_sunny: sunny -> sunny odds 0.8
  public sunny_to_rain: sunny -> rain odds 0.2
  public rain_to_sunny: rain -> sunny odds 1/3
  public rain_to_rain: rain -> rain odds 2/3
}
)";
    CHECK(from_text(chain).net.hash() == from_text(net).net.hash());
    CHECK(log_of(chain, 500, 3) == log_of(net, 500, 3));
}

TEST_CASE("a chain in continuous time stays as long as the race of its rates [law]") {
    const std::string chain = R"(use bulb as b
markov bulb(repair = 10 s) {
  up starts
  down
  dead final
  up -> down mean 100 s
  down -> up mean repair
  down -> dead rate 0.1 Hz
}
)";
    const std::string net = R"(use bulb as b
net bulb {
  public place up takes exponential(100 s) tokens 1
  public place down takes exponential(5 s)
  public place dead
  public up_to_down: up -> down
  public down_to_up: down -> up odds 1/2
  public down_to_dead: down -> dead odds 1/2
  end { dead }
}
)";
    CHECK(from_text(chain).net.hash() == from_text(net).net.hash());
}

TEST_CASE("probabilities may be parameters, if one line gets the rest [unit]") {
    const std::string text = R"(use walk(0.25) as w
markov walk(p: real) {
  every 1 s
  a starts with 0.5
  b starts with 0.5
  a -> b p
  a -> a else
  b -> a 1
}
)";
    const std::string net = R"(use walk as w
net walk {
  public place begins tokens 1
  public place a takes 1 s
  public place b takes 1 s
  public begins_in_a: begins -> a odds 0.5
  public begins_in_b: begins -> b odds 0.5
  public a_to_b: a -> b odds 0.25
  public a_to_a: a -> a odds 0.75
  public b_to_a: b -> a
}
)";
    CHECK(log_of(text, 300) == log_of(net, 300));
}

LinesAndCodes codes(const std::string& lines) {
    return lines_and_codes(defects_of("use c as x\nmarkov c(p = 0.5) {\n" + lines + "}\n"),
                           "markov c");
}

TEST_CASE("a chain that does not sum to one is told where it stands [unit]") {
    const std::string head = " every 1 s\n a starts\n b\n b -> b 1\n";  // lines 5 to 8
    CHECK(codes(head + " a -> b 0.3\n a -> a 0.7\n") == LinesAndCodes{});
    CHECK(codes(head + " a -> b 0.3\n a -> a 0.6\n") == LinesAndCodes{{6, "sum-not-one"}});
    CHECK(codes(head + " a -> b 0.3\n a -> a 0.70001\n") == LinesAndCodes{{6, "sum-not-one"}});
    CHECK(codes(head + " a -> b 1/3\n a -> a 2/3\n") == LinesAndCodes{});
    CHECK(codes(head + " a -> b 1.2\n a -> a -0.2\n") != LinesAndCodes{});
    CHECK(codes(head + " a -> b 1\n a -> a else\n") == LinesAndCodes{{10, "sum-not-one"}});
    CHECK(codes(head + " a -> b p\n a -> a 0.5\n") == LinesAndCodes{{6, "sum-not-one"}});
    CHECK(codes(head + " a -> b p\n a -> a else\n") == LinesAndCodes{});
    CHECK(codes(" every 1 s\n a starts with 0.5\n b starts with 0.4\n a -> b 1\n b -> a 1\n") ==
          LinesAndCodes{{7, "sum-not-one"}});
}

TEST_CASE("other defects of chains are told where they stand [unit]") {
    CHECK(codes(" a starts\n a -> c mean 1 s\n") ==
          LinesAndCodes{{5, "sum-not-one"}, {6, "unknown-name"}});
    CHECK(codes(" a\n b\n a -> b mean 1 s\n b -> a mean 1 s\n") ==
          LinesAndCodes{{4, "start-state"}});
    CHECK(codes(" a starts\n b\n a -> b mean 1 s\n b -> a mean 1 s\n a -> b mean 2 s\n") ==
          LinesAndCodes{{9, "name-twice"}});
    CHECK(codes(" a starts final\n a -> a mean 1 s\n") == LinesAndCodes{{5, "final-is-left"}});
    CHECK(codes(" a starts final\n b\n c\n b -> c mean 1 s\n c -> b mean 1 s\n") ==
          LinesAndCodes{{6, "never-entered"}, {7, "never-entered"}});
}

}  // namespace
}  // namespace puppetri::notation
