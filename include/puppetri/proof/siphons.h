// SPDX-License-Identifier: MIT
// Siphons and traps. A trap: who takes from it gives to it, so once marked it stays marked. A
// siphon: who gives to it takes from it, so once empty it stays empty. Both hold with weights, and
// whatever forbids firings (inhibitors, guards, time); arcs that take all of a place break traps.
// The theorems that conclude liveness need more: see proof/structural_liveness.h.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "puppetri/proof/budget.h"
#include "puppetri/proof/plain_net.h"

namespace puppetri::proof {

using PlaceSet = std::vector<std::uint32_t>;  // in order, no doubles

bool is_trap(const PlainNet& net, std::span<const std::uint32_t> places);
bool is_siphon(const PlainNet& net, std::span<const std::uint32_t> places);

// The greatest trap or siphon within a set (may be empty): take away what breaks it until nothing
// does. Linear in the arcs.
PlaceSet greatest_trap_within(const PlainNet& net, std::span<const std::uint32_t> places);
PlaceSet greatest_siphon_within(const PlainNet& net, std::span<const std::uint32_t> places);

struct PlaceSets {
    std::vector<PlaceSet> sets;
    bool complete = true;  // false: the budget ended before all were found
};

// Minimal (containing no other, not empty) siphons or traps, in order of their places.
// Cost    exponentially many in the worst case; at most `budget.states` of them (capped at 20 000).
// Source  enumeration by partition as in Cordone, Ferrarini, Piroddi: Enumeration algorithms for
//         minimal siphons in Petri nets based on place constraints, IEEE SMC-A 35, 2005.
PlaceSets minimal_siphons(const PlainNet& net, const Budget& budget);
PlaceSets minimal_traps(const PlainNet& net, const Budget& budget);

struct SiphonAnswer {
    enum Kind : std::uint8_t { kHolds, kFails, kUnknown };
    Kind kind = kUnknown;
    PlaceSet siphon;  // of kFails: a siphon whose greatest trap is not marked initially
};
// Commoner's property: every siphon contains a trap that is marked initially.
SiphonAnswer commoner(const PlainNet& net, const Budget& budget);

}  // namespace puppetri::proof
