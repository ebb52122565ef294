// SPDX-License-Identifier: MIT
// Long lines for people: wrapped at the width of the terminal, sums cut short, what is said of many
// places said once.
#pragma once
#include <cstddef>
#include <string>
#include <vector>

namespace puppetri::cli {

// Of the terminal that stdout is, else 100 columns.
std::size_t columns();

// On stdout, broken at spaces; each line begins with `indent` spaces. Words longer than a line are
// not broken.
void print_paragraph(const std::string& text, std::size_t indent);

// "P1 + P2 + ... + P40 = 1 (40 places)" where "P1 + P2 + P3 + ..." has more than `width` columns.
std::string short_sum(const std::string& text, std::size_t width);

// "place a.flight: its movement takes 1 s" of several places, once each: "a.flight, b.flight: ...",
// "a0.flight, b0.flight and 98 more: ...". Other texts as they are, each once, in their order.
std::vector<std::string> said_once(const std::vector<std::string>& texts);

}  // namespace puppetri::cli
