// SPDX-License-Identifier: MIT
// Symmetric nets become place/transition nets: a place per place and colour, a transition per
// transition and binding of its variables that satisfies its condition.
// Source  ISO/IEC 15909-1:2019, symmetric nets; the unfolding is that of its clause on semantics.
#pragma once
#include "pnml_document.h"

namespace puppetri::io {

// Names: "Think(3)", "move(a,b)"; of dots and of transitions without variables the id alone.
// Fails  "net-too-large" when the unfolding passes the limits, and with all defects of the terms.
void build_symmetric(const PnmlDocument& document, const NetLimits& limits, NetFile& out,
                     Defects& defects);

}  // namespace puppetri::io
