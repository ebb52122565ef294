// SPDX-License-Identifier: MIT
// What happens for ever, where times are the stage's, drawn, or the outside's: known by hand.
#include <doctest/doctest.h>

#include <string>

#include "proved_scene.h"

namespace puppetri::verdict {
namespace {

const char* const kTurns = R"(
cast { ana: mannequin { facing 90 deg } }
place looks  does ana.face(45 deg)  tokens 1
place turns  does ana.face(0 deg)
place gone
go:    looks -> turns
come:  turns -> looks
)";

TEST_CASE(
    "what the stage decides cannot help what never comes: refuted by a run that comes back "
    "[oracle]") {
    const ProvedScene s(std::string(kTurns) + R"(
rule lost   looks leads to gone
rule ends_  ends
rule silent ltl F(G(not go))
rule both   ltl G(F(go)) and G(F(come))
rule awaits ltl G(go implies F(come))
rule not_go ctl AG(not come)
rule always ctl AG(AF(go))
rule stays  ctl EF(come and looks)
)");
    for (const char* rule : {"lost", "ends_", "silent"}) {
        CHECK(s.says(rule) == "REFUTED");
        const Witness& w = *s.of(rule).witness;
        CHECK_MESSAGE(w.lasso_from != Witness::kNone, rule);
        CHECK(w.lasso_from < w.steps.size());
    }
    CHECK(s.says("both") == "PROVED for every choice");
    CHECK(s.says("awaits") == "PROVED for every choice");
    CHECK(s.says("not_go") == "REFUTED");
    CHECK(s.of("not_go").witness.has_value());
    CHECK(s.says("always") == "PROVED");
    CHECK(s.says("stays") == "PROVED");
}

TEST_CASE("luck and time are told apart where the stage decides how long [oracle]") {
    const ProvedScene s(R"(
cast { ana: mannequin { facing 90 deg } }
place here  does ana.face(45 deg)  tokens 1
place there
again: here -> here
leave: here -> there
rule leaves here leads to there
)");
    CHECK(s.says("leaves") == "PROVED with probability 1");
}

TEST_CASE("luck and time are told apart where times are drawn [oracle]") {
    const ProvedScene s(R"(
place here  takes 1 .. 2 s  tokens 1
place there
again: here -> here
leave: here -> there
rule leaves here leads to there
)");
    CHECK(s.says("leaves") == "PROVED with probability 1");
}

TEST_CASE("times alone may keep it away: then it is not a matter of luck [oracle]") {
    // b wins unless a is ready with it, each time: times of an interval may be any.
    const ProvedScene s(R"(
place a  takes 1 .. 3 s  tokens 1
place b  takes 1 .. 3 s  tokens 1
place won
a_again: a + b -> a + b  priority 2
a_only:  a -> a
b_wins:  b -> won
rule wins a leads to won
)");
    CHECK(s.says("wins") == "REFUTED");
}

TEST_CASE("the outside cannot hold up time: no run has endless events in one instant [oracle]") {
    const ProvedScene s(R"(
event call
place works  takes 1 s         tokens 1
place rests  takes 0.5 .. 2 s
place rings                     tokens 1
up:   works -> rests
down: rests -> works
ring: rings -> rings  on call
rule goes_on  ltl G(F(up))
rule by_ctl   ctl AG(AF(down))
rule awaits   works leads to rests
rule rings_   ltl F(ring)
rule no_call  ltl G(not call)
)");
    CHECK(s.says("goes_on") == "PROVED for every choice");
    CHECK(s.says("by_ctl") == "PROVED");
    CHECK(s.says("awaits") == "PROVED for every choice");
    CHECK(s.says("rings_") == "REFUTED");
    CHECK(s.says("no_call") == "REFUTED");
}

TEST_CASE("events that nobody listens to occur all the same [oracle]") {
    const ProvedScene s(R"(
event out
event wave at 2 s
event late at 5 s
place a  takes 1 s  tokens 1
place b
ab: a -> b
rule never_out never out
rule out_may   possible out
rule wave_may  possible wave
rule never_lt  never late
)");
    CHECK(s.says("never_out") == "REFUTED");
    CHECK(s.says("out_may") == "PROVED");
    CHECK(s.says("wave_may") == "PROVED");
    CHECK(s.says("never_lt") == "REFUTED");
}

TEST_CASE("firings are true just after they happen [oracle]") {
    const ProvedScene s(R"(
place a  takes 1 s  tokens 1
place b
place c  takes 1 s
ab: a -> b
bc: b -> c
rule next   ltl G(ab implies X(bc))
rule after_ ltl G(ab implies b)
rule once   ltl F(G(not ab and not bc))
rule ends_  ltl F(bc) and not F(bc and F(ab))
rule one    ctl AG(ab implies not bc)
rule ex     ctl EF(ab and EX(bc))
)");
    for (const char* rule : {"next", "after_", "once", "ends_"}) {
        CHECK(s.says(rule) == "PROVED for every choice");
    }
    CHECK(s.says("one") == "PROVED");
    CHECK(s.says("ex") == "PROVED");
}

}  // namespace
}  // namespace puppetri::verdict
