// SPDX-License-Identifier: MIT
// The part of a net that a rule can depend on (docs/semantics.md, section on verdicts): what it
// reads, closed under producers and consumers of kept places, all arcs, data and events of kept
// transitions, and higher priorities that share a place, a datum or an event. Never for deadlock
// and freezing: these take independent components (proof/components.h).
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "puppetri/net/draft.h"
#include "puppetri/net/net.h"
#include "puppetri/proof/components.h"
#include "puppetri/proof/plain_net.h"

namespace puppetri::proof {

// The plain net without what cannot influence the places: their producers and consumers, whatever
// these test, and so on. Reachable markings seen through `places` are the same.
SubNet slice(const PlainNet& net, std::span<const std::uint32_t> places);

// What a rule speaks of. Atoms that only the stage knows (phases, holders) are not in it: who knows
// the places behind them adds these. Slices and components leave out rules that have such atoms.
struct SliceRoots {
    std::vector<std::uint32_t> places, transitions, data, events;
};
SliceRoots roots_of(const net::Rule& rule);

// A draft with only what the roots depend on; rules, states and final markings that speak of
// anything else are left out, full paths (and with them the random streams) stay.
// Needs   a lowered draft (net::lower).
struct DraftSlice {
    net::NetDraft draft;
    std::vector<std::uint32_t> places, transitions, rules;  // of the slice -> of the whole
    // A final marking speaks of more than the slice has: what is final is not known in it.
    bool finals_left_out = false;
};
DraftSlice slice(const net::NetDraft& draft, const SliceRoots& roots);
// The same for one component; with these rules instead of the draft's, as far as they speak only
// of it.
DraftSlice component(const net::NetDraft& draft, const Components& parts, std::uint32_t which);
DraftSlice component(const net::NetDraft& draft, const Components& parts, std::uint32_t which,
                     const std::vector<net::Rule>& rules);

}  // namespace puppetri::proof
