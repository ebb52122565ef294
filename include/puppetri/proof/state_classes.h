// SPDX-License-Identifier: MIT
// Dense time: durations and delays that are intervals. A class is a marking with its ready tokens
// and a zone: all the times that may be left for what waits (one variable each, differences of two
// bounded). Its successors are by the set that becomes ready at one instant, then the instant
// settles with exact priorities.
// Source  B. Berthomieu, M. Diaz, Modeling and verification of time dependent systems using time
//         Petri nets (1991). Ours differs in that the variables are tokens and delays, several per
//         place, that are drawn when they begin; so a class needs no splitting for priorities,
//         which compare only what is ready: the set that becomes ready says who that is.
#pragma once
#include "puppetri/proof/timed_graph.h"

namespace puppetri::proof {

// Gives  a graph that is `over` and `exact` for runs and what linear time says of them (a class has
//        several states with different futures: nothing that branches may be concluded); low_ticks
//        and high_ticks of a pass are bounds of it alone. In real time; a path that only real
//        numbers but no ticks can go has no script.
//        Not available where a clock is stopped and goes on (memory `age`), or a place keeps the
//        order of tokens whose durations differ.
// Cost   O(n^3) per edge for n that wait.
TimedGraph class_graph(const GraphRequest& request);

// The shortest and the longest time over all runs from the initial state until the formula first
// holds, its firings and events apart. Nothing where the classes are not available.
struct Extremes {
    Ended ended = Ended::kDone;
    bool reachable = false, avoidable = false;
    std::int64_t shortest = 0, longest = 0;  // ticks; longest never: without bound
};
std::optional<Extremes> extreme_times(const GraphRequest& request, const net::Formula& wanted);

}  // namespace puppetri::proof
