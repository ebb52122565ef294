// SPDX-License-Identifier: MIT
// What a SymbolicSpace holds.
#pragma once
#include <memory>
#include <optional>

#include "puppetri/proof/symbolic.h"
#include "saturation.h"
#include "symbolic_levels.h"
#include "symbolic_store.h"

namespace puppetri::proof {

struct SymbolicTables {
    PlainNet net;
    Budget budget;
    Ended ended = Ended::kDone;  // of the exploration
    bool supported = true;
    bool explored = false;  // the three below exist, all is right
    std::unique_ptr<SymbolicLevels> levels;
    std::unique_ptr<DiagramStore> store;
    std::unique_ptr<Saturation> saturation;
    NodeId all = DiagramStore::kEmpty, initial = DiagramStore::kEmpty;
    std::uint64_t peak_bytes = 0;

    bool usable() const { return explored && !store->failed(); }
    void explore();
    bool try_order(const PlaceGroups& order, std::uint64_t work, double seconds);
    NodeId node_of(std::span<const std::uint32_t> marking);  // kEmpty: not reachable for sure
};

}  // namespace puppetri::proof
