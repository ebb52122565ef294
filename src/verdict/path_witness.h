// SPDX-License-Identifier: MIT
// From a path of an exact graph to a run that the player plays.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "puppetri/proof/timed_graph.h"
#include "puppetri/verdict/check_graph.h"
#include "puppetri/verdict/pursue.h"
#include "puppetri/verdict/witness.h"

namespace puppetri::verdict {

// A step of the finding's path needs drawn times to end at one instant.
bool by_coincidence(const proof::TimedGraph& graph, const Finding& finding);

// The finding's path, played; `rule` is left open. Nothing, and why: the player does not go it.
// Needs  a graph of the theatre's whole net.
std::optional<Witness> witness_of_path(const Theatre& theatre, const proof::TimedGraph& graph,
                                       const Finding& finding, std::string& trouble);

// How many firings the first `to` edges of a path have.
std::uint32_t firings_along(const proof::Graph& graph, const std::vector<std::uint32_t>& path,
                            std::size_t to);

}  // namespace puppetri::verdict
