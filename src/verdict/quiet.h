// SPDX-License-Identifier: MIT
// Quiet: nothing ever fires any more, though time goes on and events may occur that nobody takes,
// as those by which machines poll. As good as dead: whoever has come to an end rests there.
#pragma once
#include "puppetri/verdict/product.h"

namespace puppetri::verdict {

// From each of these nodes no path has a firing, and all of them have been looked at: on a graph
// that has every run among its paths nothing ever fires again. Dead nodes are among them, nodes
// where a run may rest only because the outside stays away are not.
// Cost   one step per edge.
// idle: by transition, firings that count as none (idle_firings); may be empty.
Nodes quiet_for_ever(const Product& product, const std::vector<std::uint8_t>& idle = {});

// From each of these nodes some path goes on for ever, or rests, without a firing: where nothing
// ever fires again, a run is in one of these. waits: as of endless (product.h).
Nodes quiet_perhaps(const Product& product, const std::vector<std::uint8_t>& idle,
                    const proof::Waits* waits);

// By transition: whether it gives back what it takes, at once, and does nothing else: whoever fires
// it stands where he stood. So a machine asks without news.
std::vector<std::uint8_t> idle_firings(const net::Net& net);

}  // namespace puppetri::verdict
