// SPDX-License-Identifier: MIT
// The words of a .net file: names, numbers, signs, and where a line begins.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "defects.h"
#include "puppetri/base/diagnostic.h"

namespace puppetri::io {

struct TinaToken {
    enum Kind : std::uint8_t { kName, kSign, kEnd };
    Kind kind = kEnd;
    bool quoted = false;      // a name in braces
    bool line_start = false;  // the first word of its line
    std::string text;         // of names: without braces and escapes; "->" is one sign
    std::uint32_t line = 1, column = 1, length = 1;
};

// Gives  all words, the last is kEnd; also the comments (without #), for what tools write there.
struct TinaWords {
    std::vector<TinaToken> tokens;
    std::vector<std::string> comments;
};
TinaWords tina_words(std::string_view text, const std::string& path, Defects& defects);

}  // namespace puppetri::io
