// SPDX-License-Identifier: MIT
// The graph of classes, and the extreme times until something holds: classes with one more
// variable, minus the time since the start.
#include "puppetri/proof/state_classes.h"

#include <algorithm>
#include <map>
#include <string>

#include "class_builder.h"

namespace puppetri::proof {

using namespace net;

TimedGraph class_graph(const GraphRequest& request) {
    ClassBuilder builder(request, false);
    return builder.make();
}

namespace {

// Stops where the formula holds and remembers the times; of the shortest it drops what another
// class does not later.
class Race final : public ClassBuilder {
 public:
    Race(const GraphRequest& request, bool shortest)
        : ClassBuilder(request, true), shortest_(shortest) {}

    std::int64_t low = SimTime::never().ticks, high = 0;
    bool reached = false;

 protected:
    bool keep(Driver& driver, const Zone& zone) override {
        const std::uint32_t z = zone.variables();
        const std::int64_t least = zone.bound(z, 0);  // minus the time is at most
        const std::int64_t most = zone.bound(0, z);
        const std::int64_t at_least = -Bound::limit(least) + (Bound::strict(least) ? 1 : 0);
        may_.clear();
        must_.clear();
        atoms_.read(driver.engine, may_, must_);
        if ((may_[0] & 1) != 0) {
            reached = true;
            low = std::min(low, at_least);
            high = most == Bound::kInfinite
                       ? SimTime::never().ticks
                       : std::max(high, Bound::limit(most) - (Bound::strict(most) ? 1 : 0));
            return false;
        }
        if (!shortest_) {
            return true;
        }
        if (at_least >= low) {
            return false;
        }
        // Whatever comes later than something of an earlier one is not the shortest.
        std::vector<std::uint8_t> key;
        std::unordered_map<std::int64_t, std::uint32_t> variables;
        for (std::size_t i = 0; i < track().numbers.size(); ++i) {
            variables[track().numbers[i]] = static_cast<std::uint32_t>(i);
        }
        graph_.states->encode(driver, key, &variables);
        Zone later = zone;
        for (std::uint32_t j = 0; j < z; ++j) {
            later.set(j, z, Bound::kInfinite);
        }
        later.close();
        std::vector<std::pair<Zone, Zone>>& known = known_[key];
        for (const auto& [itself, and_later] : known) {
            if (itself == zone) {
                return true;
            }
            if (and_later.contains(zone)) {
                return false;
            }
        }
        known.emplace_back(zone, std::move(later));
        return true;
    }

 private:
    bool shortest_;
    std::map<std::vector<std::uint8_t>, std::vector<std::pair<Zone, Zone>>> known_;
    std::vector<std::uint64_t> may_, must_;
};

}  // namespace

std::optional<Extremes> extreme_times(const GraphRequest& request, const Formula& wanted) {
    const Formula atoms[] = {wanted};
    const GraphRequest one{.net = request.net,
                           .atoms = atoms,
                           .actions = request.actions,
                           .outside_events = request.outside_events,
                           .beat = request.beat,
                           .budget = request.budget};
    const TimedGraph classes = class_graph(one);
    if (!classes.available() || !classes.graph.exact || !classes.graph.over) {
        return std::nullopt;
    }
    Extremes e;
    e.ended = classes.graph.ended;
    const StateBits set = states_where_atom_may(classes.graph, 0);
    e.reachable = !set.empty();
    if (e.ended != Ended::kDone || !e.reachable) {
        return e;
    }
    e.avoidable = can_avoid(classes.graph, set);
    Race first(one, true);
    e.ended = first.make().graph.ended;
    e.shortest = first.low;
    e.longest = SimTime::never().ticks;
    if (!e.avoidable && e.ended == Ended::kDone) {
        Race last(one, false);
        e.ended = last.make().graph.ended;
        e.longest = last.high;
    }
    return e;
}

}  // namespace puppetri::proof
