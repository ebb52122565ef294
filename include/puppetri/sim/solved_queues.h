// SPDX-License-Identifier: MIT
// The long run of a queueing network within a net, by its product form where it has one.
#pragma once
#include <optional>
#include <vector>

#include "puppetri/net/queueing.h"
#include "puppetri/sim/metric.h"
#include "puppetri/sim/product_form.h"

namespace puppetri::sim {

struct SolvedQueues {
    net::QueueNetwork network;
    std::vector<StationLoad> loads;  // by center
    // How well the loads satisfy the traffic equations, as a share of the largest flow; of closed
    // networks also how far the mean numbers of customers are from summing to all of them.
    double residual = 0;

    // Null for what the product form does not tell: largest numbers, the share of the time in
    // which several servers have something to do.
    std::optional<double> value(const Metric& metric) const;
};

// Fails   "no-product-form" with the reasons; and as open_network and closed_network do
//         ("grows-without-bound" names the station).
Checked<SolvedQueues> solve_queues(const net::NetDraft& draft);

}  // namespace puppetri::sim
