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
    Race(const GraphRequest& request, const MomentTest& wanted, bool shortest)
        : ClassBuilder(request, true), wanted_(wanted), shortest_(shortest) {}

    std::int64_t low = SimTime::never().ticks, high = 0;
    bool reached = false;

    // Where the extreme time is reached, in the graph that was made.
    std::optional<std::uint32_t> best(const TimedGraph& made) {
        for (std::uint32_t s = 0; s < made.graph.size(); ++s) {
            if (made.states->store[s].back() != kMark) {
                continue;
            }
            enter(s);
            const std::uint32_t z = zone_.variables();
            const std::int64_t bound = shortest_ ? zone_.bound(z, 0) : zone_.bound(0, z);
            const std::int64_t at = shortest_ ? -Bound::limit(bound) : Bound::limit(bound);
            if (bound != Bound::kInfinite && !Bound::strict(bound) &&
                at == (shortest_ ? low : high)) {
                return s;
            }
        }
        return std::nullopt;
    }

 protected:
    bool ends() const override { return mark_; }
    bool keep(Driver& driver, const Driver::Step& step, Zone& zone) override {
        const std::uint32_t z = zone.variables();
        const std::int64_t least = zone.bound(z, 0);  // minus the time is at most
        const std::int64_t most = zone.bound(0, z);
        const std::int64_t at_least = -Bound::limit(least) + (Bound::strict(least) ? 1 : 0);
        may_.clear();
        must_.clear();
        mark_ = false;
        atoms_.read(driver.engine, may_, must_);
        if (wanted_.may_hold(wanted_.statement, may_.data(), must_.data(), step.label)) {
            reached = true;
            low = std::min(low, at_least);
            high = most == Bound::kInfinite
                       ? SimTime::never().ticks
                       : std::max(high, Bound::limit(most) - (Bound::strict(most) ? 1 : 0));
            mark_ = true;
            return true;
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
    const MomentTest wanted_;
    const bool shortest_;
    std::map<std::vector<std::uint8_t>, std::vector<std::pair<Zone, Zone>>> known_;
    std::vector<std::uint64_t> may_, must_;
};

}  // namespace

namespace {

// The last variable counts from the last visit; states before the first one have no mark.
class Laps final : public ClassBuilder {
 public:
    Laps(const GraphRequest& request, const MomentTest& visited)
        : ClassBuilder(request, true), visited_(visited) {}

    LapTimes times;

 protected:
    void enter(std::uint32_t state) override {
        ClassBuilder::enter(state);
        begun_ = graph_.states->store[state].back() == kMark;
        const AtomBits& bits = graph_.graph.atoms;
        const std::size_t row = std::size_t{state} * ((bits.atoms + 63) / 64);
        before_ = visited_.may_hold(visited_.statement, bits.may.data() + row,
                                    bits.must.data() + row, Edge::kPass);
    }
    bool keep(Driver& driver, const Driver::Step& step, Zone& zone) override {
        may_.clear();
        must_.clear();
        atoms_.read(driver.engine, may_, must_);
        const bool visit = !before_ && visited_.may_hold(visited_.statement, may_.data(),
                                                         must_.data(), step.label);
        mark_ = begun_ || visit;
        if (!visit) {
            return true;
        }
        const std::uint32_t z = zone.variables();
        if (begun_) {
            const std::int64_t least = zone.bound(z, 0), most = zone.bound(0, z);
            times.any = true;
            times.least = std::min(times.least, -Bound::limit(least));
            times.greatest = most == Bound::kInfinite
                                 ? SimTime::never().ticks
                                 : std::max(times.greatest, Bound::limit(most));
        }
        for (std::uint32_t j = 0; j < z; ++j) {
            zone.set(z, j, zone.bound(0, j));
            zone.set(j, z, zone.bound(j, 0));
        }
        return true;
    }

 private:
    const MomentTest visited_;
    bool before_ = true, begun_ = false;
    std::vector<std::uint64_t> may_, must_;
};

}  // namespace

std::optional<LapTimes> lap_times(const GraphRequest& request, const MomentTest& visited) {
    Laps laps(request, visited);
    const TimedGraph classes = laps.make();
    if (!classes.available() || !classes.graph.over || classes.graph.ended != Ended::kDone) {
        return std::nullopt;
    }
    return laps.times;
}

std::optional<ExtremeTime> extreme_time(const GraphRequest& request, const MomentTest& wanted,
                                        bool quickest) {
    Race race(request, wanted, quickest);
    const TimedGraph classes = race.make();
    if (!classes.available() || !classes.graph.exact || !classes.graph.over) {
        return std::nullopt;
    }
    ExtremeTime out{.ended = classes.graph.ended,
                    .reached = race.reached,
                    .ticks = quickest ? race.low : race.high,
                    .run = std::nullopt};
    if (const auto state = out.reached ? race.best(classes) : std::nullopt) {
        const auto path = classes.path_to(*state);
        out.run = classes.script(path, nullptr,
                                 quickest ? TimedGraph::Pace::kSoonest : TimedGraph::Pace::kLatest);
    }
    return out;
}

}  // namespace puppetri::proof
