// SPDX-License-Identifier: MIT
// Text as it stands in XML and HTML.
#pragma once
#include <string>
#include <string_view>

namespace puppetri::io {

// &, <, >, quotes and control characters as references.
std::string xml_escaped(std::string_view text);

}  // namespace puppetri::io
