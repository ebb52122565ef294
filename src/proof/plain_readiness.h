// SPDX-License-Identifier: MIT
// The readiness graph of a net without any time is its graph of markings: the explorer of plain
// nets makes it, some fifty times as fast.
#pragma once
#include <optional>

#include "puppetri/proof/timed_graph.h"

namespace puppetri::proof {

// Gives  nothing if the net has more than markings, or an atom asks for more: then the engine has
//        to be driven.
std::optional<TimedGraph> plain_readiness(const GraphRequest& request);

}  // namespace puppetri::proof
