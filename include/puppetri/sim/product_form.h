// SPDX-License-Identifier: MIT
// Queueing networks whose long run is a product over their stations: Jackson's open networks and
// closed networks of one class of customers, in closed form instead of by simulation.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "puppetri/base/diagnostic.h"

namespace puppetri::sim {

// A station with first come, first served and exponential service.
struct Station {
    static constexpr std::uint32_t kDelay = 0;  // as many servers as customers
    double service_mean_s = 1;                  // above 0
    std::uint32_t servers = 1;
};

// In the long run.
struct StationLoad {
    double throughput = 0;   // customers per second
    double utilisation = 0;  // of one server, 0 .. 1; of a delay the mean number of busy ones
    double customers = 0;    // mean number, waiting or in service
    double stay_s = 0;       // mean time per visit
};

// Customers arrive at the stations at these rates from outside; from station i they go to j with
// probability routing[i * n + j], and leave with what is missing from 1.
// Fails   "wrong-routing": a row that does not sum to at most 1, or is negative; "never-leaves": a
//         customer may stay for ever; "grows-without-bound": a station's load is 1 or more, named
//         by its number.
// Source  J. R. Jackson, "Jobshop-like queueing systems", Management Science 10 (1963).
Checked<std::vector<StationLoad>> open_network(std::span<const Station> stations,
                                               std::span<const double> arrivals_per_s,
                                               std::span<const double> routing);

// So many customers go round for ever; rows of the routing sum to 1 and every station leads to
// every other.
// Fails   "wrong-routing"; "falls-apart": not every station is reached from the first and back.
// Cost    customers^2 * stations.
// Source  mean value analysis with queue-dependent servers: M. Reiser, S. S. Lavenberg,
//         "Mean-value analysis of closed multichain queuing networks", Journal of the ACM 27
//         (1980); marginal probabilities as there, equation (4.7).
Checked<std::vector<StationLoad>> closed_network(std::span<const Station> stations,
                                                 std::uint32_t customers,
                                                 std::span<const double> routing);

}  // namespace puppetri::sim
