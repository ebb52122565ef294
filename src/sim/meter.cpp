// SPDX-License-Identifier: MIT
// Integrals over time, kept place by place and only when the place changes; what is seen now and
// then is in seen.cpp.
#include "puppetri/sim/meter.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "puppetri/base/require.h"
#include "puppetri/net/tables.h"

namespace puppetri::sim {

namespace {

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

}  // namespace

void Meter::Arrivals::push(std::int64_t at) {
    if (size == ring.size()) {
        std::vector<std::int64_t> larger(std::max<std::size_t>(4, 2 * ring.size()));
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
    : net_(&net),
      metrics_(metrics.begin(), metrics.end()),
      warm_up_(options.from.ticks),
      from_(options.from.ticks) {
    number_.assign(net.place_count(), net::kNoIndex);
    turns_.resize(net.transition_count());
    turns_inside_.resize(net.transition_count());
    for (const Metric& m : metrics_) {
        if (m.kind == MetricKind::kMeasure) {
            PUP_REQUIRE(m.element < net.declarations().measures.size());
            add_measure(m.element);
        } else if (of_transition(m.kind)) {
            PUP_REQUIRE(m.element < net.transition_count());
            slots_.push_back(m.element);
        } else {
            PUP_REQUIRE(m.element < net.place_count());
            slots_.push_back(place_number(m.element));
            places_[slots_.back()].stays |= m.kind == MetricKind::kStay;
        }
    }
    lay_out_arcs();
    lay_out_watched();
    firings_.assign(net.transition_count(), 0);
}

std::uint32_t Meter::place_number(std::uint32_t place) {
    if (number_[place] == net::kNoIndex) {
        number_[place] = static_cast<std::uint32_t>(places_.size());
        places_.push_back({.place = {place}});
    }
    return number_[place];
}

void Meter::lay_out_arcs() {
    const net::NetTables& tables = net_->tables();
    for (std::uint32_t t = 0; t < net_->transition_count(); ++t) {
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
}

void Meter::prepare() {
    fault_.reset();
    serials_ = 0;
    for (Place& place : places_) {
        place.arrivals.first = place.arrivals.size = 0;
        place.waiting.clear();
        place.fresh.clear();
        place.tokens = 0;
    }
    for (Passage& passage : passages_) {
        passage.begun.first = passage.begun.size = 0;
        passage.begun_by_key.clear();
    }
    forget(warm_up_);
}

// What has been counted, not what is there.
void Meter::forget(std::int64_t from) {
    from_ = from;
    std::fill(firings_.begin(), firings_.end(), 0);
    for (Place& place : places_) {
        place.most = place.tokens;
        place.since = from;
        place.token_ticks = place.busy_ticks = place.stay_ticks = 0;
        place.left = 0;
    }
    for (Watched& w : watched_) {
        w.most = w.least = w.value;
        w.sum = 0;
        w.since = from;
    }
    for (Seen& s : seen_) {
        s.forget();
    }
}

void Meter::begins(const run::Player& player) {
    PUP_REQUIRE(player.firings() == 0);
    if (!followed_.empty()) {
        coupled_.assign(player.coupled().begin(), player.coupled().end());
    }
    for (Place& place : places_) {
        place.tokens = place.most = player.tokens(place.place);
        const bool in_order =
            place.stays || (!place.seen.empty() && place.leaving == Leaving::kInOrder);
        for (std::uint32_t i = 0; in_order && i < place.tokens; ++i) {
            place.arrivals.push(0);
        }
        leave_by_readiness(place, 0, 0);
    }
    for (Watched& w : watched_) {
        watch(w, player);
        w.most = w.least = w.value;
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
        if (!place.stays && place.seen.empty()) {
            continue;
        }
        const std::uint32_t leave = arc.takes_all ? before + arc.gives - place.tokens : arc.takes;
        if (place.stays || place.leaving == Leaving::kInOrder) {
            for (std::uint32_t i = 0; i < leave; ++i) {
                const std::int64_t arrived = place.arrivals.pop();
                place.stay_ticks += counts ? static_cast<double>(now - arrived) : 0;
                if (place.leaving == Leaving::kInOrder) {
                    stayed(place, now, arrived);
                }
            }
            place.left += counts ? leave : 0;
            for (std::uint32_t i = 0; i < arc.gives; ++i) {
                place.arrivals.push(now);
            }
        }
        if (place.leaving == Leaving::kByReadiness) {
            leave_by_readiness(place, leave, now);
        }
    }
    if (!turns_[t].empty()) {
        for (const Turn& each : turns_[t]) {
            turn(each, now, 0);
        }
    }
    if (!watched_.empty()) {
        for (const std::uint32_t i : watched_at_.row(t)) {
            watch(watched_[i], player);
        }
        for (const std::uint32_t i : watched_always_) {
            watch(watched_[i], player);
        }
    }
}

void Meter::passed(const run::Player& player) {
    for (const std::uint32_t i : watched_always_) {
        watch(watched_[i], player);
    }
}

void Meter::finish(SimTime end, std::span<double> values) {
    PUP_REQUIRE(values.size() == metrics_.size());
    const double passed = end.ticks > from_ ? static_cast<double>(end.ticks - from_) : 0;
    const auto per_time = [&](double sum) { return passed > 0 ? sum / passed : 0; };
    for (Place& place : places_) {
        integrate(place, end.ticks);
    }
    for (Watched& w : watched_) {
        if (end.ticks > w.since) {
            w.sum += w.value * static_cast<double>(end.ticks - w.since);
            w.since = end.ticks;
        }
    }
    for (std::size_t i = 0; i < metrics_.size(); ++i) {
        const std::uint32_t slot = slots_[i];
        switch (metrics_[i].kind) {
            case MetricKind::kTokens:
                values[i] = per_time(places_[slot].token_ticks);
                break;
            case MetricKind::kBusy:
                values[i] = per_time(places_[slot].busy_ticks);
                break;
            case MetricKind::kMost:
                values[i] = passed > 0 ? places_[slot].most : 0;
                break;
            case MetricKind::kStay:
                values[i] = places_[slot].left == 0 ? kNothing
                                                    : places_[slot].stay_ticks /
                                                          static_cast<double>(places_[slot].left) /
                                                          static_cast<double>(kTicksPerSecond);
                break;
            case MetricKind::kFirings:
                values[i] = static_cast<double>(firings_[slot]);
                break;
            case MetricKind::kRate:
                values[i] = per_time(static_cast<double>(firings_[slot])) * kTicksPerSecond;
                break;
            case MetricKind::kMeasure:
                values[i] = measured(metrics_[i].element, slot, passed);
                break;
        }
    }
    follow(end, values);
    forget(end.ticks);
}

}  // namespace puppetri::sim
