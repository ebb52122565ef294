// SPDX-License-Identifier: MIT
// Rules about every state, told as markings that must never be.
#pragma once
#include <optional>
#include <vector>

#include "puppetri/net/formula.h"
#include "puppetri/net/net.h"
#include "puppetri/proof/predicate.h"
#include "puppetri/verdict/obligation.h"

namespace puppetri::verdict {

// Where the rule is broken one of them holds. `exactly`: and nowhere else, but for what the stage
// alone knows; otherwise sums of tokens, which invariants decide, may stand for many cases.
// Of kinds never, always, mutex, exactly_one, bounded by a number, only_if.
// Gives  nothing if an operand speaks of events or data, or of firings (but for what fires in
//        `A only if B`).
std::optional<std::vector<proof::Predicate>> bad_markings(const net::Net& net,
                                                          const net::Rule& rule,
                                                          const HostLowering* host, bool exactly);

// Some operand speaks of figures.
bool about_figures(const net::Rule& rule);
Lowered lowered(const net::Formula& formula, const HostLowering* host);

}  // namespace puppetri::verdict
