// SPDX-License-Identifier: MIT
// The readiness graph (SEMANTICS.md, section 8): every token is ready or not, and there are no
// clocks. What lasts no time is ready at once; what can fire fires, with exact priorities,
// inhibitors, guards and data; only when nothing can, any non-empty set of tokens and delays that
// wait becomes ready at once. So every run, whatever the durations, is a path: what holds on all
// paths holds for every timing.
#pragma once
#include "puppetri/proof/timed_graph.h"

namespace puppetri::proof {

// Gives  a graph that is `over`, and `exact` only if the net has no durations, delays, schedule,
//        nor outside events. Some of what it does not know: which of several waiting tokens is
//        ready first (all orders are tried), what is left of a duration, how many passes a delay
//        lasts. Outside events may occur whenever an instant has settled; so may, once, what is
//        scheduled.
//        Not available for nets that compute with the time left of a token.
// Cost   2^n edges where n tokens wait; some microseconds each.
TimedGraph readiness_graph(const GraphRequest& request);

}  // namespace puppetri::proof
