// SPDX-License-Identifier: MIT
// Proving any rules, also such as nobody wrote down.
#pragma once
#include <vector>

#include "builtin_rules.h"
#include "puppetri/verdict/prove.h"
#include "puppetri/verdict/pursue.h"

namespace puppetri::verdict {

// All outlive the call; play may be null. In the order of `asked`.
std::vector<Verdict> prove_asked(const net::NetDraft& draft, const Theatre& theatre,
                                 const stage::Play* play, std::vector<Asked> asked,
                                 const ProveOptions& options);

}  // namespace puppetri::verdict
