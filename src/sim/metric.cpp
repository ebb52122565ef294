// SPDX-License-Identifier: MIT
// Names of metrics.
#include "puppetri/sim/metric.h"

namespace puppetri::sim {

const char* name_of(MetricKind kind) {
    switch (kind) {
        case MetricKind::kTokens:
            return "tokens";
        case MetricKind::kMost:
            return "most";
        case MetricKind::kBusy:
            return "busy";
        case MetricKind::kStay:
            return "stay";
        case MetricKind::kRate:
            return "rate";
        case MetricKind::kFirings:
            return "firings";
    }
    return "";
}

bool of_transition(MetricKind kind) {
    return kind == MetricKind::kRate || kind == MetricKind::kFirings;
}

const char* unit_of(MetricKind kind) {
    switch (kind) {
        case MetricKind::kStay:
            return "s";
        case MetricKind::kRate:
            return "1/s";
        default:
            return "";
    }
}

std::string name_of(const net::Net& net, const Metric& metric) {
    const net::ElementView element =
        of_transition(metric.kind) ? net.transition({metric.element}) : net.place({metric.element});
    return std::string(element.path) + "." + name_of(metric.kind);
}

std::vector<Metric> all_metrics(const net::Net& net) {
    using enum MetricKind;
    std::vector<Metric> all;
    for (std::uint32_t p = 0; p < net.place_count(); ++p) {
        for (const MetricKind kind : {kTokens, kMost, kBusy, kStay}) {
            all.push_back({kind, p});
        }
    }
    for (std::uint32_t t = 0; t < net.transition_count(); ++t) {
        for (const MetricKind kind : {kRate, kFirings}) {
            all.push_back({kind, t});
        }
    }
    return all;
}

}  // namespace puppetri::sim
