// SPDX-License-Identifier: MIT
// Fields of tables of comma-separated values.
#pragma once
#include <string>

namespace puppetri::cli {

// One field: quoted where it has a comma, a quote or a line end. Source  RFC 4180.
std::string csv_field(const std::string& text);

}  // namespace puppetri::cli
