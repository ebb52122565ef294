// SPDX-License-Identifier: MIT
// Questions about a graph as a whole (no instant without end, no run that stops), and about the
// durations of a net.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "builtin_rules.h"
#include "puppetri/verdict/check_graph.h"

namespace puppetri::verdict {

// Needs  a question other than kRule and kOneOfEach.
Finding check_question(Question question, const GraphView& view, std::uint64_t most_edges);

// Which faults of a run break the answer; null: none.
bool (*fault_of(Question question))(const std::string&);

// Something lasts an interval, or is drawn: exact times do not see all runs.
bool inexact_durations(const net::Net& net, const std::vector<proof::TickRange>& actions);
// Something is drawn from a distribution; intervals are all looked at.
bool draws_times(const net::Net& net);
// The graph has paths on which drawn times end at one instant, which has probability 0.
bool has_coincidences(const proof::TimedGraph& graph);

}  // namespace puppetri::verdict
