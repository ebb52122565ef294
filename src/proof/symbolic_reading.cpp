// SPDX-License-Identifier: MIT
#include "symbolic_reading.h"

namespace puppetri::proof {

Reading::Reading(const DiagramStore& store, NodeId root, std::uint32_t levels)
    : position_(store.id_bound(), ~0u) {
    std::vector<std::vector<NodeId>> rows(levels + 1);
    position_[root] = 0;
    rows[levels].push_back(root);
    for (std::uint32_t level = levels; level >= 1; --level) {
        for (const NodeId id : rows[level]) {
            for (const DiagramEntry& e : store.entries(id)) {
                if (position_[e.child] == ~0u) {
                    position_[e.child] = 0;
                    rows[level - 1].push_back(e.child);
                }
            }
        }
    }
    for (std::uint32_t level = 0; level <= levels; ++level) {
        starts_.push_back(static_cast<std::uint32_t>(nodes_.size()));
        for (const NodeId id : rows[level]) {
            position_[id] = static_cast<std::uint32_t>(nodes_.size());
            nodes_.push_back(id);
        }
    }
    starts_.push_back(static_cast<std::uint32_t>(nodes_.size()));
}

}  // namespace puppetri::proof
