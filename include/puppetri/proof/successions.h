// SPDX-License-Identifier: MIT
// Which activities can follow each other, over all paths of a graph. Firings begin activities, each
// on some lanes (the limbs of a figure, a machine); on a lane the next one that begins follows the
// last one that began, however long nothing went on between them.
#pragma once
#include <cstdint>
#include <vector>

#include "puppetri/net/net.h"
#include "puppetri/proof/graph.h"

namespace puppetri::proof {

// Activity number `item` of a lane begins.
struct Begin {
    std::uint32_t lane = 0, item = 0;
};

struct SuccessionRequest {
    const Graph& graph;
    const net::Rows<Begin>& begins;  // per transition of the graph's net
    // Per lane: how many activities it has. One more stands for the time before the first.
    const std::vector<std::uint32_t>& items;
    const std::vector<Begin>& initially;  // what goes on in the initial state
};

// On `lane` the firing of `by` begins `after` when `before` was the last that began there;
// before == items[lane]: nothing had begun yet.
struct Succession {
    std::uint32_t lane = 0, before = 0, by = 0, after = 0;
    auto operator<=>(const Succession&) const = default;
};

// Gives  every succession of every path, in ascending order. A firing that begins several
//        activities on one lane may have begun them in any order.
// Cost   a few passes over the edges; a bit per state and activity.
std::vector<Succession> successions(const SuccessionRequest& request);
// What it will hold.
std::uint64_t bytes_for_successions(const SuccessionRequest& request);

}  // namespace puppetri::proof
