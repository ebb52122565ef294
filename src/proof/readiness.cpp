// SPDX-License-Identifier: MIT
// The engine keeps no time; of what waits in a settled instant any non-empty set is over next.
// Tokens without identity count, tokens that all last equally long are over in the order of their
// arrival.
#include "puppetri/proof/readiness.h"

#include <algorithm>

#include "plain_readiness.h"
#include "puppetri/net/tables.h"
#include "timed_builder.h"

namespace puppetri::proof {

using namespace net;

namespace {

class ReadinessBuilder final : public TimedBuilder {
 public:
    explicit ReadinessBuilder(const GraphRequest& request)
        : TimedBuilder(request, ClockForm::kReadiness, "readiness graph") {
        for (std::string& what : misused_time_left(request.net)) {
            graph_.why_not.push_back(std::move(what));
        }
        const NetTables& n = request.net.tables();
        in_order_.assign(n.places.size(), 0);
        for (std::uint32_t p = 0; p < n.places.size(); ++p) {
            const bool rich = !n.place_rich.empty() && n.place_rich[p] != kNoIndex;
            const std::uint32_t d = n.place[p].duration;
            const Discipline discipline =
                rich ? n.rich[n.place_rich[p]].discipline : Discipline::kOldest;
            // Strings keep the order of arrival except by key.
            const bool seen =
                rich && discipline != Discipline::kLeast && discipline != Discipline::kMost;
            const bool constant = d != kNoIndex && n.durations[d].kind == DurationKind::kConstant;
            in_order_[p] = seen && (constant || n.rich[n.place_rich[p]].keeps_order) ? 1 : 0;
        }
        for (const Special& s : n.specials) {
            for (const OutputTable& out : s.outputs) {
                if (out.lasts.valid() && out.rich != kNoIndex && !n.rich[out.rich].keeps_order) {
                    in_order_[out.place] = 0;
                }
            }
        }
        places_ = n.places.size();
        transitions_ = n.transitions.size();
        graph_.waits.kinds = places_ + transitions_ + n.events.size();
        driver_->choose_with(
            [](void* self, Driver& driver, std::vector<std::int64_t>& over) {
                return static_cast<ReadinessBuilder*>(self)->choose(driver, over);
            },
            this);
    }

    TimedGraph make() {
        if (!graph_.available()) {
            return std::move(graph_);
        }
        const World& world = graph_.states->world;
        const NetTables& n = request_.net.tables();
        for (std::uint32_t p = 0; p < n.places.size(); ++p) {
            if (n.place[p].duration != kNoIndex &&
                n.durations[n.place[p].duration].kind != DurationKind::kOpen) {
                graph_.not_exact.push_back("place " + std::string(n.places.path(p)) +
                                           " has a duration");
            }
        }
        for (const Special& s : n.specials) {
            for (const OutputTable& out : s.outputs) {
                if (out.lasts.valid()) {
                    graph_.not_exact.push_back("transition " +
                                               std::string(n.transitions.path(s.transition)) +
                                               " gives a token with a duration of its own");
                }
            }
        }
        for (const DelayTable& d : n.delays) {
            graph_.not_exact.push_back(
                "transition " + std::string(n.transitions.path(d.transition)) + " has a delay");
        }
        for (const ScheduledEvent& s : n.declarations.schedule) {
            if (s.at.ticks != 0 || s.every) {
                graph_.not_exact.push_back("event " + std::string(n.events.path(s.event.value)) +
                                           " comes at a certain time");
            }
        }
        for (const std::uint32_t e : world.movement_events) {
            graph_.not_exact.push_back("event " + std::string(n.events.path(e)) +
                                       " is raised by a movement");
        }
        if (world.free_sensors.size() > 6) {
            graph_.not_over.emplace_back("more than six sensors change at one instant");
        }
        graph_.assumptions = assumed(world);
        graph_.graph.over = graph_.not_over.empty();
        graph_.graph.exact = graph_.not_exact.empty();
        TimedGraph made = build();
        made.graph.low_ticks.clear();
        made.graph.high_ticks.clear();
        return made;
    }

 private:
    std::uint32_t kind_of(const Waiting& w) const {
        return w.kind == Waiting::kSchedule ? places_ + transitions_ + w.element
               : w.kind == Waiting::kDelay  ? places_ + w.element
                                            : w.element;
    }

    bool choose(Driver& driver, std::vector<std::int64_t>& over) {
        // Groups of which the first k are over: tokens of one place that nothing tells apart or
        // that are over in order; everything else alone.
        collect_waiting(request_.net, driver.engine.state(), waiting_);
        std::erase_if(waiting_, [](const Waiting& w) { return !w.ends(); });
        for (std::size_t i = 0; i < waiting_.size();) {  // by arrival within each place
            std::size_t end = i + 1;
            while (end < waiting_.size() && waiting_[end].kind == waiting_[i].kind &&
                   waiting_[end].element == waiting_[i].element) {
                ++end;
            }
            std::sort(waiting_.begin() + static_cast<std::ptrdiff_t>(i),
                      waiting_.begin() + static_cast<std::ptrdiff_t>(end),
                      [](const Waiting& x, const Waiting& y) {
                          return x.serial != y.serial ? x.serial < y.serial : x.number < y.number;
                      });
            i = end;
        }
        std::size_t groups = 0;
        const auto end_of = [&](std::size_t i) {
            const Waiting& w = waiting_[i];
            std::size_t end = i + 1;
            if (w.kind == Waiting::kPlace ||
                (w.kind == Waiting::kRecord && in_order_[w.element] != 0)) {
                while (end < waiting_.size() && waiting_[end].kind == w.kind &&
                       waiting_[end].element == w.element) {
                    ++end;
                }
            }
            return end;
        };
        for (std::size_t i = 0; i < waiting_.size(); i = end_of(i)) {
            ++groups;
        }
        for (std::size_t i = 0; i < waiting_.size();) {
            const std::size_t end = end_of(i);
            const auto size = static_cast<std::uint32_t>(end - i);
            const bool needed = --groups == 0 && over.empty();
            const std::uint32_t k =
                needed ? driver.chooser.pick(size) + 1 : driver.chooser.pick(size + 1);
            for (std::uint32_t j = 0; j < k; ++j) {
                over.push_back(waiting_[i + j].number);
            }
            i = end;
        }
        return !over.empty();
    }

    void enter(std::uint32_t) override { fresh_ = true; }

    // A kind is stirred when one of those that waited does so no more.
    void stirred(Driver& driver, const Driver::Step&, std::uint64_t* row) override {
        if (fresh_) {  // what waits before the step: as the string says, numbered from 1
            fresh_ = false;
            collect_waiting(request_.net, graph_.states->decode(graph_.graph.edges.size()),
                            before_);
        }
        collect_waiting(request_.net, driver.engine.state(), waiting_);
        for (const Waiting& w : before_) {
            const bool still =
                std::any_of(waiting_.begin(), waiting_.end(), [&w](const Waiting& x) {
                    return x.number == w.number && x.kind == w.kind && x.element == w.element;
                });
            if (w.ends() && !still) {
                row[kind_of(w) / 64] |= std::uint64_t{1} << (kind_of(w) & 63);
            }
        }
    }

    void read_waits(Driver& driver, std::uint64_t* row) override {
        collect_waiting(request_.net, driver.engine.state(), waiting_);
        for (const Waiting& w : waiting_) {
            if (w.ends()) {
                row[kind_of(w) / 64] |= std::uint64_t{1} << (kind_of(w) & 63);
            }
        }
    }

    std::vector<std::uint8_t>
        in_order_;  // per place with records: the first that came is over first
    std::uint32_t places_ = 0, transitions_ = 0;
    std::vector<Waiting> waiting_, before_;
    bool fresh_ = false;
};

}  // namespace

TimedGraph readiness_graph(const GraphRequest& request) {
    if (std::optional<TimedGraph> plain = plain_readiness(request)) {
        return std::move(*plain);
    }
    ReadinessBuilder builder(request);
    return builder.make();
}

}  // namespace puppetri::proof
