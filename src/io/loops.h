// SPDX-License-Identifier: MIT
// A transition for formats without read arcs: what is read is taken and given back. Where firings
// have no duration and clocks no memory, nobody can tell the difference.
#pragma once
#include <cstdint>
#include <utility>
#include <vector>

#include "puppetri/net/draft.h"

namespace puppetri::io {

struct Loops {
    std::vector<std::pair<std::uint32_t, std::int64_t>> takes, gives;  // in order of places
    std::vector<std::pair<std::uint32_t, std::int64_t>> unless;        // as the draft has them
};
// Per place takes the larger of what is taken and what is read. Arcs that empty a place are left
// out.
Loops with_loops(const net::TransitionDraft& transition);

}  // namespace puppetri::io
