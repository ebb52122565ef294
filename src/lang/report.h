// SPDX-License-Identifier: MIT
// Where parsing puts its defects: spans become lines and columns, and a file that is no .pup at all
// does not drown the reader.
#pragma once
#include <string>
#include <utility>

#include "puppetri/lang/syntax.h"

namespace puppetri::lang {

class Report {
 public:
    static constexpr std::size_t kMaxErrors = 100;

    Report(const File& file, std::uint32_t number, Diagnostics& out)
        : file_(file), number_(number), out_(out) {}

    void error(std::uint32_t begin, std::uint32_t end, std::string code, std::string element,
               std::string message, std::string remedy) {
        if (out_.size() > kMaxErrors) {
            return;
        }
        if (out_.size() == kMaxErrors) {
            code = "too-many-errors";
            message = "there are more defects than these";
            remedy = "mend those above first; is this a .pup file?";
            element.clear();
        }
        out_.push_back({Severity::kError, std::move(code), file_.where({begin, end, number_}),
                        std::move(element), std::move(message), std::move(remedy)});
    }
    void error(Span span, std::string code, std::string element, std::string message,
               std::string remedy) {
        error(span.begin, span.end, std::move(code), std::move(element), std::move(message),
              std::move(remedy));
    }
    bool full() const { return out_.size() > kMaxErrors; }
    const File& file() const { return file_; }
    std::uint32_t number() const { return number_; }
    std::string_view text() const { return file_.text; }

 private:
    const File& file_;
    std::uint32_t number_;
    Diagnostics& out_;
};

}  // namespace puppetri::lang
