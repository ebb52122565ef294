// SPDX-License-Identifier: MIT
// Short looks at a sweep's nets before it begins: how long they take to settle, and into how many
// batches a run may be cut.
#pragma once
#include <cstdint>
#include <vector>

#include "puppetri/base/diagnostic.h"
#include "puppetri/sim/batches.h"

namespace puppetri::cli {

struct PilotPoint {
    const net::Net* net = nullptr;
    const std::vector<sim::Metric>* metrics = nullptr;
    sim::NetExperiment::Options options;
};

// The longest warm-up that any point needs.
// Fails   "not-settled": some run has not settled in its first half; a run that cannot be played.
Checked<SimTime> find_warm_up(const std::vector<PilotPoint>& points, std::uint64_t seed,
                              SimTime until);

// The least number of batches that any point allows, at most 256.
// Fails   "batches-depend": even 16 of them do; a run that cannot be played.
Checked<std::uint32_t> find_batches(const std::vector<PilotPoint>& points, std::uint64_t seed,
                                    SimTime warm_up, SimTime until);

}  // namespace puppetri::cli
