// SPDX-License-Identifier: MIT
// How diagnostics are shown.
#include "puppetri/base/diagnostic.h"

#include <doctest/doctest.h>

using namespace puppetri;

namespace {
Diagnostic example() {
    return {.severity = Severity::kError,
            .code = "unknown-name",
            .where = {.file = "ball.pup", .line = 12, .column = 23, .length = 4},
            .element = "place to_throw",
            .message = "me has no movement called fase",
            .remedy = "did you mean face?"};
}
}  // namespace

TEST_CASE("a diagnostic shows place, line, caret and remedy [unit]") {
    CHECK(format_diagnostic(example(), "place to_throw does me.fase(road)", false) ==
          "ball.pup:12:23: error: me has no movement called fase (place to_throw) [unknown-name]\n"
          "    12 | place to_throw does me.fase(road)\n"
          "       |                       ^~~~\n"
          "  help: did you mean face?\n");
}

TEST_CASE("carets stand below code points, tabs are kept, and never run past the line [unit]") {
    Diagnostic d = example();
    d.where.column = 4;
    d.where.length = 100;
    const std::string text = format_diagnostic(d, "\t\xC3\xA4 xy", false);
    CHECK(text.find("    12 | \t\xC3\xA4 xy\n       | \t  ^~\n") != std::string::npos);
}

TEST_CASE("control characters of a hostile line do not reach the terminal [hostile]") {
    const std::string text = format_diagnostic(example(), "a\x1b[2Jb\x07", false);
    CHECK(text.find('\x1b') == std::string::npos);
    CHECK(text.find('\x07') == std::string::npos);
}

TEST_CASE("of a line of megabytes only what is around the column is shown [hostile]") {
    std::string line(1'000'000, 'x');
    line[499'999] = 'o';
    const std::string text = format_diagnostic(
        {Severity::kError, "code", {"f", 1, 500'000, 1}, "", "wrong", "mend it"}, line, false);
    CHECK(text.size() < 600);
    // The caret stands below the column.
    const std::size_t first = text.find('\n') + 1, second = text.find('\n', first) + 1;
    CHECK(text.find('o', first) - first == text.find('^', second) - second);
    // Near the beginning nothing is cut before it.
    const std::string early = format_diagnostic(
        {Severity::kError, "code", {"f", 1, 3, 2}, "", "wrong", "mend it"}, "ab" + line, false);
    CHECK(early.find(" | abxx") != std::string::npos);
    CHECK(early.find(" |   ^~") != std::string::npos);
}

TEST_CASE("without a line only the file is named, without a file nothing [unit]") {
    Diagnostic d = example();
    d.where.line = 0;
    d.remedy.clear();
    CHECK(format_diagnostic(d, "", false) ==
          "ball.pup: error: me has no movement called fase (place to_throw) [unknown-name]\n");
    d.where.file.clear();
    d.severity = Severity::kWarning;
    CHECK(format_diagnostic(d, "", false) ==
          "warning: me has no movement called fase (place to_throw) [unknown-name]\n");
    CHECK(format_diagnostic(d, "", true).find("\x1b[") != std::string::npos);
}

TEST_CASE("only errors forbid to go on [unit]") {
    Diagnostic d = example();
    CHECK(!has_errors({}));
    d.severity = Severity::kNote;
    CHECK(!has_errors({d}));
    d.severity = Severity::kWarning;
    CHECK(!has_errors({d}));
    CHECK(has_errors({d, example()}));
}
