// SPDX-License-Identifier: MIT
#include "path_witness.h"

#include <algorithm>

namespace puppetri::verdict {
namespace {

// Some rounds of the loop; after how many firings each ends.
void go_round(const proof::Graph& graph, std::uint32_t loop_from, std::vector<std::uint32_t>& path,
              std::vector<std::uint32_t>& rounds) {
    constexpr std::size_t kRounds = 8, kLongest = 4000;
    const std::vector<std::uint32_t> loop(path.begin() + loop_from, path.end());
    for (std::size_t i = 0; i < kRounds && path.size() + loop.size() < kLongest; ++i) {
        rounds.push_back(firings_along(graph, path, path.size()));
        path.insert(path.end(), loop.begin(), loop.end());
    }
    rounds.push_back(firings_along(graph, path, path.size()));
}

}  // namespace

std::uint32_t firings_along(const proof::Graph& graph, const std::vector<std::uint32_t>& path,
                            std::size_t to) {
    std::uint32_t firings = 0;
    for (std::size_t i = 0; i < to && i < path.size(); ++i) {
        firings += (graph.edges.items[path[i]].label & proof::Edge::kEvent) == 0 ? 1 : 0;
    }
    return firings;
}

bool by_coincidence(const proof::TimedGraph& graph, const Finding& f) {
    return std::any_of(f.path.begin(), f.path.end(), [&](std::uint32_t e) {
        return e < graph.coincidental.size() && graph.coincidental[e] != 0;
    });
}

std::optional<Witness> witness_of_path(const Theatre& theatre, const proof::TimedGraph& graph,
                                       const Finding& f, std::string& trouble) {
    // Events of the outside are no reason for an instant to last for ever, and the stage need not
    // do the same again.
    const bool doubt =
        f.loop_from != kFar &&
        (theatre.auto_durations ||
         std::any_of(f.path.begin() + f.loop_from, f.path.end(), [&](std::uint32_t e) {
             return graph.waits.is_rare(graph.graph.edges.items[e]);
         }));
    std::vector<std::uint32_t> path = f.path, rounds;
    if (doubt) {
        go_round(graph.graph, f.loop_from, path, rounds);
    }
    const auto script = graph.script(path, &trouble);
    auto witness = script ? witness_of(theatre, *script, &trouble, rounds) : std::nullopt;
    if (!witness) {
        return std::nullopt;
    }
    witness->says = f.reason;
    if (doubt) {
        witness->violates_after = Witness::kNone;
    } else if (f.loop_from != kFar) {
        witness->lasso_from = firings_along(graph.graph, f.path, f.loop_from);
    } else {
        witness->violates_after = static_cast<std::uint32_t>(witness->steps.size());
    }
    return witness;
}

}  // namespace puppetri::verdict
