// SPDX-License-Identifier: MIT
#include "tina_lexer.h"

#include <algorithm>

#include "puppetri/base/text.h"

namespace puppetri::io {
namespace {

bool is_name_byte(char c) {
    // Letters beyond ASCII are let in: editors write them, TINA's grammar says "letters".
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '\'' || static_cast<unsigned char>(c) >= 0x80;
}

}  // namespace

TinaWords tina_words(std::string_view text, const std::string& path, Defects& defects) {
    TinaWords out;
    std::uint32_t line = 1;
    std::size_t line_at = 0;
    bool line_start = true;
    std::size_t i = 0;
    const auto column = [&](std::size_t at) {
        const std::string_view before = text.substr(line_at, at - line_at);
        return before.size() > 4096 ? static_cast<std::uint32_t>(before.size() + 1)
                                    : column_of(before, before.size());
    };
    const auto push = [&](TinaToken::Kind kind, std::size_t begin, std::size_t end,
                          std::string word, bool quoted) {
        TinaToken token;
        token.kind = kind;
        token.quoted = quoted;
        token.line_start = line_start;
        token.text = std::move(word);
        token.line = line;
        token.column = column(begin);
        token.length =
            std::max<std::uint32_t>(1, count_code_points(text.substr(begin, end - begin)));
        out.tokens.push_back(std::move(token));
        line_start = false;
    };
    while (i < text.size()) {
        const char c = text[i];
        if (c == '\n') {
            ++line;
            line_at = ++i;
            line_start = true;
        } else if (c == ' ' || c == '\t' || c == '\r') {
            ++i;
        } else if (c == '#' && line_start) {
            const std::size_t end = std::min(text.find('\n', i), text.size());
            out.comments.emplace_back(text.substr(i + 1, end - i - 1));
            i = end;
        } else if (is_name_byte(c)) {
            std::size_t end = i;
            while (end < text.size() && is_name_byte(text[end])) {
                ++end;
            }
            push(TinaToken::kName, i, end, std::string(text.substr(i, end - i)), false);
            i = end;
        } else if (c == '{') {
            std::string name;
            std::size_t end = i + 1;
            bool closed = false;
            std::uint32_t lines = 0;
            std::size_t last_line = line_at;
            while (end < text.size() && !closed) {
                if (text[end] == '\\' && end + 1 < text.size()) {
                    name += text[end + 1];
                    end += 2;
                } else if (text[end] == '}') {
                    closed = true;
                    ++end;
                } else {
                    if (text[end] == '\n') {
                        ++lines;
                        last_line = end + 1;
                    }
                    name += text[end++];
                }
            }
            if (!closed) {
                defects.error("unclosed-name", {path, line, column(i), 1}, "",
                              "a name in braces does not end", "write } after it");
            }
            push(TinaToken::kName, i, i + 1, std::move(name), true);
            line += lines;
            line_at = last_line;
            i = end;
        } else if (c == '-' && i + 1 < text.size() && text[i + 1] == '>') {
            push(TinaToken::kSign, i, i + 2, "->", false);
            i += 2;
        } else {
            push(TinaToken::kSign, i, i + 1, std::string(1, c), false);
            ++i;
        }
    }
    TinaToken end;
    end.line_start = true;
    end.line = line;
    end.column = column(text.size());
    out.tokens.push_back(std::move(end));
    return out;
}

}  // namespace puppetri::io
