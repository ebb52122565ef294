// SPDX-License-Identifier: MIT
// What must hold for any bytes whatever: the tests of hostile files and the fuzzer ask the same.
#pragma once
#include <string>
#include <string_view>

#include "lang/dump.h"
#include "puppetri/lang/format.h"

namespace puppetri::lang::testing {

// Empty when all is well, otherwise the law that the text broke.
inline std::string broken_law(std::string_view text) {
    const Parsed result = parse(text, "hostile.pup");
    for (const Diagnostic& d : result.diagnostics) {
        if (d.message.empty() || d.code.empty() || d.remedy.empty()) {
            return "a diagnostic says what is wrong and what to do";
        }
        if (d.where.length < 1 || d.where.line > result.file.line_starts.size()) {
            return "a diagnostic points into the file";
        }
    }
    const Checked<std::string> once = format(text, "hostile.pup");
    if (once.has_value() != result.diagnostics.empty()) {
        return "what parses is formatted, and nothing else";
    }
    if (!once) {
        return {};
    }
    const Parsed again = parse(once.value(), "hostile.pup");
    if (!again.diagnostics.empty()) {
        return "what is formatted parses";
    }
    if (Dump::of(again.file) != Dump::of(result.file)) {
        return "the formatted file says the same";
    }
    if (format(once.value(), "hostile.pup").value() != once.value()) {
        return "formatting twice is formatting once";
    }
    return {};
}

}  // namespace puppetri::lang::testing
