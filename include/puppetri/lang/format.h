// SPDX-License-Identifier: MIT
// The canonical form of a file: one layout for everybody, all comments kept, nothing else changed.
// Indented by two spaces, columns of neighbouring statements of one kind aligned, at most one blank
// line in a row.
#pragma once
#include <string>
#include <string_view>

#include "puppetri/base/diagnostic.h"
#include "puppetri/lang/parse.h"

namespace puppetri::lang {

// Gives   the canonical text: formatting it again changes nothing, and parsing it gives the same
// tree but for spans. Fails   with parse()'s errors; a file with a defect is not formatted.
Checked<std::string> format(std::string_view text, std::string_view filename);

}  // namespace puppetri::lang
