// SPDX-License-Identifier: MIT
// One rule on one graph. What a graph may say depends on what it is: an over-approximation proves
// what holds on all its paths, a path is only a suspect until it has been played as a run, and what
// branches (live, reversible) needs a graph whose states are single states of the net
// (SEMANTICS.md, section 8).
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "puppetri/proof/timed_graph.h"
#include "puppetri/verdict/product.h"
#include "puppetri/verdict/verdict.h"

namespace puppetri::verdict {

// A graph with what its method stands for.
struct GraphView {
    const proof::TimedGraph* timed = nullptr;
    // Each state of the graph is one state of the net, so that "from here it can" means something.
    bool concrete = false;
    // The ticks on its edges bound the time of every path.
    bool by_ticks = false;
    // How long a wait of each kind lasts at most (proof::Waits), in ticks.
    std::vector<std::int64_t> at_most;
};

struct LinearGame;  // src/verdict/linear_rule.h

struct Finding {
    enum class Kind : std::uint8_t {
        kHolds,       // proved by this graph
        kSuspect,     // a run into `targets` would refute the rule (of `possible`: prove it)
        kImpossible,  // of `possible`, `quasi_live`: no path gets there; refuted
        kRefuted,     // by an exact graph; `path` shows it, if one run can
        kUnknown,
    };
    // When a run has refuted the rule.
    enum class Target : std::uint8_t {
        kBroken,    // the monitor says so
        kRest,      // nothing happens any more, in no final marking (or while something is owed)
        kEndless,   // it goes round for ever inside `targets`
        kHopeless,  // what should stay possible, or has to happen, is out of reach: all nodes that
                    // it may be in are in `certain`
        kLinear,    // whatever lasts how long, it can go on so that a formula of linear time fails
        kTooLong,   // more time passes than allowed; `targets` is where that may begin
        kFires,     // of quasi_live: the transition `transition` fires
    };
    Kind kind = Kind::kUnknown;
    Target target = Target::kBroken;
    Force force = Force::kPlain;
    std::string reason;  // of kUnknown: why; else in words what was found
    std::vector<std::string> notes;
    Product product;                         // of kSuspect
    Nodes targets;                           // where to look
    Nodes certain;                           // of kHopeless
    std::shared_ptr<const LinearGame> game;  // of kLinear; else it only holds product.graph
    bool sure = false;                       // refuted also if no run is found: every run fails
    bool proves = false;                     // a run into `targets` proves the rule
    std::uint32_t transition = ~std::uint32_t{0};
    std::string subject;  // who freezes
    // Of kRefuted, if one run shows it: edges from the start, and from which of them on it goes
    // round (kFar: it does not).
    bool shown = false;
    std::vector<std::uint32_t> path;
    std::uint32_t loop_from = kFar;
};

// Needs  obligation.kind is not kFormula (check_formula.h).
// Cost   a few passes over the graph watched by the rule's monitor; memory about 20 bytes per edge
//        of that.
Finding check_on_graph(const net::Net& net, const Obligation& obligation, const GraphView& view,
                       std::uint64_t most_edges);

// What is wrong when a moment breaks a rule of this kind, in words.
const char* how_broken(net::RuleKind kind);

// How long what waits may wait, for GraphView::at_most: by place, then by transition (their
// delays). `actions` as in proof::GraphRequest.
std::vector<std::int64_t> longest_waits(const net::Net& net,
                                        const std::vector<proof::TickRange>& actions);

}  // namespace puppetri::verdict
