// SPDX-License-Identifier: MIT
#include "part.h"

#include <algorithm>
#include <utility>

#include "puppetri/net/tables.h"
#include "puppetri/proof/coverability.h"
#include "puppetri/proof/readiness.h"
#include "puppetri/proof/state_classes.h"
#include "puppetri/proof/timed_exact.h"

namespace puppetri::verdict {

const char* name_of(Method method) {
    switch (method) {
        case Method::kReadiness:
            return "readiness graph";
        case Method::kExact:
            return "exact time";
        case Method::kClasses:
            return "state classes";
    }
    return "";
}

Part::Part(const net::Net& whole, const Theatre& theatre, const HostLowering* host)
    : net_(&whole), theatre_(&theatre), host_(host) {}

std::unique_ptr<Part> Part::of(net::NetDraft draft, const Theatre& theatre,
                               const stage::Play* play) {
    auto compiled = net::compile(draft);
    if (compiled && compiled->paced() && !theatre.net->paced()) {
        // A part without any time in a net that has some does not go one firing per beat: a place
        // that would take time, with no token ever, says so.
        net::PlaceDraft clock;
        clock.path = "time passes elsewhere";
        clock.duration = net::DurationDraft::constant(SimTime{kTicksPerSecond});
        draft.places.push_back(std::move(clock));
        compiled = net::compile(draft);
    }
    if (!compiled) {
        return nullptr;
    }
    std::unique_ptr<Part> part(new Part());
    part->own_.emplace(std::move(*compiled));
    part->net_ = &*part->own_;
    part->theatre_ = &theatre;
    if (play != nullptr) {
        part->own_host_ = std::make_unique<FigureLowering>(*part->net_, *play);
        part->host_ = part->own_host_.get();
    }
    const net::Net& whole = *theatre.net;
    for (std::uint32_t t = 0; t < whole.transition_count(); ++t) {
        part->transitions.push_back(
            part->net_->find_transition(whole.transition(net::TransitionIndex{t}).path).value);
    }
    for (std::uint32_t e = 0; e < whole.event_count(); ++e) {
        part->events.push_back(part->net_->find_event(whole.event(net::EventIndex{e}).path).value);
    }
    return part;
}

const Asked* Part::asked(const std::string& path) const {
    for (const Asked& a : asked_) {
        if (a.rule.path == path) {
            return &a;
        }
    }
    return nullptr;
}

std::uint32_t Part::add(Asked asked) {
    obligations_.push_back(make_obligation(*net_, asked.rule, host_, atoms_));
    if (asked.rule.path.starts_with("builtin.one_movement")) {
        obligations_.back().about_figures = true;  // the stage knows who gives way
    }
    asked_.push_back(std::move(asked));
    return static_cast<std::uint32_t>(asked_.size() - 1);
}

proof::GraphRequest Part::request(const proof::Budget& budget, std::uint32_t outside_events) const {
    return {.net = *net_,
            .atoms = atoms_.formulas(),
            .actions = theatre_->actions,
            .outside_events = outside_events,
            .beat = theatre_->beat.ticks,
            .budget = budget};
}

const proof::TimedGraph* Part::made(Method method, const proof::Budget& budget,
                                    std::uint32_t outside_events, std::string& why) {
    const auto i = static_cast<std::size_t>(method);
    if (!graphs_[i] && why_[i].empty()) {
        const proof::GraphRequest all = request(budget, outside_events);
        proof::TimedGraph made = method == Method::kReadiness ? proof::readiness_graph(all)
                                 : method == Method::kExact   ? proof::timed_exact_graph(all)
                                                              : proof::class_graph(all);
        if (made.available()) {
            graphs_[i].emplace(std::move(made));
        } else {
            why_[i] = made.why_not.front();
        }
    }
    why = why_[i];
    return graphs_[i] ? &*graphs_[i] : nullptr;
}

GraphView Part::view(Method method) const {
    const auto& graph = graphs_[static_cast<std::size_t>(method)];
    GraphView v;
    v.timed = &*graph;
    // Without any time the readiness graph is the graph of markings itself.
    v.concrete = method == Method::kExact || (method == Method::kReadiness && graph->graph.exact);
    v.by_ticks = method != Method::kReadiness && !graph->graph.high_ticks.empty();
    v.at_most = longest_waits(*net_, theatre_->actions);
    return v;
}

std::vector<std::uint32_t> Part::in_whole(std::vector<std::uint32_t> firings) const {
    if (transitions.empty()) {
        return firings;
    }
    std::vector<std::uint32_t> whole(net_->transition_count());
    for (std::uint32_t t = 0; t < transitions.size(); ++t) {
        if (transitions[t] < whole.size()) {
            whole[transitions[t]] = t;
        }
    }
    for (std::uint32_t& t : firings) {
        t = whole[t];
    }
    return firings;
}

const proof::TimedGraph* Part::first_look(Method method, const GraphLimits& limits,
                                          std::string& why) {
    constexpr std::uint64_t kFew = 20'000;
    proof::Budget budget = limits.budget;
    if (method == Method::kReadiness || grows) {
        const bool counts = net_->paced() && net_->declarations().data.empty();
        budget.states = std::min(budget.states, counts ? limits.first_look_states : kFew);
    }
    return made(method, budget, limits.outside_events, why);
}

const proof::TimedGraph* Part::whole_graph(Method method, const GraphLimits& limits,
                                           std::string& why) {
    const auto i = static_cast<std::size_t>(method);
    const proof::TimedGraph* graph = first_look(method, limits, why);
    if (graph == nullptr || graph->graph.ended != proof::Ended::kStates || grows ||
        all_states_[i]) {
        return graph;
    }
    proof::Budget little = limits.budget;
    little.seconds = std::min(little.seconds / 4, 2.0);
    const proof::Plain plain = proof::plain(*net_);
    const proof::BoundednessAnswer answer =
        plain.unsound ? proof::BoundednessAnswer{} : proof::boundedness(plain.net, little);
    if (answer.kind == proof::BoundednessAnswer::kUnbounded) {
        grows = true;
        grows_where = net_->place(net::PlaceIndex{answer.place}).path;
        return graph;
    }
    graphs_[i].reset();
    all_states_[i] = true;
    return made(method, limits.budget, limits.outside_events, why);
}

}  // namespace puppetri::verdict
