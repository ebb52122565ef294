// SPDX-License-Identifier: MIT
// From the bytes of a .pup file to its syntax tree. The same parser serves the command line, the
// browser and editors: it reads nothing but the bytes it is given, and tells all defects of the
// file at once.
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "puppetri/base/diagnostic.h"
#include "puppetri/lang/syntax.h"

namespace puppetri::lang {

// Larger files are refused before a byte is looked at.
inline constexpr std::size_t kMaxFileBytes = 16u << 20;
// Brackets, blocks and operators nest at most so deep.
inline constexpr std::uint32_t kMaxNesting = 64;

// The tree holds every statement that could be read. Do not elaborate it when
// has_errors(diagnostics): editors show it, nobody runs it.
struct Parsed {
    File file;
    Diagnostics diagnostics;  // in order of position
};

// Gives   the whole tree, or the readable part of it and why the rest is not. A statement with a
// defect is left out; the
//         next one is read as if nothing had happened. Accepts CRLF line ends, tabs and a byte
//         order mark.
// Cost    linear in the text: some 60 ms per MB.
// `file` is the number that the tree's spans carry; `filename` is for messages only.
Parsed parse(std::string_view text, std::string_view filename, std::uint32_t file = 0);

// The text of a file with its lines and no statement: what readers of other notations begin with.
// Fails with "file-too-large" or "invalid-utf8".
Parsed open_text(std::string_view text, std::string_view filename, std::uint32_t file = 0);

// All words with a meaning of their own, in alphabetical order, for completion and colours. They
// are keywords only where they can be.
std::span<const std::string_view> keywords();

}  // namespace puppetri::lang
