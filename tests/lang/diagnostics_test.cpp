// SPDX-License-Identifier: MIT
// What the parser says about files with defects: all of them at once, each at its place.
#include <doctest/doctest.h>

#include "puppetri/lang/parse.h"

using namespace puppetri;
using namespace puppetri::lang;

namespace {

// "LINE:COLUMN+LENGTH code" of each, in order.
std::string defects(const std::string& text) {
    std::string out;
    for (const Diagnostic& d : parse(text, "t.pup").diagnostics) {
        out += std::to_string(d.where.line) + ":" + std::to_string(d.where.column) + "+" +
               std::to_string(d.where.length) + " " + d.code + "\n";
    }
    return out;
}
std::string remedy(const std::string& text) {
    const Parsed result = parse(text, "t.pup");
    return result.diagnostics.empty() ? "" : result.diagnostics[0].remedy;
}

}  // namespace

TEST_CASE("all defects of a file are told at once, each at its place [unit]") {
    const std::string text =
        "language 2\n"                               // 1
        "scen \"Two\"\n"                             // 2
        "cast {\n"                                   // 3
        "  ana: mannequin { at (1, 0, 0 m, x 1 }\n"  // 4
        "  rui mannequin\n"                          // 5
        "}\n"                                        // 6
        "nett player(me: actor) {\n"                 // 7
        "  place a taks 3 s\n"                       // 8
        "  place b takes 12 framse\n"                // 9
        "  plce c\n"                                 // 10
        "  t1: a => b\n"                             // 11
        "  a -> b\n"                                 // 12
        "  t2: a -> b wen x\n"                       // 13
        "  place d takes 3 sec\n"                    // 14
        "  place e does me.step (left)\n"            // 15
        "  rule x nevr a\n"                          // 16
        "  t3: a -> b priority\n"                    // 17
        "}\n"                                        // 18
        "net good {\n"                               // 19
        "  place f tokens 1 tokens 2\n"              // 20
        "  t4: a -> b memory age\n"                  // 21
        "  place g does a.x runs b\n"                // 22
        "  t5: all 2*P -> Q\n"                       // 23
        "  seed 7\n"                                 // 24
        "}\n"                                        // 25
        "use player(ana as a\n"                      // 26
        "rule r mutex(a)\n"                          // 27
        "foo bar\n"                                  // 28
        "}\n"                                        // 29
        "net last { place a\n";                      // 30
    CHECK(defects(text) ==
          "1:10+1 unsupported-language\n"
          "2:1+4 unknown-keyword\n"
          "4:23+1 unclosed-bracket\n"
          "5:7+9 syntax\n"
          "7:1+4 unknown-keyword\n"
          "8:11+4 unknown-keyword\n"
          "9:20+6 unknown-unit\n"
          "10:3+4 unknown-keyword\n"
          "11:9+2 syntax\n"
          "12:3+1 missing-name\n"
          "13:14+3 unknown-keyword\n"
          "14:19+3 unknown-unit\n"
          "15:24+1 space-before-arguments\n"
          "16:10+4 unknown-keyword\n"
          "17:22+1 syntax\n"
          "20:20+6 repeated-clause\n"
          "21:14+10 conflicting-clauses\n"
          "22:25+1 conflicting-clauses\n"
          "23:11+1 misplaced-weight\n"
          "24:3+4 misplaced\n"
          "26:11+1 unclosed-bracket\n"
          "27:8+8 missing-argument\n"
          "28:1+3 unknown-keyword\n"
          "29:1+1 unmatched-brace\n"
          "30:10+1 unclosed-block\n");
}

TEST_CASE("the remedy names the nearest known word [unit]") {
    CHECK(remedy("plase a") == "did you mean place?");
    CHECK(remedy("place a tkes 2 s") == "did you mean takes?");
    CHECK(remedy("t: a -> b prority 2") == "did you mean priority?");
    CHECK(remedy("place a takes 2 seconds") == "did you mean s?");
    CHECK(remedy("place a takes 2 cn") == "did you mean cm?");
    CHECK(remedy("rule r allways a") == "did you mean always?");
    CHECK(remedy("nett a { }") == "did you mean net?");
    CHECK(remedy("t: a -> b wth c") == "did you mean with?");
    CHECK(remedy("scene \"A\"\nimprot walk from \"walk.pup\"") == "did you mean import?");
}

TEST_CASE("where nothing is near, the remedy shows how the statement is written [unit]") {
    CHECK(remedy("import \"walk.pup\"") == "write import NAME from \"FILE\"");
    CHECK(remedy("frames 24 fps") == "write frames 24 per second");
    CHECK(remedy("data x: int := 2") == "write data NAME: 0 .. 5 = 0");
    CHECK(remedy("t: a --> b") == "write NAME: P1 + 2*P2 -> P3 priority 2 when ...");
    CHECK(remedy("t: 2 a -> b") == "write 2*a");
    CHECK(remedy("place a takes 1,5 s") == "write 1.5");
    CHECK(remedy("transition t: a -> b") == "leave the word transition out");
    CHECK(remedy("a -> b") == "write NAME: P1 -> P2");
    CHECK(defects("t: a -> b when x and\nu: b -> a") == "1:18+3 syntax\n");
}

TEST_CASE("what other languages write is read as it was meant, once it has been told [unit]") {
    CHECK(defects("state s = a && !b || c") ==
          "1:13+2 invalid-character\n1:16+1 invalid-character\n1:19+2 invalid-character\n");
    CHECK(defects("place a; place b taks 2 s") ==
          "1:8+1 invalid-character\n1:18+4 unknown-keyword\n");
    CHECK(defects("t: a \xE2\x86\x92 b") == "1:6+1 invalid-character\n");
}

TEST_CASE("a defect in one statement does not spoil the others [unit]") {
    const Parsed result =
        parse("place a\nplace b taks 2\nplace c\nnet n(x { place d\nplace e }\nplace f", "t.pup");
    CHECK(result.diagnostics.size() == 2);
    CHECK(result.file.body.places.size() == 3);
}

TEST_CASE("all slips of one statement are told [unit]") {
    CHECK(defects("place a taks 3 s tokns 1 holds at mst 3") ==
          "1:9+4 unknown-keyword\n1:18+5 unknown-keyword\n1:35+3 unknown-keyword\n");
    CHECK(defects("t: a -> b wen x and y > 2 priorty 2 odds 1") ==
          "1:11+3 unknown-keyword\n1:27+7 unknown-keyword\n");
    CHECK(defects("t: a -> b wen f(with, x) odds 1") == "1:11+3 unknown-keyword\n");
    CHECK(defects("t: a -> b wen x memory age") == "1:11+3 unknown-keyword\n");
}

TEST_CASE("a forgotten bracket or brace is found where it was forgotten [unit]") {
    CHECK(defects("net a {\n  place b\nnet c {\n  place d\n}\n") == "3:1+3 unclosed-block\n");
    CHECK(defects("use a(b, c\nplace d\nplace e taks 2\n") ==
          "1:6+1 unclosed-bracket\n3:9+4 unknown-keyword\n");
    CHECK(defects("net a {\n  net b { place c }\n}\n") == "2:3+3 misplaced\n");
    CHECK(defects("cast {\n  ana: mannequin { height 1 m\n") ==
          "1:6+1 unclosed-block\n2:18+1 unclosed-block\n");
    CHECK(defects("state s = f(a]\n") == "1:14+1 unmatched-bracket\n");
}

TEST_CASE("characters that mean nothing are told with what to write [unit]") {
    CHECK(defects("t: a \xE2\x86\x92 b").substr(0, 24) == "1:6+1 invalid-character\n");
    CHECK(remedy("t: a \xE2\x86\x92 b") == "write ->");
    CHECK(remedy("place a; place b") == "put each statement on a line of its own");
    CHECK(remedy("place a \xE2\x80\x9Cx\xE2\x80\x9D") == "write \"");
    CHECK(defects("place b \"a") == "1:9+2 unterminated-text\n");
    CHECK(defects("place b does 'a") == "1:14+2 unterminated-text\n");
    const std::string nul("place a\nplace \0b\n", 17);
    CHECK(defects(nul) == "2:7+1 invalid-character\n");
    CHECK(defects("place a \"x\x1B[31m\"  # \x07\rplace b") ==
          "1:11+1 invalid-character\n1:21+1 invalid-character\n1:22+1 invalid-character\n");
}

TEST_CASE("names may be in any script [unit]") {
    const Parsed result = parse(
        "place r\xC3\xBC"
        "cken\nplace \xE6\xAD\xA9\xE3\x81\x8F\n",
        "t.pup");
    CHECK(result.diagnostics.empty());
    CHECK(result.file.body.places[1].name.text == "\xE6\xAD\xA9\xE3\x81\x8F");
    CHECK(defects("place r\xC3\xBC"
                  "cken taks 2") == "1:14+4 unknown-keyword\n");  // columns count characters
}

TEST_CASE("files that are no text are refused at once [hostile]") {
    CHECK(defects("place a\nplace \xFF\xFE b") == "2:7+1 invalid-utf8\n");
    const std::string huge(100'000'000, 'x');
    const Parsed result = parse(huge, "huge.pup");
    REQUIRE(result.diagnostics.size() == 1);
    CHECK(result.diagnostics[0].code == "file-too-large");
    CHECK(result.diagnostics[0].where.line == 0);
    CHECK(result.file.text.empty());
}

TEST_CASE("a file full of defects is told to a hundred of them [hostile]") {
    std::string text;
    for (int i = 0; i < 100000; ++i) {
        text += "place place place\n";
    }
    const Diagnostics list = parse(text, "t.pup").diagnostics;
    CHECK(list.size() == 101);
    CHECK(list.back().code == "too-many-errors");
}

TEST_CASE("a diagnostic reads like this [golden]") {
    const Parsed result =
        parse("net player(me: actor) {\n  place to_throw does me.face (road)\n}\n", "ball.pup");
    REQUIRE(result.diagnostics.size() == 1);
    const Diagnostic& d = result.diagnostics[0];
    CHECK(format_diagnostic(d, result.file.line_text(d.where.line), false) ==
          "ball.pup:2:31: error: there is a space between 'face' and its arguments (net player) "
          "[space-before-arguments]\n"
          "     2 |   place to_throw does me.face (road)\n"
          "       |                               ^\n"
          "  help: write face(...)\n");
}

TEST_CASE("what is shown of a line is text that a terminal can show [hostile]") {
    const Parsed result = parse("place a\nplace \xFF\xFE \x1B[31m b\n", "t.pup");
    CHECK(result.file.line_text(2) ==
          "place ?? \x1B[31m b");  // format_diagnostic takes out what a terminal would act on
    CHECK(format_diagnostic(result.diagnostics[0], result.file.line_text(2), false).find('\x1B') ==
          std::string::npos);
    CHECK(result.file.line_text(0).empty());
    CHECK(result.file.line_text(9).empty());
}
