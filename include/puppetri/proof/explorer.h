// SPDX-License-Identifier: MIT
// The explicit explorer of plain nets: every reachable marking, once, lossless, packed into as few
// bits as the bounds that it finds itself allow. Counts, dead markings, reachability of predicates
// with firing sequences as witnesses, and the whole graph for rules and logics. The same counts and
// answers on any number of threads.
#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "puppetri/proof/budget.h"
#include "puppetri/proof/graph.h"
#include "puppetri/proof/plain_net.h"
#include "puppetri/proof/predicate.h"
#include "puppetri/proof/symmetry.h"

namespace puppetri::proof {

struct ExploreOptions {
    // Is a marking reachable in which the predicate holds? One answer per goal.
    std::span<const Predicate> goals;
    // A dead marking is one in which nothing is enabled that is not optional; with `final`, only if
    // that does not hold there.
    bool find_dead = false;
    const Predicate* final = nullptr;
    // Ends once every goal has been reached (and, with find_dead, a dead marking). Without
    // `witnesses` the search then goes into the depth first.
    bool stop_when_found = false;
    // Keep what firing sequences need: 4 bytes per state. On one thread they are the shortest.
    bool witnesses = false;
    // Stubborn sets: explore only what dead markings and goals need. Then states, edges and token
    // counts are those of the reduced graph. Ignored where it would be unsound: nets with levels.
    bool reduce = false;
    // Interchangeable instances: markings that differ only by who of them is who are one state.
    // Goals and `final` have to respect it (proof/symmetry.h); instances that begin differently are
    // told apart. Then states and edges are those of the quotient, a marking that was found is one
    // of several, and firings lead to one of them. Ignored where fields may have to grow.
    const Symmetry* symmetry = nullptr;
};

// A marking that was looked for.
struct Finding {
    bool found = false;
    Marking marking;
    std::vector<std::uint32_t> firings;  // from the initial marking; empty without `witnesses`
};

struct Exploration {
    // kDone: everything reachable was seen, and what was not found is not there. With
    // stop_when_found kDone is also said when all was found: then `complete` is false.
    Ended ended = Ended::kDone;
    bool complete = false;  // all reachable states (of the reduced graph) were expanded
    bool reduced = false;
    bool symmetric = false;  // states stand for all that swaps of instances make of them
    std::uint64_t states = 0, edges = 0;
    std::uint32_t max_tokens_in_place = 0;
    std::uint64_t max_tokens_per_marking = 0;
    Marking bounds;  // most tokens seen, per place
    Finding dead;
    std::vector<Finding> goals;
    unsigned bits_per_state = 0;  // of the packed marking
    std::uint64_t bytes = 0;      // most that states and tables held at one time
    double seconds = 0;
};

// Explores from the initial marking; parallel for budget.threads > 1.
// Gives  what is known when the budget ends; counts are then of the states seen so far.
// Cost   5 to 16 bytes per state for most nets, 20 to 100 ns per edge.
Exploration explore(const PlainNet& net, const ExploreOptions& options, const Budget& budget);

// Answers whether the goals (and a dead marking, with find_dead) are reachable, as soon as it can:
// walks towards few enabled transitions, a search with stubborn sets as long as it stays small, a
// search of everything, and where that is too much, one with stubborn sets again. Found is found,
// also by a walk; `complete` says that what was not found is not there. `stop_when_found` and
// `reduce` are set by it; counts are those of the last search.
Exploration seek(const PlainNet& net, const ExploreOptions& options, const Budget& budget);

struct PlainStates;  // the packed markings of a graph

// The whole graph with its states, numbered in the order in which breadth-first search finds them;
// state 0 is the initial marking.
struct PlainGraph {
    // Atoms are the predicates in their order, may == must. Flags: kFinal where `final` holds,
    // kOptional where all transitions that are enabled are optional, kCut where a state was not
    // expanded. `exact` as net.exact(), `over` always.
    Graph graph;
    Marking marking(std::uint32_t state) const;
    // A shortest firing sequence from the initial marking.
    std::vector<std::uint32_t> firings_to(std::uint32_t state) const;
    std::uint64_t bytes() const;  // held by the states, apart from `graph`

    std::shared_ptr<const PlainStates> states;
};

// Explores twice on one thread, first to count, then to fill.
// Gives  where the budget ends while exploring: a graph with ended != kDone whose states are those
//        that were found, kCut where they were not expanded: all of them, unless it was the number
//        of states that ended it.
// Cost   8 bytes per edge, about 25 per state, and 1/4 byte per state and atom.
PlainGraph build_graph(const PlainNet& net, std::span<const Predicate> atoms,
                       const Predicate* final, const Budget& budget);

}  // namespace puppetri::proof
