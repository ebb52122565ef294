// SPDX-License-Identifier: MIT
// Inhibitors told as ordinary arcs: a place that never has more than B tokens gets a complement
// with B minus as many, and "fewer than k tokens" becomes "at least B - k + 1 of the complement". A
// place with a limit ("holds at most k") is such a place, and its complement counts what is free in
// it.
#pragma once
#include <optional>

#include "puppetri/proof/budget.h"
#include "puppetri/proof/plain_net.h"

namespace puppetri::proof {

// The same net, marking by marking, with complements as its last places.
// Gives   nothing if an inhibiting place is not known to be bounded (by the inhibitors of all who
//         add to it, or by an invariant).
// Source  Murata 1989, section III.C (capacity and complementary places).
std::optional<PlainNet> without_inhibitors(const PlainNet& net, const Budget& budget);

}  // namespace puppetri::proof
