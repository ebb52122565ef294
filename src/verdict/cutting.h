// SPDX-License-Identifier: MIT
// Places that only collect: nothing takes from them, tests or counts them. The rest of the net does
// the same without them, so rules that do not read them are asked of the net without, which may
// have few states where the whole has no end of them. Of a rule that asks only whether such a place
// has a token, it is enough to know that it has one.
#pragma once
#include <cstdint>
#include <vector>

#include "builtin_rules.h"
#include "puppetri/net/draft.h"
#include "puppetri/net/net.h"
#include "puppetri/proof/budget.h"

namespace puppetri::verdict {

// Those to which some transition gives. Needs a lowered draft (net/net.h).
std::vector<std::uint32_t> collectors(const net::NetDraft& lowered);

// What the rule says does not change if the collectors are cut off, or hold one token at most.
bool bears_cutting(const Asked& asked, const std::vector<std::uint32_t>& collectors);

// By structure alone, whatever the timing.
bool surely_bounded(const net::Net& net, const proof::Budget& budget);

// Cuts off the collectors that no rule of the draft reads; those that are read keep one token.
// Needs  all rules of the draft to bear it. Transitions keep their numbers.
net::NetDraft without_collectors(net::NetDraft lowered);

}  // namespace puppetri::verdict
