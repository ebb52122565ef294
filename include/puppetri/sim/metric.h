// SPDX-License-Identifier: MIT
// What can be measured of a run of a net: one number per run and metric.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "puppetri/net/net.h"

namespace puppetri::sim {

enum class MetricKind : std::uint8_t {
    kTokens,  // mean over time of the number of tokens in a place, ready or not
    kMost,    // the largest number of tokens in a place
    kBusy,    // share of the time in which a place has a token
    kStay,    // mean time in seconds that tokens spent in a place, of those that left it; 0 of none
    kRate,    // firings of a transition per second
    kFirings  // firings of a transition
};

struct Metric {
    MetricKind kind = MetricKind::kTokens;
    std::uint32_t element = 0;  // a place, or a transition for kRate and kFirings
    bool operator==(const Metric&) const = default;
};

// "tokens", "most", "busy", "stay", "rate", "firings".
const char* name_of(MetricKind kind);
bool of_transition(MetricKind kind);
// "s", "1/s", or nothing.
const char* unit_of(MetricKind kind);

// "queue.tokens": the element's path and the kind.
std::string name_of(const net::Net& net, const Metric& metric);

// Every kind of every place and transition, in the order of the net.
std::vector<Metric> all_metrics(const net::Net& net);

}  // namespace puppetri::sim
