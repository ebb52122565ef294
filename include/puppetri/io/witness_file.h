// SPDX-License-Identifier: MIT
// Witnesses as files, RULE.witness.json (docs/proof.md, section on witnesses). Times are ticks and
// 64-bit numbers are texts where JSON readers would round them.
#pragma once
#include <string>
#include <string_view>

#include "puppetri/base/diagnostic.h"
#include "puppetri/verdict/witness.h"

namespace puppetri::io {

std::string write_witness(const verdict::Witness& witness);

// Fails  "bad-witness": no JSON, another version, a member that is missing, of another type or out
//        of range. Nothing half-read is given.
Checked<verdict::Witness> read_witness(std::string_view text, const std::string& filename);

}  // namespace puppetri::io
