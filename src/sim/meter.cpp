// SPDX-License-Identifier: MIT
// Integrals over time, kept place by place and only when the place changes.
#include "puppetri/sim/meter.h"

#include <algorithm>
#include <map>

#include "puppetri/base/require.h"
#include "puppetri/net/tables.h"

namespace puppetri::sim {

void Meter::Arrivals::push(std::int64_t at) {
    if (size == ring.size()) {
        std::vector<std::int64_t> larger(std::max<std::size_t>(16, 2 * ring.size()));
        for (std::uint32_t i = 0; i < size; ++i) {
            larger[i] = ring[(first + i) & (ring.size() - 1)];
        }
        ring = std::move(larger);
        first = 0;
    }
    ring[(first + size++) & (ring.size() - 1)] = at;
}

std::int64_t Meter::Arrivals::pop() {
    const std::int64_t at = ring[first];
    first = (first + 1) & static_cast<std::uint32_t>(ring.size() - 1);
    --size;
    return at;
}

Meter::Meter(const net::Net& net, std::span<const Metric> metrics, const Options& options)
    : net_(&net), metrics_(metrics.begin(), metrics.end()), from_(options.from.ticks) {
    number_.assign(net.place_count(), net::kNoIndex);
    for (const Metric& m : metrics_) {
        if (of_transition(m.kind)) {
            PUP_REQUIRE(m.element < net.transition_count());

            continue;
        }
        PUP_REQUIRE(m.element < net.place_count());
        if (number_[m.element] == net::kNoIndex) {
            number_[m.element] = static_cast<std::uint32_t>(places_.size());
            places_.push_back({.place = {m.element}});
        }
        places_[number_[m.element]].stays |= m.kind == MetricKind::kStay;
    }
    const net::NetTables& tables = net.tables();
    for (std::uint32_t t = 0; t < net.transition_count(); ++t) {
        std::map<std::uint32_t, Arc> row;
        const auto arc_of = [&](std::uint32_t place) {
            Arc* arc = nullptr;
            if (number_[place] != net::kNoIndex) {
                arc = &row[number_[place]];
                arc->place = number_[place];
            }
            return arc;
        };
        for (const net::Weighted& w : tables.takes(t)) {
            if (Arc* arc = arc_of(w.place)) {
                arc->takes += w.weight;
            }
        }
        for (const net::Weighted& w : tables.gives(t)) {
            if (Arc* arc = arc_of(w.place)) {
                arc->gives += w.weight;
            }
        }
        if (tables.transition[t].special != net::kNoIndex) {
            const net::Special& special = tables.specials[tables.transition[t].special];
            for (const net::ArcTable& a : special.arcs) {
                const bool all =
                    a.kind == net::ArcKind::kTakeAll || a.kind == net::ArcKind::kTakeAllNow;
                const bool some = a.kind == net::ArcKind::kTake || a.kind == net::ArcKind::kTakeNow;
                Arc* arc = all || some ? arc_of(a.place) : nullptr;
                if (arc != nullptr) {
                    arc->takes += some ? a.weight : 0;
                    arc->takes_all |= all;
                }
            }
            for (const net::OutputTable& o : special.outputs) {
                if (Arc* arc = arc_of(o.place)) {
                    arc->gives += o.weight;
                }
            }
        }
        for (const auto& [place, arc] : row) {
            arcs_.items.push_back(arc);
        }
        arcs_.starts.push_back(static_cast<std::uint32_t>(arcs_.items.size()));
    }
    firings_.assign(net.transition_count(), 0);
}

void Meter::begin(const run::Player& player) {
    PUP_REQUIRE(player.firings() == 0);
    std::fill(firings_.begin(), firings_.end(), 0);
    for (Place& place : places_) {
        place.tokens = place.most = player.tokens(place.place);
        place.since = from_;
        place.token_ticks = place.busy_ticks = place.stay_ticks = 0;
        place.left = 0;
        place.arrivals.first = place.arrivals.size = 0;
        for (std::uint32_t i = 0; place.stays && i < place.tokens; ++i) {
            place.arrivals.push(0);
        }
    }
}

void Meter::integrate(Place& place, std::int64_t now) const {
    if (now > place.since) {
        const auto passed = static_cast<double>(now - place.since);
        place.token_ticks += passed * place.tokens;
        place.busy_ticks += place.tokens != 0 ? passed : 0;
        place.since = now;
    }
}

void Meter::fired(const run::Player& player) {
    const std::int64_t now = player.now().ticks;
    const std::uint32_t t = player.last().value;
    const bool counts = now >= from_;
    firings_[t] += counts;
    for (const Arc& arc : arcs_.row(t)) {
        Place& place = places_[arc.place];
        integrate(place, now);
        const std::uint32_t before = place.tokens;
        place.tokens = player.tokens(place.place);
        if (!counts) {
            place.most = place.tokens;
        }
        place.most = std::max(place.most, place.tokens);
        if (place.stays) {
            const std::uint32_t leave =
                arc.takes_all ? before + arc.gives - place.tokens : arc.takes;
            for (std::uint32_t i = 0; i < leave; ++i) {
                const std::int64_t arrived = place.arrivals.pop();
                place.stay_ticks += counts ? static_cast<double>(now - arrived) : 0;
            }
            place.left += counts ? leave : 0;
            for (std::uint32_t i = 0; i < arc.gives; ++i) {
                place.arrivals.push(now);
            }
        }
    }
}

void Meter::finish(SimTime end, std::span<double> values) {
    PUP_REQUIRE(values.size() == metrics_.size());
    const double passed = end.ticks > from_ ? static_cast<double>(end.ticks - from_) : 0;
    const auto per_time = [&](double sum) { return passed > 0 ? sum / passed : 0; };
    for (Place& place : places_) {
        integrate(place, end.ticks);
    }
    for (std::size_t i = 0; i < metrics_.size(); ++i) {
        const Metric& m = metrics_[i];
        if (of_transition(m.kind)) {
            const auto count = static_cast<double>(firings_[m.element]);
            values[i] = m.kind == MetricKind::kFirings ? count : per_time(count) * kTicksPerSecond;
            continue;
        }
        const Place& place = places_[number_[m.element]];
        switch (m.kind) {
            case MetricKind::kTokens:
                values[i] = per_time(place.token_ticks);
                break;
            case MetricKind::kBusy:
                values[i] = per_time(place.busy_ticks);
                break;
            case MetricKind::kMost:
                values[i] = passed > 0 ? place.most : 0;
                break;
            default:
                values[i] = place.left == 0 ? 0
                                            : place.stay_ticks / static_cast<double>(place.left) /
                                                  static_cast<double>(kTicksPerSecond);
        }
    }
}

}  // namespace puppetri::sim
