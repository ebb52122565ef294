// SPDX-License-Identifier: MIT
// Proofs about nets that equations and sensors speak to: what freedom proves is proved, and nothing
// is refuted, or possible, that the equations rule out.
#include "proved_scene.h"

namespace puppetri::verdict {
namespace {

// The ball comes down at 0.64 s, bounces up to 1.28 m, and is above 3 m never.
const char* const kBall =
    "equations bounces(bounce: transition) {\n h starts at 2 m\n v starts at 0 m/s\n"
    " h.rate = v\n v.rate = -9.81 m/s^2\n event impact when h falls through 0 m\n"
    " event far when h rises through 3 m\n on bounce set v := -0.8*v\n}\n"
    "place flying tokens 1\nplace over\nplace gone\n"
    "bounce: flying -> flying + over on fall.impact unless over\n"
    "rest: flying -> gone on fall.impact unless gone when #over > 0\n"
    "away: flying -> gone on fall.far\nuse bounces(bounce) as fall\n";

TEST_CASE("crossings prove what holds whenever they come, and refute nothing alone [agree]") {
    const ProvedScene p(std::string(kBall) +
                        "rule holds never (flying and gone)\n"
                        "rule dead deadlock_free\n"
                        "rule comes flying leads to over\n"
                        "rule first over only if flying\n"
                        "rule early never over\n"
                        "rule far never away\n"
                        "rule reach possible over\n"
                        "rule high possible away\n"
                        "rule back reversible\n");
    CHECK(p.of("holds").answer == Answer::kProved);
    // In a run with the equations the ball does bounce.
    CHECK(p.of("early").answer == Answer::kRefuted);
    CHECK(p.of("early").witness.has_value());
    // It never flies away; a proof that takes crossings for free cannot know.
    CHECK(p.of("far").answer == Answer::kUnknown);
    CHECK(p.of("high").answer == Answer::kUnknown);
    // Nothing is stuck before the crossing has come, and the equations bring it.
    CHECK(p.of("dead").answer != Answer::kProved);
    CHECK(p.of("comes").answer != Answer::kRefuted);
    CHECK(p.of("reach").answer != Answer::kRefuted);
    CHECK(p.of("back").answer != Answer::kProved);
}

TEST_CASE("a net that waits for a crossing that comes is not called dead [agree]") {
    const ProvedScene p(
        "equations clock(ring: transition) {\n x starts at 0\n x.rate = 1 Hz\n"
        " event hour when x rises through 1\n on ring set x := 0\n}\n"
        "place a tokens 1\nring: a -> a on c.hour\nuse clock(ring) as c\n"
        "rule alive deadlock_free\nrule again ltl G(F(ring))\n");
    CHECK(p.of("alive").answer != Answer::kRefuted);
    CHECK(p.of("again").answer != Answer::kRefuted);
}

TEST_CASE("free crossings are printed as what is taken for granted [unit]") {
    const ProvedScene p(
        "cast { ana: mannequin }\nplace a does ana.wave(times: 1) tokens 1\nplace b\nplace c\n"
        "up: a -> b when height(ana.right_hand) > 1 m\nrest: b -> c after 1 s\n"
        "end { a or c }\nrule safe never (b and c)\nrule soon a leads to c\n");
    const Verdict& v = p.of("safe");
    CHECK(v.answer == Answer::kProved);
    CHECK(p.of("soon").answer != Answer::kRefuted);
}

}  // namespace
}  // namespace puppetri::verdict
