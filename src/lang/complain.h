// SPDX-License-Identifier: MIT
// From "the grammar could not go on here and would have taken these" to what an author can use.
#pragma once
#include <string>

#include "grammar.h"
#include "report.h"

namespace puppetri::lang {

// Reports why tokens [begin, end) are no statement. `element` is the enclosing block.
void complain(Entry entry, std::span<const Token> tokens, std::uint32_t begin, std::uint32_t end,
              const Reading& reading, const std::string& element, Report& report);

}  // namespace puppetri::lang
