// SPDX-License-Identifier: MIT
// Diagnostics: what is wrong, where, with which element, and what to do about it. Every parser and
// checker reports all of its defects in one list; nothing half-loaded is used when the list has an
// error. Tests compare `code` and `where`, never wording.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "puppetri/base/result.h"

namespace puppetri {

// A stretch of source text. Lines and columns count from 1, columns in UTF-8 code points; line 0
// means "the file".
struct SourceSpan {
    std::string file;
    std::uint32_t line = 0;
    std::uint32_t column = 0;
    std::uint32_t length = 1;  // code points on that line, at least 1
    bool operator==(const SourceSpan&) const = default;
};

enum class Severity : std::uint8_t { kNote, kWarning, kError };

struct Diagnostic {
    Severity severity = Severity::kError;
    std::string code;  // stable, kebab-case: "unknown-name", "wrong-unit"
    SourceSpan where;
    std::string element;  // what it is about: "place a.to_throw"
    std::string message;  // what is wrong, one sentence without a full stop
    std::string remedy;   // what to do; may be empty only where there is nothing to say
};

using Diagnostics = std::vector<Diagnostic>;

template <class T>
using Checked = Result<T, Diagnostics>;
using Status = Result<Ok, Diagnostics>;

bool has_errors(const Diagnostics& list);

// One diagnostic as people read it, with a final newline:
//   FILE:LINE:COLUMN: error: MESSAGE (ELEMENT) [CODE]
//       12 | place to_throw does me.fase(road)
//          |                        ^~~~
//      help: REMEDY
// source_line is the text of that line, or empty to leave the excerpt out. colours: ANSI escapes.
std::string format_diagnostic(const Diagnostic& d, const std::string& source_line, bool colours);

}  // namespace puppetri
