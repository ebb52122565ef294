// SPDX-License-Identifier: MIT
#include "marking_text.h"

namespace puppetri::cli {

std::string marking_text(const net::Net& net, std::span<const std::uint32_t> tokens) {
    constexpr std::size_t kShown = 40;
    std::string text;
    std::size_t marked = 0;
    for (std::uint32_t p = 0; p < tokens.size(); ++p) {
        const std::uint32_t n = tokens[p];
        if (n == 0 || ++marked > kShown) {
            continue;
        }
        text += text.empty() ? "" : ", ";
        text += n > 1 ? std::to_string(n) + " " : "";
        text += net.place(net::PlaceIndex{p}).path;
    }
    if (marked > kShown) {
        text += " and " + std::to_string(marked - kShown) + " more places";
    }
    return text.empty() ? "nothing" : text;
}

}  // namespace puppetri::cli
