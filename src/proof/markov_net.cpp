// SPDX-License-Identifier: MIT
// The graph by the engine, one wait at a time; then states inside of an instant are taken out.
#include "puppetri/proof/markov_net.h"

#include <algorithm>
#include <map>

#include "puppetri/net/tables.h"
#include "timed_builder.h"

namespace puppetri::proof {

using namespace net;

namespace {

// The mean of an exponential duration in seconds; 0: it takes no time; negative: something else.
double mean_of(const DurationTable& d) {
    if (d.kind == DurationKind::kConstant) {
        return d.ticks == 0 ? 0 : -1;
    }
    const bool exponential = d.kind == DurationKind::kDistribution &&
                             d.distribution == DistributionKind::kExponential &&
                             d.constants.size() == 1 && d.parameters.size() == 1;
    return exponential ? d.constants[0] : -1;
}

class MarkovBuilder final : public TimedBuilder {
 public:
    explicit MarkovBuilder(const GraphRequest& request)
        : TimedBuilder(request, ClockForm::kReadiness, "Markov chain") {
        const NetTables& n = request.net.tables();
        const auto refuse = [this](const std::string& what) { graph_.why_not.push_back(what); };
        place_mean_.assign(n.places.size(), 0);
        for (std::uint32_t p = 0; p < n.places.size(); ++p) {
            const std::uint32_t d = n.place[p].duration;
            place_mean_[p] = d == kNoIndex ? 0 : mean_of(n.durations[d]);
            const std::string name = "place " + std::string(n.places.path(p));
            if (place_mean_[p] < 0) {
                refuse(name + " has a duration that is not exponential with a constant mean");
            }
            const bool rich = !n.place_rich.empty() && n.place_rich[p] != kNoIndex;
            if (rich && place_mean_[p] > 0 && n.rich[n.place_rich[p]].keeps_order) {
                refuse(name + " keeps the order of its tokens");
            }
        }
        delay_mean_.assign(n.transitions.size(), 0);
        for (const DelayTable& d : n.delays) {
            delay_mean_[d.transition] = mean_of(d.duration);
            if (!(delay_mean_[d.transition] > 0)) {
                refuse("transition " + std::string(n.transitions.path(d.transition)) +
                       " has a delay that is not exponential with a constant mean");
            }
        }
        for (const Special& s : n.specials) {
            for (const OutputTable& out : s.outputs) {
                if (out.lasts.valid()) {
                    refuse("transition " + std::string(n.transitions.path(s.transition)) +
                           " gives a token with a duration of its own");
                }
            }
        }
        for (const ScheduledEvent& s : n.declarations.schedule) {
            refuse("event " + std::string(n.events.path(s.event.value)) +
                   " comes at certain times");
        }
        const World& world = graph_.states->world;
        for (const std::uint32_t e : world.movement_events) {
            refuse("event " + std::string(n.events.path(e)) + " is raised by a movement");
        }
        for (const std::uint32_t s : world.free_sensors) {
            refuse("sensor " + std::string(n.data.path(s)) + " changes with the figures");
        }
        if (request.net.paced()) {
            refuse("the net has no time");
        }
        driver_->waits_always();
        driver_->choose_with(
            [](void* self, Driver& driver, std::vector<std::int64_t>& over) {
                return static_cast<MarkovBuilder*>(self)->choose(driver, over);
            },
            this);
        weigh_edges();
    }

 private:
    double weight(Driver& driver, const Driver::Step&) override {
        return driver.passed().empty() ? driver.chooser.chance() : rate_;
    }

    // One of what waits. Tokens of one place that nothing tells apart are one choice, as fast as
    // all of them.
    bool choose(Driver& driver, std::vector<std::int64_t>& over) {
        collect_waiting(request_.net, driver.engine.state(), waiting_);
        std::erase_if(waiting_, [](const Waiting& w) { return !w.ends(); });
        struct Group {
            std::size_t first;
            double size;
        };
        std::vector<Group> groups;
        for (std::size_t i = 0; i < waiting_.size(); ++i) {
            const bool again = i > 0 && waiting_[i].kind == Waiting::kPlace &&
                               waiting_[i - 1].kind == Waiting::kPlace &&
                               waiting_[i].element == waiting_[i - 1].element;
            if (again) {
                ++groups.back().size;
            } else {
                groups.push_back({i, 1});
            }
        }
        if (groups.empty()) {
            return false;
        }
        const Group g = groups[driver.chooser.pick(static_cast<std::uint32_t>(groups.size()))];
        const Waiting& w = waiting_[g.first];
        rate_ =
            g.size / (w.kind == Waiting::kDelay ? delay_mean_[w.element] : place_mean_[w.element]);
        over.push_back(w.number);
        return true;
    }

    std::vector<double> place_mean_, delay_mean_;
    std::vector<Waiting> waiting_;
    double rate_ = 0;
};

bool any_exponential(const NetTables& n) {
    const auto is = [](const DurationTable& d) {
        return d.kind == DurationKind::kDistribution &&
               d.distribution == DistributionKind::kExponential;
    };
    return std::any_of(n.durations.begin(), n.durations.end(), is) ||
           std::any_of(n.delays.begin(), n.delays.end(),
                       [&](const DelayTable& d) { return is(d.duration); });
}

// States of exact time; only ties are drawn.
class ClockedBuilder final : public TimedBuilder {
 public:
    explicit ClockedBuilder(const GraphRequest& request)
        : TimedBuilder(request, ClockForm::kExact, "Markov chain in steps") {
        const NetTables& n = request.net.tables();
        const World& world = graph_.states->world;
        const auto drawn = [&](const DurationTable& d, std::uint32_t place) {
            switch (d.kind) {
                case DurationKind::kConstant:
                case DurationKind::kExpression:
                case DurationKind::kAs:
                    return false;
                case DurationKind::kAuto: {
                    const TickRange range = movement_range(world, place);
                    return range.low != range.high;
                }
                default:
                    return true;
            }
        };
        const auto refuse = [this](const std::string& what) { graph_.why_not.push_back(what); };
        for (std::uint32_t p = 0; p < n.places.size(); ++p) {
            const std::uint32_t d = n.place[p].duration;
            if (d != kNoIndex && drawn(n.durations[d], p)) {
                refuse("place " + std::string(n.places.path(p)) +
                       " has a duration that is neither constant nor exponential");
            }
        }
        for (const DelayTable& d : n.delays) {
            if (drawn(d.duration, 0)) {
                refuse("transition " + std::string(n.transitions.path(d.transition)) +
                       " has a delay that is neither constant nor exponential");
            }
        }
        for (const std::uint32_t e : world.movement_events) {
            refuse("event " + std::string(n.events.path(e)) + " is raised by a movement");
        }
        for (const std::uint32_t s : world.free_sensors) {
            refuse("sensor " + std::string(n.data.path(s)) + " changes with the figures");
        }
        if (request.net.paced()) {
            refuse("the net has no time");
        }
        weigh_edges();
    }

 private:
    double weight(Driver& driver, const Driver::Step& step) override {
        return step.label == Edge::kPass ? 1 / SimTime{step.ticks}.seconds()
                                         : driver.chooser.chance();
    }
};

// A distribution over the states of the chain.
using Spread = std::vector<std::pair<std::uint32_t, double>>;

}  // namespace

MarkovNet markov_net(const GraphRequest& asked) {
    GraphRequest request{asked.net, asked.atoms, asked.actions, 0, asked.beat, asked.budget};
    MarkovNet made;
    const bool clocked = !any_exponential(asked.net.tables());
    if (clocked) {
        made.graph = ClockedBuilder(request).build();
    } else {
        made.graph = MarkovBuilder(request).build();
    }
    made.why_not = made.graph.why_not;
    if (!made.available()) {
        return made;
    }
    made.weights_ = std::move(made.graph.weights);
    const Graph& g = made.graph.graph;
    for (const Stop& stop : made.graph.stops) {
        made.why_not.push_back("a run can stop: " + stop.fault.message + " (" + stop.fault.element +
                               ")");
    }
    if (made.graph.states->several_starts) {
        made.why_not.emplace_back("the initial marking is drawn");
    }
    if (g.ended != Ended::kDone || !made.available()) {
        return made;
    }
    // Dead ends are states that are never left
    const auto tangible = [&g](std::uint32_t s) {
        return (g.flags[s] & Graph::kSettled) != 0 || g.dead(s);
    };
    std::vector<std::uint32_t> number(g.size(), 0);
    StateBits inside(g.size());
    for (std::uint32_t s = 0; s < g.size(); ++s) {
        if (tangible(s)) {
            number[s] = static_cast<std::uint32_t>(made.state.size());
            made.state.push_back(s);
        } else {
            inside.add(s);
        }
    }
    const StrongComponents components = strong_components(g, &inside);
    if (!cyclic_components(g, components).empty()) {
        made.why_not.emplace_back("an instant may go round for ever");
        return made;
    }
    inside.for_each([&](std::uint32_t s) { made.order_.push_back(s); });
    std::sort(made.order_.begin(), made.order_.end(), [&](std::uint32_t a, std::uint32_t b) {
        return components.of[a] > components.of[b];
    });
    // Where each of them ends, from the last to the first
    std::vector<Spread> ends(g.size());
    const auto spread_of = [&](std::uint32_t s) {
        return tangible(s) ? Spread{{number[s], 1.0}} : ends[s];
    };
    for (auto s = made.order_.rbegin(); s != made.order_.rend(); ++s) {
        std::map<std::uint32_t, double> sum;
        for (std::uint32_t e = g.edges.starts[*s]; e < g.edges.starts[*s + 1]; ++e) {
            for (const auto& [to, p] : spread_of(g.edges.items[e].target)) {
                sum[to] += made.weights_[e] * p;
            }
        }
        ends[*s].assign(sum.begin(), sum.end());
    }
    for (const std::uint32_t s : made.state) {
        std::map<std::uint32_t, double> sum;
        for (std::uint32_t e = g.edges.starts[s]; e < g.edges.starts[s + 1]; ++e) {
            for (const auto& [to, p] : spread_of(g.edges.items[e].target)) {
                sum[to] += made.weights_[e] * p;
            }
        }
        for (const auto& [to, rate] : sum) {
            made.chain.jumps.items.push_back({to, rate});
        }
        made.chain.jumps.starts.push_back(
            static_cast<std::uint32_t>(made.chain.jumps.items.size()));
    }
    for (std::size_t i = 0; clocked && i < made.state.size(); ++i) {
        const std::uint32_t e = g.edges.starts[made.state[i]];
        const bool stays = e == g.edges.starts[made.state[i] + 1];
        made.chain.lasts.push_back(stays ? SimTime::never().ticks : g.low_ticks[e]);
    }
    made.chain.initial.assign(made.state.size(), 0);
    for (const auto& [to, p] : spread_of(g.initial)) {
        made.chain.initial[to] = p;
    }
    return made;
}

double MarkovNet::mean_tokens(const std::vector<double>& shares, PlaceIndex place) const {
    double sum = 0;
    for (std::size_t i = 0; i < state.size(); ++i) {
        sum += shares[i] == 0 ? 0 : shares[i] * graph.tokens(state[i], place).total;
    }
    return sum;
}

double MarkovNet::share_marked(const std::vector<double>& shares, PlaceIndex place) const {
    double sum = 0;
    for (std::size_t i = 0; i < state.size(); ++i) {
        sum += shares[i] != 0 && graph.tokens(state[i], place).total != 0 ? shares[i] : 0;
    }
    return sum;
}

// By transition, per second: what flows into an instant, along its states in order.
std::vector<double> MarkovNet::firings(const std::vector<double>& shares) const {
    const Graph& g = graph.graph;
    std::vector<double> flow(g.size(), 0), fired(graph.states->world.net->transition_count(), 0);
    const auto leave = [&](std::uint32_t s) {
        for (std::uint32_t e = g.edges.starts[s]; flow[s] != 0 && e < g.edges.starts[s + 1]; ++e) {
            const double along = flow[s] * weights_[e];
            const Edge& edge = g.edges.items[e];
            flow[edge.target] += along;
            if ((edge.label & Edge::kEvent) == 0) {
                fired[edge.label] += along;
            }
        }
    };
    for (std::size_t i = 0; i < state.size(); ++i) {
        flow[state[i]] = shares[i];
        leave(state[i]);
        flow[state[i]] = 0;
    }
    for (std::size_t i = 0; i < state.size(); ++i) {
        flow[state[i]] = 0;  // what has come to rest there
    }
    for (const std::uint32_t s : order_) {
        leave(s);
    }
    return fired;
}

double MarkovNet::rate(const std::vector<double>& shares, TransitionIndex transition) const {
    return firings(shares)[transition.value];
}

double MarkovNet::arrivals(const std::vector<double>& shares, PlaceIndex place) const {
    const NetTables& n = graph.states->world.net->tables();
    const std::vector<double> fired = firings(shares);
    double sum = 0;
    for (std::uint32_t t = 0; t < fired.size(); ++t) {
        for (const Weighted& w : n.gives(t)) {
            sum += w.place == place.value ? fired[t] * w.weight : 0;
        }
        if (n.transition[t].special != kNoIndex) {
            for (const OutputTable& out : n.specials[n.transition[t].special].outputs) {
                sum += out.place == place.value ? fired[t] * out.weight : 0;
            }
        }
    }
    return sum;
}

}  // namespace puppetri::proof
