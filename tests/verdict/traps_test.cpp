// SPDX-License-Identifier: MIT
// Where provers go wrong: each case is a small net whose answer is known by hand.
#include "proved_scene.h"

namespace puppetri::verdict {
namespace {

TEST_CASE("a lower priority fires because the token of the higher one is not ready [oracle]") {
    const ProvedScene s(R"(
place a  tokens 1
place slow  takes 2 s  tokens 1
place high
place low
t_high: a + slow -> high  priority 2
t_low:  a        -> low
rule low  possible low
rule high possible high
)");
    CHECK(s.says("low") == "PROVED");
    CHECK(s.says("high") == "REFUTED");  // never: a has gone before
}

TEST_CASE("an untimed counterexample that no timed run has is no refutation [oracle]") {
    const ProvedScene s(R"(
place fast  takes 1 s  tokens 1
place slow  takes 3 s  tokens 1
place first
place second
t1: fast -> first
t2: slow -> second
rule order never (second and not first)
rule late  second only if first
)");
    CHECK(s.says("order") == "PROVED");
    CHECK(s.of("order").method == "exact time");
}

TEST_CASE("times that may be longer refute the same rule, by a run [oracle]") {
    const ProvedScene s(R"(
place fast  takes 1 .. 4 s  tokens 1
place slow  takes 3 s       tokens 1
place first
place second
t1: fast -> first
t2: slow -> second
rule order never (second and not first)
)");
    CHECK(s.says("order") == "REFUTED");
}

TEST_CASE("inhibitors see tokens that are not ready [oracle]") {
    const ProvedScene s(R"(
place busy  takes 1 s  tokens 1
place idle
place go               tokens 1
place done
t1: busy -> idle
t2: go -> done  unless busy
rule after never (done and busy)
)");
    CHECK(s.says("after") == "PROVED");
}

TEST_CASE("what an outside event has to start may never come [oracle]") {
    const ProvedScene s(R"(
event call
place waits  tokens 1
place goes
answer: waits -> goes  on call
rule answered waits leads to goes
rule can      possible goes
)");
    CHECK(s.says("answered") == "REFUTED");
    CHECK(s.says("can") == "PROVED");
}

TEST_CASE("ties may be lost for ever, with probability 0 [oracle]") {
    const ProvedScene s(R"(
place here   takes 1 s  tokens 1
place there
again: here -> here
leave: here -> there
rule leaves here leads to there
rule live_again possible there
)");
    CHECK(s.says("leaves") == "PROVED with probability 1");
    CHECK(s.has_note("leaves", "unlucky"));
}

TEST_CASE("vacuous proofs are said [oracle]") {
    const ProvedScene s(R"(
place a  takes 1 s  tokens 1
place b
place c
place d
ab: a -> b
cd: c -> d
rule only   cd only if a
rule leads  c leads to d
rule after  after cd no ab until ab
rule both   mutex(c, d)
rule real   ab only if a
)");
    for (const char* rule : {"only", "leads", "after", "both"}) {
        CHECK(s.of(rule).answer == Answer::kProved);
        CHECK_MESSAGE((s.of(rule).method == "invariants" || s.has_note(rule, "vacuous")), rule);
    }
    CHECK(s.says("real") == "PROVED");
    CHECK_FALSE(s.has_note("real", "vacuous"));
}

TEST_CASE("an arc that takes all breaks invariants [oracle]") {
    const ProvedScene s(R"(
place a  takes 1 s  tokens 1
place b
place go  takes 2 s  tokens 1
ab:    a      -> b
sweep: all b + go ->
rule one exactly_one(a, b)
)");
    CHECK(s.says("one") == "REFUTED");
}

TEST_CASE("a place without bound is named [oracle]") {
    const ProvedScene s(R"(
place clock  takes 1 s  tokens 1
place heap
tick: clock -> clock + heap
rule finite bounded
rule few    bounded(heap, by: 3)
)");
    CHECK(s.of("finite").answer != Answer::kProved);
    CHECK(s.of("finite").reason.find("heap") != std::string::npos);
    CHECK(s.says("few") == "REFUTED");
}

TEST_CASE("exact coincidences of drawn times are said and refute nothing [oracle]") {
    const ProvedScene s(R"(
place a  takes exponential(2 s)  tokens 1
place b  takes exponential(3 s)  tokens 1
place a_done
place b_done
place met
place out
ta: a -> a_done
tb: b -> b_done
meet: a_done + b_done -> met    priority 2
lone_a: a_done         -> out
lone_b: b_done         -> out
rule never_met never met
)");
    CHECK(s.of("never_met").answer == Answer::kUnknown);
    CHECK(s.of("never_met").reason.find("coincidence") != std::string::npos);
}

TEST_CASE("death is no deadlock in a declared end [oracle]") {
    const ProvedScene s(R"(
place a  takes 1 s  tokens 1
place b
t: a -> b
end { b }
rule dead deadlock_free
rule ends ends
rule freezes nobody_freezes
)");
    CHECK(s.says("dead") == "PROVED");
    CHECK(s.says("ends") == "PROVED for every choice");
    const ProvedScene bad(R"(
place a  takes 1 s  tokens 1
place b
t: a -> b
rule dead deadlock_free
rule ends ends
)");
    CHECK(bad.says("dead") == "REFUTED");
    CHECK(bad.says("ends") == "PROVED for every choice");
}

TEST_CASE("times of leads to and takes at most are inclusive [oracle]") {
    const ProvedScene s(R"(
place a  takes 2 s  tokens 1
place b  takes 1 s
t: a -> b
u: b -> a
rule in_two    a leads to b within 2 s
rule in_less   a leads to b within 1.9 s
rule lasts     a takes at most 2 s
rule lasts_not a takes at most 1.9 s
)");
    CHECK(s.of("in_two").answer == Answer::kProved);
    CHECK(s.says("in_less") == "REFUTED");
    CHECK(s.of("lasts").answer == Answer::kProved);
    CHECK(s.says("lasts_not") == "REFUTED");
}

TEST_CASE("a loop within one instant is told [oracle]") {
    const ProvedScene s(R"(
place a  tokens 1
place b
t: a -> b
u: b -> a
place clock takes 1 s tokens 1
tick: clock -> clock
)");
    CHECK(s.says("builtin.time_goes_on") == "REFUTED");
    const ProvedScene good(R"(
place a  takes 1 s  tokens 1
place b
t: a -> b
u: b -> a
)");
    CHECK(good.says("builtin.time_goes_on") == "PROVED");
}

TEST_CASE("a datum that leaves its range is refuted by a run [oracle]") {
    const ProvedScene s(R"(
data n: 0 .. 2 = 0
place a  takes 1 s  tokens 1
t: a -> a  set n := n + 1
)");
    CHECK(s.says("builtin.data_in_range") == "REFUTED");
    // Two firings are fine; the third, at 3 s, cannot be and is none of the run's.
    const Verdict& refuted = s.of("builtin.data_in_range");
    CHECK(refuted.reason.find("n would leave its range, at 3.000000 s") != std::string::npos);
    REQUIRE(refuted.witness.has_value());
    CHECK(refuted.witness->steps.size() == 2);
    CHECK(refuted.witness->violates_after == 2);
    const ProvedScene good(R"(
data n: 0 .. 2 = 0
place a  takes 1 s  tokens 1
t: a -> a  when n < 2 set n := n + 1
)");
    CHECK(good.says("builtin.data_in_range") == "PROVED");
}

TEST_CASE("every kind of rule on a net whose answers are known [oracle]") {
    const ProvedScene s(R"(
place a  takes 1 s  tokens 1
place b  takes 1 s
place c
ab: a     -> b + c
ba: b + c -> a
rule r1  never (a and b)
rule r2  always #a + #b = 1
rule r3  possible b
rule r4  mutex(a, b)
rule r5  exactly_one(a, b) when settled
rule r6  alternate(ab, ba)
rule r7  bounded(a, c, by: 1)
rule r8  ba only if b
rule r9  after ab no ab until ba
rule r10 a leads to b within 1 s
rule r11 a takes at most 1 s
rule r12 deadlock_free
rule r13 live(ab)
rule r14 quasi_live
rule r15 reversible
rule r16 bounded
rule r17 ctl AG(EF(a)) and A(not b until c)
rule r18 ltl G(a implies F(b)) and G(F((a until b)))
rule n1  never b
rule n2  always a
rule n3  possible (a and b)
rule n6  after ab no ba until ab
rule n10 a leads to (a and b)
rule n15 ends
rule n17 ctl AG(a)
rule n18 ltl F(G(a))
)");
    for (int i = 1; i <= 18; ++i) {
        const std::string rule = "r" + std::to_string(i);
        CHECK_MESSAGE(s.of(rule).answer == Answer::kProved, rule << " " << s.says(rule));
    }
    for (const char* rule : {"n1", "n2", "n3", "n6", "n10", "n15", "n17", "n18"}) {
        CHECK_MESSAGE(s.of(rule).answer == Answer::kRefuted, rule << " " << s.says(rule));
    }
}

}  // namespace
}  // namespace puppetri::verdict
