// SPDX-License-Identifier: MIT
#include "puppetri/sim/solved_queues.h"

#include <algorithm>
#include <cmath>

namespace puppetri::sim {
namespace {

double residual_of(const net::QueueNetwork& net, const std::vector<StationLoad>& loads) {
    const std::size_t n = net.centers.size();
    double most = 0, worst = 0, there = 0;
    for (std::size_t j = 0; j < n; ++j) {
        double comes = net.arrivals_per_s[j];
        for (std::size_t i = 0; i < n; ++i) {
            comes += loads[i].throughput * net.routing[i * n + j];
        }
        worst = std::max(worst, std::abs(comes - loads[j].throughput));
        most = std::max(most, loads[j].throughput);
        there += loads[j].customers;
    }
    const double flow = most > 0 ? worst / most : worst;
    if (!net.sources.empty()) {
        return flow;
    }
    const auto all = static_cast<double>(net.customers);
    return std::max(flow, std::abs(there - all) / std::max(1.0, all));
}

}  // namespace

std::optional<double> SolvedQueues::value(const Metric& m) const {
    if (!of_place(m.kind) && m.kind != MetricKind::kRate) {
        return std::nullopt;  // measures of the author, counts
    }
    double inside = 0, from_outside = 0;
    for (std::size_t i = 0; i < loads.size(); ++i) {
        inside += loads[i].customers;
        from_outside += network.arrivals_per_s[i];
    }
    for (const net::QueueSource& s : network.sources) {
        if (s.clock.valid() && s.clock.value == m.element && !of_transition(m.kind)) {
            return m.kind == MetricKind::kStay   ? std::optional(1 / s.rate_per_s)
                   : m.kind == MetricKind::kMost ? std::nullopt
                                                 : std::optional(1.0);
        }
    }
    if (network.inside.valid() && network.inside.value == m.element) {
        if (m.kind == MetricKind::kTokens) {
            return inside;
        }
        if (m.kind == MetricKind::kStay && from_outside > 0) {
            return inside / from_outside;
        }
    }
    for (std::size_t i = 0; i < loads.size(); ++i) {
        const net::QueueCenter& c = network.centers[i];
        const StationLoad& l = loads[i];
        const double served = l.throughput * c.mean_s;
        if (m.kind == MetricKind::kRate) {
            if (c.servers != 0 && c.start.value == m.element) {
                return l.throughput;
            }
            for (std::size_t k = 0; k < c.shares.size(); ++k) {
                if (c.ends[k].value == m.element) {
                    return l.throughput * c.shares[k];
                }
            }
            continue;
        }
        if (of_transition(m.kind)) {
            continue;
        }
        if (c.service.value == m.element) {
            if (m.kind == MetricKind::kTokens) {
                return served;
            }
            if (m.kind == MetricKind::kStay) {
                return l.throughput > 0 ? c.mean_s : 0;
            }
            if (m.kind == MetricKind::kBusy && c.servers == 1) {
                return served;
            }
        }
        if (c.queue.valid() && c.queue.value == m.element) {
            if (m.kind == MetricKind::kTokens) {
                return l.customers - served;
            }
            if (m.kind == MetricKind::kStay) {
                return l.throughput > 0 ? l.stay_s - c.mean_s : 0;
            }
        }
        if (c.free.valid() && c.free.value == m.element && m.kind == MetricKind::kTokens) {
            return c.servers - served;
        }
    }
    return std::nullopt;
}

Checked<SolvedQueues> solve_queues(const net::NetDraft& draft) {
    SolvedQueues out;
    out.network = net::find_queues(draft);
    if (!out.network.why_not.empty()) {
        Diagnostics why;
        for (const std::string& reason : out.network.why_not) {
            why.push_back({.code = "no-product-form",
                           .element = draft.name,
                           .message = reason,
                           .remedy = "ask a simulation: `puppetri sweep`"});
        }
        return Unexpected(std::move(why));
    }
    std::vector<Station> stations;
    for (const net::QueueCenter& c : out.network.centers) {
        stations.push_back(
            {.service_mean_s = c.mean_s, .servers = c.servers == 0 ? Station::kDelay : c.servers});
    }
    auto loads = out.network.sources.empty()
                     ? closed_network(stations, static_cast<std::uint32_t>(out.network.customers),
                                      out.network.routing)
                     : open_network(stations, out.network.arrivals_per_s, out.network.routing);
    if (!loads) {
        Diagnostics defects = std::move(loads.error());
        for (Diagnostic& d : defects) {  // "station 2" is one of ours
            for (std::size_t i = 0; i < stations.size(); ++i) {
                if (d.element == "station " + std::to_string(i + 1)) {
                    d.element = "station " + out.network.centers[i].name;
                    d.where = out.network.centers[i].where;
                    break;
                }
            }
        }
        return Unexpected(std::move(defects));
    }
    out.loads = std::move(*loads);
    out.residual = residual_of(out.network, out.loads);
    return out;
}

}  // namespace puppetri::sim
