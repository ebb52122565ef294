// SPDX-License-Identifier: MIT
// How a diagnostic is shown.
#include "puppetri/base/diagnostic.h"

#include <algorithm>

#include "puppetri/base/text.h"

namespace puppetri {
namespace {

struct Look {
    const char* word;
    const char* colour;
};
Look look_of(Severity severity) {
    switch (severity) {
        case Severity::kNote:
            return {.word = "note", .colour = "\x1b[1;36m"};
        case Severity::kWarning:
            return {.word = "warning", .colour = "\x1b[1;35m"};
        case Severity::kError:
            break;
    }
    return {.word = "error", .colour = "\x1b[1;31m"};
}

constexpr const char* kBold = "\x1b[1m";
constexpr const char* kPlain = "\x1b[0m";

// What stands before the caret: tabs stay tabs, so that it lines up; anything else, also what a
// terminal would act on, becomes one space per code point.
std::string indent_to(const std::string& line, std::uint32_t column) {
    std::string indent;
    std::uint32_t at = 0;
    for (const char c : line) {
        if ((static_cast<unsigned char>(c) & 0xC0u) == 0x80) {
            continue;
        }
        if (++at >= column) {
            break;
        }
        indent += c == '\t' ? '\t' : ' ';
    }
    return indent;
}

std::string without_control_characters(std::string line) {
    for (char& c : line) {
        if ((static_cast<unsigned char>(c) < 0x20 && c != '\t') || c == 0x7F) {
            c = '?';
        }
    }
    return line;
}

// A stretch of a line around a column. Lines that people write are shown whole; machines write
// files on one line of megabytes.
struct Excerpt {
    std::string line;
    std::uint32_t column = 1;  // in `line`
};
Excerpt excerpt_of(const std::string& line, std::uint32_t column) {
    constexpr std::uint32_t kWidest = 300, kBefore = 60, kAfter = 100;
    if (line.size() <= kWidest) {
        return {line, column};
    }
    const std::uint32_t from = column > kBefore ? column - kBefore : 1;
    const auto is_first = [](char c) { return (static_cast<unsigned char>(c) & 0xC0u) != 0x80; };
    Excerpt out{from > 1 ? "..." : "", column - from + (from > 1 ? 4 : 1)};
    std::uint32_t at = 0;
    for (const char c : line) {
        at += is_first(c) ? 1 : 0;
        if (at > column + kAfter) {
            out.line += "...";
            break;
        }
        if (at >= from) {
            out.line += c;
        }
    }
    return out;
}

std::string location_of(const SourceSpan& where) {
    if (where.line == 0) {
        return where.file.empty() ? "" : where.file + ": ";
    }
    return where.file + ":" + std::to_string(where.line) + ":" + std::to_string(where.column) +
           ": ";
}

}  // namespace

bool has_errors(const Diagnostics& list) {
    return std::any_of(list.begin(), list.end(),
                       [](const Diagnostic& d) { return d.severity == Severity::kError; });
}

std::string format_diagnostic(const Diagnostic& d, const std::string& source_line, bool colours) {
    const Look look = look_of(d.severity);
    const auto paint = [colours](const char* colour) { return colours ? colour : ""; };
    std::string text = paint(kBold) + location_of(d.where) + paint(kPlain);
    text += std::string(paint(look.colour)) + look.word + ": " + paint(kPlain);
    text += paint(kBold) + d.message + paint(kPlain);
    if (!d.element.empty()) {
        text += " (" + d.element + ")";
    }
    if (!d.code.empty()) {
        text += " [" + d.code + "]";
    }
    text += '\n';
    if (!source_line.empty() && d.where.line != 0) {
        const std::string number = std::to_string(d.where.line);
        const std::string margin(std::max<std::size_t>(6, number.size()), ' ');
        const Excerpt shown = excerpt_of(source_line, d.where.column);
        const std::uint32_t width = count_code_points(shown.line);
        const std::uint32_t rest = width >= shown.column ? width - shown.column + 1 : 1;
        const std::uint32_t length = std::clamp<std::uint32_t>(d.where.length, 1, rest);
        text += margin.substr(number.size()) + number + " | " +
                without_control_characters(shown.line) + '\n';
        text += margin + " | " + indent_to(shown.line, shown.column) + paint(look.colour) + '^' +
                std::string(length - 1, '~') + paint(kPlain) + '\n';
    }
    if (!d.remedy.empty()) {
        text += "  help: " + d.remedy + '\n';
    }
    return text;
}

}  // namespace puppetri
