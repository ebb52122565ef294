// SPDX-License-Identifier: MIT
// Arguments against parameters: every way of being wrong has its code, its place and its remedy.
#include "puppetri/lang/signature.h"

#include <doctest/doctest.h>

#include "puppetri/lang/parse.h"

using namespace puppetri;
using namespace puppetri::lang;

namespace {

const Signature kThrow{"throw",
                       {{"object", true, "a prop"}, {"to", true, ""}, {"speed", false, "a speed"}}};

struct Call {
    Parsed parsed;
    MatchedArguments matched;
};
Call call(const std::string& text, const Signature& signature = kThrow) {
    Call out{parse("state s = " + text, "t.pup"), {}};
    REQUIRE(out.parsed.diagnostics.empty());
    const Expr& e = out.parsed.file.body.states[0].formula;
    out.matched = match_arguments(signature, e.args, e.span);
    return out;
}
// "COLUMN code" of each defect; "" when there is none.
std::string defects(const std::string& text) {
    const Call c = call(text);
    std::string out;
    for (const CallDefect& d : c.matched.defects) {
        CHECK(!d.message.empty());
        CHECK(!d.remedy.empty());
        out += (out.empty() ? "" : ", ") + std::to_string(c.parsed.file.where(d.where).column) +
               " " + d.code;
    }
    return out;
}

}  // namespace

TEST_CASE("arguments are matched by place, then by name [unit]") {
    const Call c = call("throw(ball, speed: 3 m/s, to: rui)");
    CHECK(c.matched.defects.empty());
    CHECK(c.matched.parameter_of == std::vector<std::uint32_t>{0, 2, 1});
    CHECK(to_text(*c.matched.values[1]) == "rui");
    CHECK(to_text(*c.matched.values[2]) == "3 m/s");
    CHECK(call("throw(ball, rui)").matched.values[2] == nullptr);
}

TEST_CASE("each slip has its code and its place, and all are told [unit]") {
    CHECK(defects("throw(ball)") == "11 missing-argument");
    CHECK(defects("throw(ball, rui, sped: 3)") == "28 unknown-name");
    CHECK(defects("throw(ball, rui, object: ball)") == "36 repeated-argument");
    CHECK(defects("throw(to: rui, ball)") == "26 argument-order, 11 missing-argument");
    CHECK(defects("throw(ball, rui, 1, 2, 3)") == "31 too-many-arguments, 34 too-many-arguments");
    CHECK(defects("throw(sped: 3, to: rui, foo: 1)") ==
          "17 unknown-name, 35 unknown-name, 11 missing-argument");
    CHECK(defects("throw()") == "11 missing-argument, 11 missing-argument");
}

TEST_CASE("remedies name the nearest parameter, or all there are [unit]") {
    CHECK(call("throw(ball, rui, sped: 3)").matched.defects[0].remedy == "did you mean speed?");
    CHECK(call("throw(ball, rui, x: 3)").matched.defects[0].remedy ==
          "there are: object, to, speed");
    CHECK(call("throw(to: rui)").matched.defects[0].message == "throw needs a prop: object");
    CHECK(call("f(1)", {"f", {}}).matched.defects[0].message == "f takes 0 arguments");
}

TEST_CASE("an unknown name among none is to be declared [unit]") {
    const Diagnostic d = unknown_name({}, "net", "walk", {}, "place P");
    CHECK(d.code == "unknown-name");
    CHECK(d.element == "place P");
    CHECK(d.remedy == "declare it, or correct the name");
}
