// SPDX-License-Identifier: MIT
// Telling defects: each once, however many instances of a net show it.
#include "elaboration.h"
#include "puppetri/lang/signature.h"
#include "puppetri/lang/units.h"

namespace puppetri::scene {

void Elaboration::tell(Severity severity, std::string code, lang::Span where, std::string message,
                       std::string remedy) {
    const SourceSpan span = at(where);
    if (severity == Severity::kError) {
        broken_lines.insert({span.file, span.line});
        broken_lines.insert({at(statement_).file, at(statement_).line});
    }
    if (!told_.insert({code, where.file, where.begin}).second) {
        return;
    }
    diagnostics.push_back({.severity = severity,
                           .code = std::move(code),
                           .where = span,
                           .element = element_,
                           .message = std::move(message),
                           .remedy = std::move(remedy)});
}

void Elaboration::unknown(lang::Span where, std::string_view kind, std::string_view name,
                          const std::vector<std::string>& known) {
    const Diagnostic d = lang::unknown_name(at(where), kind, name, known, element_);
    error(d.code, where, d.message, d.remedy);
}

void Elaboration::wrong(lang::Span where, const std::string& wanted, const Term& got,
                        std::string remedy) {
    if (is_nothing(got)) {
        return;
    }
    const Number* number = std::get_if<Number>(&got);
    error(number != nullptr ? "wrong-unit" : "wrong-type", where,
          "this is " + describe(got) + " where " + wanted + " is wanted",
          remedy.empty() ? "write " + wanted + " here" : std::move(remedy));
}

}  // namespace puppetri::scene
