// SPDX-License-Identifier: MIT
// Hand-written minimal loops for the same models: no net, no places, the structure of the model in
// the code, but the same random streams, the same law of ties and the same log hash, so that a loop
// that does less work than the model asks for is found out. They are the floor that the engine is
// compared with.
#pragma once
#include <cstdint>

namespace puppetri::bench {

// The log hash after so many firings.
std::uint64_t philosophers_floor(std::uint32_t n, std::uint64_t seed, std::uint64_t firings);
std::uint64_t hold_floor(std::uint32_t n, std::uint64_t seed, std::uint64_t firings);
std::uint64_t mm1_floor(std::uint64_t seed, std::uint64_t firings);
// The same, keeping each customer's number and arrival.
struct QueueSums {
    std::uint64_t log_hash = 0;
    double mean_length = 0, mean_stay_s = 0, longest_stay_s = 0;
};
QueueSums mm1_customers_floor(std::uint64_t seed, std::uint64_t firings);

}  // namespace puppetri::bench
