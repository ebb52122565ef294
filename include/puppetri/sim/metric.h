// SPDX-License-Identifier: MIT
// What can be measured of a run of a net: one number per run and metric.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "puppetri/net/net.h"

namespace puppetri::sim {

enum class MetricKind : std::uint8_t {
    kTokens,   // mean over time of the number of tokens in a place, ready or not
    kMost,     // the largest number of tokens in a place
    kBusy,     // share of the time in which a place has a token
    kStay,     // mean time in seconds that tokens spent in a place, of those that left it
    kRate,     // firings of a transition per second
    kFirings,  // firings of a transition
    kMeasure   // a measure that the net declares
};

struct Metric {
    MetricKind kind = MetricKind::kTokens;
    // A place; a transition for kRate and kFirings; for kMeasure a number in the net's list.
    std::uint32_t element = 0;
    bool operator==(const Metric&) const = default;
};

// "tokens", "most", "busy", "stay", "rate", "firings", "measure".
const char* name_of(MetricKind kind);
bool of_transition(MetricKind kind);
bool of_place(MetricKind kind);
// "s", "1/s", or nothing.
const char* unit_of(const net::Net& net, const Metric& metric);

// "queue.tokens": the element's path and the kind; of a measure its own path.
std::string name_of(const net::Net& net, const Metric& metric);
// What people read instead; empty where there is nothing to say.
std::string caption_of(const net::Net& net, const Metric& metric);

// The measures that the net declares, in its order.
std::vector<Metric> declared_metrics(const net::Net& net);
// These, and every kind of every place and transition.
std::vector<Metric> all_metrics(const net::Net& net);

}  // namespace puppetri::sim
