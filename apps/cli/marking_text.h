// SPDX-License-Identifier: MIT
// Markings in a few words.
#pragma once
#include <cstdint>
#include <span>
#include <string>

#include "puppetri/net/net.h"

namespace puppetri::cli {

// "2 ready, waiting": what is marked, at most some places; `tokens` by place.
std::string marking_text(const net::Net& net, std::span<const std::uint32_t> tokens);

}  // namespace puppetri::cli
