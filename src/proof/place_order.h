// SPDX-License-Identifier: MIT
// How the places of a net become variables of a decision diagram: which of them share a variable,
// and in which order the variables stand. Both decide between kilobytes and gigabytes and neither
// changes any answer.
#pragma once
#include <cstdint>
#include <vector>

#include "puppetri/proof/budget.h"
#include "puppetri/proof/plain_net.h"
#include "symbolic_levels.h"

namespace puppetri::proof {

// Different groupings and orders of all places, the most promising first; at least one.
// Cost  some passes over the arcs, and place semiflows within a tenth of the budget's time, at most
//       5 s.
std::vector<PlaceGroups> place_orders(const PlainNet& net, const Budget& budget);

}  // namespace puppetri::proof
