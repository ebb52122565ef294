// SPDX-License-Identifier: MIT
// Rules in branching or linear time on a graph.
#pragma once
#include "puppetri/proof/budget.h"
#include "puppetri/verdict/check_graph.h"

namespace puppetri::verdict {

// Needs  obligation.temporal; its atoms were added to the graph's by temporal_atoms.
Finding check_temporal(const net::Net& net, const Obligation& obligation, const GraphView& view,
                       const proof::Budget& budget);

}  // namespace puppetri::verdict
