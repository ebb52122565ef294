// SPDX-License-Identifier: MIT
#include "puppetri/verdict/verdict.h"

#include <doctest/doctest.h>

using namespace puppetri::verdict;

TEST_CASE(
    "REFUTED beats UNKNOWN in the exit status, and SAMPLED is no proof unless accepted [unit]") {
    const Verdict proved{.answer = Answer::kProved}, refuted{.answer = Answer::kRefuted},
        unknown{.answer = Answer::kUnknown}, sampled{.answer = Answer::kSampled};
    CHECK(exit_status({}, false) == 0);
    CHECK(exit_status({proved, proved}, false) == 0);
    CHECK(exit_status({unknown, refuted, proved}, false) == 1);
    CHECK(exit_status({unknown, proved}, true) == 3);
    CHECK(exit_status({sampled, proved}, false) == 3);
    CHECK(exit_status({sampled, proved}, true) == 0);
}

TEST_CASE("a verdict is named with its force [unit]") {
    CHECK(name_of({.answer = Answer::kProved, .force = Force::kEveryChoice}) ==
          "PROVED for every choice");
    CHECK(name_of({.answer = Answer::kProved, .force = Force::kProbabilityOne}) ==
          "PROVED with probability 1");
    CHECK(name_of({.answer = Answer::kUnknown}) == "UNKNOWN");
}
