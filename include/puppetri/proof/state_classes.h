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

// A statement about a moment: may it hold, given the rows of bits of the request's atoms and the
// label of the step that led here (Edge::label; kPass at the start)?
struct MomentTest {
    bool (*may_hold)(const void* statement, const std::uint64_t* may, const std::uint64_t* must,
                     std::uint32_t label) = nullptr;
    const void* statement = nullptr;
};

// The time from the start until the statement may hold first, over all runs: of the quickest one,
// or of the slowest. In real time, both ends of intervals included.
// Needs  of the slowest: no run goes without it for ever (else the search does not end by itself).
// Gives  nothing where the classes are not available or not exact.
// Cost   classes with one variable more: the time since the start. More of them than class_graph
//        has, as far as it takes.
struct ExtremeTime {
    Ended ended = Ended::kDone;  // else nothing below is known
    bool reached = false;
    std::int64_t ticks = 0;
    std::optional<Script> run;  // that takes just so long, if whole ticks can
};
std::optional<ExtremeTime> extreme_time(const GraphRequest& request, const MomentTest& wanted,
                                        bool quickest);

// The least and the greatest time from one step that makes the statement true to the next, over all
// runs: no mean of such times lies outside.
// Needs  on every way round time passes only if the statement becomes true (else the search does
//        not end by itself).
// Gives  nothing where there are no classes, or not all were looked at.
struct LapTimes {
    bool any = false;  // it becomes true twice in some run
    std::int64_t least = SimTime::never().ticks, greatest = 0;
};
std::optional<LapTimes> lap_times(const GraphRequest& request, const MomentTest& visited);

}  // namespace puppetri::proof
