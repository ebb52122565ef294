// SPDX-License-Identifier: MIT
// The nodes of one set, children before parents, for what is computed by one pass from the bottom
// up.
#pragma once
#include <cstdint>
#include <vector>

#include "symbolic_store.h"

namespace puppetri::proof {

class Reading {
 public:
    // Needs  root is not the empty set.
    Reading(const DiagramStore& store, NodeId root, std::uint32_t levels);

    std::uint32_t size() const { return static_cast<std::uint32_t>(nodes_.size()); }
    NodeId node(std::uint32_t position) const { return nodes_[position]; }  // 0 is kTop
    std::uint32_t root() const { return size() - 1; }
    std::uint32_t position_of(NodeId node) const { return position_[node]; }
    // Positions of the nodes of a level: [begin, end).
    std::uint32_t begin_of(std::uint32_t level) const { return starts_[level]; }
    std::uint32_t end_of(std::uint32_t level) const { return starts_[level + 1]; }

 private:
    std::vector<NodeId> nodes_;
    std::vector<std::uint32_t> position_;  // by id
    std::vector<std::uint32_t> starts_;
};

}  // namespace puppetri::proof
