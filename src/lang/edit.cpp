// SPDX-License-Identifier: MIT
// Edits are replacements of stretches of text; what makes them kind to comments is where they are
// put.
#include "puppetri/lang/edit.h"

#include <algorithm>

#include "puppetri/lang/parse.h"

namespace puppetri::lang {
namespace {

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }

std::uint32_t line_begin(const File& file, std::uint32_t at) {
    const auto after = std::upper_bound(file.line_starts.begin(), file.line_starts.end(), at);
    return after == file.line_starts.begin() ? 0 : *(after - 1);
}
// Behind the line end, or the end of the text.
std::uint32_t line_end(const File& file, std::uint32_t at) {
    const auto after = std::upper_bound(file.line_starts.begin(), file.line_starts.end(), at);
    return after == file.line_starts.end() ? static_cast<std::uint32_t>(file.text.size()) : *after;
}
std::string indent_of(const File& file, std::uint32_t at) {
    const std::uint32_t begin = line_begin(file, at);
    std::uint32_t end = begin;
    while (end < file.text.size() && (file.text[end] == ' ' || file.text[end] == '\t')) {
        ++end;
    }
    return file.text.substr(begin, end - begin);
}
// What stands between two offsets is blank, or a comment at most.
bool only_comment(std::string_view text) {
    const std::size_t first = text.find_first_not_of(" \t\r\n");
    return first == std::string_view::npos || text[first] == '#';
}

Diagnostic refused(const File& file, Span where, std::string message, std::string remedy) {
    return {Severity::kError,   "edit-refused",   file.where(where), "",
            std::move(message), std::move(remedy)};
}

}  // namespace

Edit replace(Span node, std::string text) { return {node, std::move(text)}; }

Edit insert_after(const File& file, Span statement, std::string_view new_statement) {
    const std::uint32_t last =
        statement.end > statement.begin ? statement.end - 1 : statement.begin;
    std::uint32_t at = line_end(file, last);
    const std::string indent = indent_of(file, statement.begin);
    const std::string_view rest =
        std::string_view(file.text).substr(statement.end, at - statement.end);
    if (!only_comment(
            rest)) {  // `net x { place a }`: what follows the statement stays behind the new one
        at = statement.end;
        return {{at, at, statement.file},
                "\n" + indent + std::string(new_statement) + "\n" + indent};
    }
    const bool ends_line = at > 0 && file.text[at - 1] == '\n';
    return {{at, at, statement.file},
            (ends_line ? "" : "\n") + indent + std::string(new_statement) + "\n"};
}

Edit append_to_block(const File& file, Span block, std::string_view new_statement) {
    PUP_REQUIRE(block.end > block.begin && file.text[block.end - 1] == '}');
    const std::uint32_t brace = block.end - 1;
    const std::string outer = indent_of(file, block.begin);
    const std::uint32_t begin = line_begin(file, brace);
    const std::string_view before = std::string_view(file.text).substr(begin, brace - begin);
    if (before.find_first_not_of(" \t") ==
        std::string_view::npos) {  // the brace has a line of its own
        return {{begin, begin, block.file}, outer + "  " + std::string(new_statement) + "\n"};
    }
    std::uint32_t at = brace;
    while (at > 0 && is_blank(file.text[at - 1])) {
        --at;
    }
    return {{at, brace, block.file},
            "\n" + outer + "  " + std::string(new_statement) + "\n" + outer};
}

Edit add_clause(const File&, Span statement, std::string_view clause) {
    return {{statement.end, statement.end, statement.file}, " " + std::string(clause)};
}

Edit remove_statement(const File& file, Span statement) {
    const std::uint32_t begin = line_begin(file, statement.begin);
    const std::uint32_t last =
        statement.end > statement.begin ? statement.end - 1 : statement.begin;
    const std::uint32_t end = line_end(file, last);
    const std::string_view all = file.text;
    const bool alone = all.substr(begin, statement.begin - begin).find_first_not_of(" \t") ==
                           std::string_view::npos &&
                       only_comment(all.substr(statement.end, end - statement.end));
    return {alone ? Span{begin, end, statement.file} : statement, ""};
}

Checked<std::string> apply(const File& file, std::span<const Edit> edits) {
    std::vector<Edit> sorted(edits.begin(), edits.end());
    std::stable_sort(sorted.begin(), sorted.end(), [](const Edit& a, const Edit& b) {
        return std::pair(a.where.begin, a.where.end) < std::pair(b.where.begin, b.where.end);
    });
    std::string out;
    std::uint32_t at = 0;
    Diagnostics defects;
    for (const Edit& edit : sorted) {
        if (edit.where.end > file.text.size() || edit.where.end < edit.where.begin) {
            defects.push_back(
                refused(file, {0, 0, 0}, "an edit lies outside the file", "read the file again"));
            continue;
        }
        if (edit.where.begin < at) {
            defects.push_back(refused(file, edit.where, "two edits change the same text",
                                      "apply them one after the other"));
            continue;
        }
        out.append(file.text, at, edit.where.begin - at);
        out += edit.text;
        at = edit.where.end;
    }
    if (!defects.empty()) {
        return Unexpected(std::move(defects));
    }
    out.append(file.text, at, std::string::npos);
    Parsed parsed = parse(out, file.filename);
    if (has_errors(parsed.diagnostics)) {
        return Unexpected(std::move(parsed.diagnostics));
    }
    return out;
}

}  // namespace puppetri::lang
