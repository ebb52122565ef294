// SPDX-License-Identifier: MIT
// TINA's priorities are pairs of transitions, the kernel's are levels. Where the pairs are levels,
// they become levels; where they are not, and the net has no time, each lower transition gets the
// condition that no higher one is enabled.
#pragma once
#include <cstdint>
#include <utility>
#include <vector>

#include "defects.h"
#include "puppetri/net/draft.h"

namespace puppetri::io {

// Fails  "priorities-in-a-circle"; "priorities-not-levels" in nets with time; "net-too-large".
// Cost   O(pairs * n / 64 + n^2) for n transitions that have priorities.
void settle_priorities(net::NetDraft& draft,
                       const std::vector<std::pair<std::uint32_t, std::uint32_t>>& higher,
                       Defects& defects);

}  // namespace puppetri::io
