// SPDX-License-Identifier: MIT
// What a reader of foreign files collects: all defects of a file at once, but not without bound.
#pragma once
#include <cstdint>
#include <string>
#include <utility>

#include "puppetri/base/diagnostic.h"

namespace puppetri::io {

class Defects {
 public:
    static constexpr std::size_t kMost = 100;  // errors told; one more says how many are not

    void error(const char* code, SourceSpan where, std::string element, std::string message,
               std::string remedy) {
        if (++errors_ <= kMost) {
            list_.push_back({Severity::kError, code, std::move(where), std::move(element),
                             std::move(message), std::move(remedy)});
        }
    }
    void note(Severity severity, const char* code, SourceSpan where, std::string element,
              std::string message, std::string remedy) {
        if (++notes_ <= kMost) {
            list_.push_back({severity, code, std::move(where), std::move(element),
                             std::move(message), std::move(remedy)});
        }
    }
    bool any() const { return errors_ != 0; }
    // The whole list, in the order of finding.
    Diagnostics take() {
        if (errors_ > kMost) {
            list_.push_back({Severity::kError,
                             "more-defects",
                             {},
                             "",
                             std::to_string(errors_ - kMost) + " further errors are not listed",
                             "mend these first"});
        }
        return std::move(list_);
    }

 private:
    Diagnostics list_;
    std::uint64_t errors_ = 0, notes_ = 0;
};

}  // namespace puppetri::io
