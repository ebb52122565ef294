// SPDX-License-Identifier: MIT
// Expressions: precedence, numbers, units.
#include <doctest/doctest.h>

#include <algorithm>

#include "lang/dump.h"
#include "puppetri/lang/parse.h"
#include "puppetri/lang/units.h"

using namespace puppetri;
using namespace puppetri::lang;

namespace {

Expr expr(const std::string& text) {
    Parsed result = parse("state s = " + text, "test.pup");
    for (const Diagnostic& d : result.diagnostics) {
        FAIL_CHECK(format_diagnostic(d, result.file.line_text(d.where.line), false));
    }
    REQUIRE(result.file.body.states.size() == 1);
    return std::move(result.file.body.states[0].formula);
}
std::string code_of(const std::string& text) {
    const Parsed result = parse("state s = " + text, "test.pup");
    return result.diagnostics.empty() ? "" : result.diagnostics[0].code;
}
// The same tree, with and without the parentheses that say it.
void same(const std::string& bare, const std::string& explicit_form) {
    CHECK_MESSAGE(testing::Dump::of(expr(bare)) == testing::Dump::of(expr(explicit_form)), bare);
}

}  // namespace

TEST_CASE("operators bind as people expect [unit]") {
    same("a + b*c", "a + (b*c)");
    same("a - b - c", "(a - b) - c");
    same("a/b*c", "(a/b)*c");
    same("-a^2", "-(a^2)");
    same("a^b^c", "a^(b^c)");
    same("not a = b", "not (a = b)");
    same("a or b and c", "a or (b and c)");
    same("a implies b implies c", "a implies (b implies c)");
    same("a and b implies c or d", "(a and b) implies (c or d)");
    same("a + 1 < b*2 and c", "((a + 1) < (b*2)) and c");
    same("0 .. n - 1", "0 .. (n - 1)");
    same("a ? b : c ? d : e", "a ? b : (c ? d : e)");
    same("a = 1 ? b : c", "(a = 1) ? b : c");
    same("a mod 3 + 1", "(a mod 3) + 1");
    same("a == b", "a = b");
    same("F(a or b until c and d)", "F(a or (b until (c and d)))");
}

TEST_CASE("sums and conjunctions of many are one node [unit]") {
    CHECK(expr("a + b + c + d").args.size() == 4);
    CHECK(expr("a and b and c").args.size() == 3);
    CHECK(expr("(a and b) and c").args.size() == 2);
    CHECK(expr("a - b - c").args.size() == 2);
}

TEST_CASE("numbers are exact [unit]") {
    CHECK(expr("0.1").number == Rational{1, 10});
    CHECK(expr("23.976").number == Rational{2997, 125});
    CHECK(expr("1e3").number == Rational{1000});
    CHECK(expr("2.5e-3").number == Rational{1, 400});
    CHECK(expr("000").number == Rational{0});
    CHECK(expr("0e999").number == Rational{0});
    CHECK(expr("9223372036854775807").number == Rational{INT64_MAX});
    CHECK(code_of("9223372036854775808") == "number-out-of-range");
    CHECK(code_of("1e40") == "number-out-of-range");
    CHECK(expr("12").unit.empty());
}

TEST_CASE("units stand after numbers and lists [unit]") {
    CHECK(expr("3 m/s^2").unit == "m/s^2");
    CHECK(expr("3 N*m").unit == "N*m");
    CHECK(expr("12frames").unit == "frames");
    CHECK(expr("(1, 2, 3) cm").unit == "cm");
    CHECK(expr("[1, 2] s").unit == "s");
    CHECK(expr("3 m / s").op == Op::kDivide);  // by something named s
    CHECK(expr("3 m/x").op == Op::kDivide);
    CHECK(code_of("3 sec") == "unknown-unit");
    CHECK(code_of("(a) m") == "misplaced-unit");
    CHECK(code_of("3 m^12") == "unknown-unit");
}

TEST_CASE("a unit gives an exact quantity [oracle]") {
    const auto value = [](const char* text) {
        const Expr e = expr(text);
        const std::optional<Quantity> q = to_quantity(e.number, e.unit);
        REQUIRE(q.has_value());
        return *q;
    };
    CHECK(value("1.5 min") == value("90 s"));
    CHECK(value("36 km/h") == value("10 m/s"));
    CHECK(value("1 N") == value("1 kg*m/s^2"));
    CHECK(value("1 W") == value("1 J/s"));
    CHECK(value("180 deg") == value("0.5 turn"));
    CHECK(value("180 deg").value() == doctest::Approx(3.14159265358979));
    CHECK(value("1 rad").value() == 1);
    CHECK(value("30 percent").value() == doctest::Approx(0.3));
    CHECK(value("12 frames").dimension == dimension::kFrame);
    CHECK_FALSE(find_unit("parsec").has_value());
    CHECK_FALSE(find_unit("").has_value());
    CHECK_FALSE(find_unit("m/").has_value());
    CHECK_FALSE(find_unit("m^").has_value());
    CHECK_FALSE(to_quantity(Rational{INT64_MAX}, "km").has_value());
    for (const std::string& unit : unit_names()) {
        CHECK(find_unit(unit).has_value());
    }
    CHECK(to_text(dimension::kSpeed) == "a speed");
}

TEST_CASE("values of every kind [unit]") {
    CHECK(expr("yes").kind == ExprKind::kBool);
    CHECK(expr("false").number == Rational{0});
    CHECK(expr("no.x").kind == ExprKind::kPath);
    CHECK(expr("\"a \\\"b\\\" \\\\ \\n\"").text == "a \"b\" \\ \n");
    CHECK(expr("#P > 2").args[0].value.kind == ExprKind::kCount);
    CHECK(expr("#ready P").kind == ExprKind::kCountReady);
    CHECK(expr("#ready").kind == ExprKind::kCount);
    CHECK(expr("#'left leg'").path.steps[0].text == "left leg");
    CHECK(expr("f()").kind == ExprKind::kCall);
    CHECK(expr("a.b.c(x, y: 2)").path.steps.size() == 3);
    CHECK(expr("[]").kind == ExprKind::kList);
    CHECK(expr("(a)").kind == ExprKind::kPath);
    CHECK(expr("(a, b)").kind == ExprKind::kTuple);
    CHECK(expr("fork[i + 1][2].x").path.steps[0].index.size() == 2);
}

TEST_CASE("an expression as text is the same expression [law]") {
    for (const char* text : {"a - (b - c)",
                             "(a - b) - c",
                             "a - b + c",
                             "(a + b) + c",
                             "a/(b*c)",
                             "-(a + b)*c",
                             "(-a)^2",
                             "-a^2",
                             "not (a and b)",
                             "(not a) = b",
                             "(a implies b) implies c",
                             "a implies b implies c",
                             "(a ? b : c) ? d : e",
                             "a ? (b ? c : d) : e",
                             "f(x, y: (1, 2) m) + [1, 2] s",
                             "0 .. n - 1",
                             "#P + #ready a.'b c'",
                             "(a or b) and c or d",
                             "2.5e-3 m/s^2",
                             "1/3",
                             "G(a implies F(b until c weak until d))"}) {
        CHECK_MESSAGE(testing::Dump::of(expr(to_text(expr(text)))) == testing::Dump::of(expr(text)),
                      text);
    }
    CHECK(to_text(expr("fork[(i mod n) + 1]")) == "fork[i mod n + 1]");
}

TEST_CASE("what is no expression is said so [unit]") {
    CHECK(code_of("a < b < c") == "chained-comparison");
    CHECK(code_of("f (x)") == "space-before-arguments");
    CHECK(code_of("(a") == "unclosed-bracket");
    CHECK(code_of("a)") == "unmatched-bracket");
    CHECK(code_of("a +") == "syntax");
    CHECK(code_of("\"\\q\"") == "unknown-escape");
    CHECK(code_of("a ? b") == "syntax");
}

TEST_CASE("no nesting exhausts the stack [hostile]") {
    const auto many = [](const std::string& unit, int n) {
        std::string out;
        for (int i = 0; i < n; ++i) {
            out += unit;
        }
        return out;
    };
    CHECK(code_of(many("(", 60) + "a" + many(")", 60)) == "");
    for (const int n : {70, 10000, 100000}) {
        CHECK(code_of(many("(", n) + "a" + many(")", n)) == "too-deep");
        CHECK(code_of(many("[", n) + "a" + many("]", n)) == "too-deep");
        CHECK(code_of(many("f(", n) + "a" + many(")", n)) == "too-deep");
        CHECK(code_of(many("not ", n) + "a") == "too-deep");
        CHECK(code_of(many("- ", n) + "a") == "too-deep");
        CHECK(code_of(many("a^", n) + "a") == "too-deep");
        CHECK(code_of(many("a implies ", n) + "a") == "too-deep");
        CHECK(code_of(many("a ? b : ", n) + "a") == "too-deep");
        CHECK(code_of(many("a[", n) + "1" + many("]", n)) == "too-deep");
    }
    CHECK(code_of(many("a-", 10000) + "a") == "too-deep");
    CHECK(code_of(many("a+", 10000) + "a") == "");  // one sum
    const Diagnostics deep_blocks = parse(many("camera x { ", 1000), "x").diagnostics;
    CHECK(std::any_of(deep_blocks.begin(), deep_blocks.end(),
                      [](const Diagnostic& d) { return d.code == "too-deep"; }));
    CHECK(parse("camera x {" + many("y {\n", 100000), "x").diagnostics[0].code == "unclosed-block");
}
