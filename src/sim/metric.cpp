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
        case MetricKind::kMeasure:
            return "measure";
    }
    return "";
}

bool of_transition(MetricKind kind) {
    return kind == MetricKind::kRate || kind == MetricKind::kFirings;
}

bool of_place(MetricKind kind) { return !of_transition(kind) && kind != MetricKind::kMeasure; }

const char* unit_of(const net::Net& net, const Metric& metric) {
    switch (metric.kind) {
        case MetricKind::kStay:
            return "s";
        case MetricKind::kRate:
            return "1/s";
        case MetricKind::kMeasure:
            return net::unit_of(net.declarations().measures[metric.element]);
        default:
            return "";
    }
}

std::string name_of(const net::Net& net, const Metric& metric) {
    if (metric.kind == MetricKind::kMeasure) {
        return net.declarations().measures[metric.element].path;
    }
    const net::ElementView element =
        of_transition(metric.kind) ? net.transition({metric.element}) : net.place({metric.element});
    return std::string(element.path) + "." + name_of(metric.kind);
}

std::string caption_of(const net::Net& net, const Metric& metric) {
    return metric.kind == MetricKind::kMeasure ? net.declarations().measures[metric.element].caption
                                               : std::string();
}

std::vector<Metric> declared_metrics(const net::Net& net) {
    std::vector<Metric> all;
    for (std::uint32_t m = 0; m < net.declarations().measures.size(); ++m) {
        all.push_back({MetricKind::kMeasure, m});
    }
    return all;
}

std::vector<Metric> all_metrics(const net::Net& net) {
    using enum MetricKind;
    std::vector<Metric> all = declared_metrics(net);
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
