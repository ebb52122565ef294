// SPDX-License-Identifier: MIT
// Who reads which foreign format: one function, and one source file, for each
// (notation/foreign_file.h says what it gets and gives).
#pragma once
#include "puppetri/notation/foreign_file.h"

namespace puppetri::notation {

void read_scxml(lang::Parsed& out, std::uint32_t file);
void bind_scxml(lang::Body& body, lang::Use& use, const lang::Net& chart, const lang::File& file,
                Diagnostics& diagnostics);
void read_tookima(lang::Parsed& out, std::uint32_t file);
void read_tuple_file(lang::Parsed& out, std::uint32_t file);

}  // namespace puppetri::notation
