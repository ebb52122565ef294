// SPDX-License-Identifier: MIT
// What a graph says of its states, in words, and how a path of exact steps is played again.
#include "puppetri/proof/timed_graph.h"

#include <algorithm>
#include <deque>

#include "puppetri/base/text.h"
#include "puppetri/net/tables.h"
#include "timed_builder.h"

namespace puppetri::proof {

using namespace net;

TimedGraph::TimedGraph() = default;
TimedGraph::~TimedGraph() = default;
TimedGraph::TimedGraph(TimedGraph&&) noexcept = default;
TimedGraph& TimedGraph::operator=(TimedGraph&&) noexcept = default;

Counts TimedGraph::tokens(std::uint32_t state, PlaceIndex place) const {
    return states->decode(state).counts[place.value];
}

Value TimedGraph::datum(std::uint32_t state, DatumIndex datum) const {
    return states->decode(state).data[datum.value];
}

std::uint64_t TimedGraph::bytes() const {
    return states == nullptr ? 0 : states->plain ? states->plain->bytes() : states->store.held();
}

std::string time_in_words(std::int64_t ticks) {
    return ticks == SimTime::never().ticks ? "for ever"
                                           : number_to_text(SimTime{ticks}.seconds()) + " s";
}

std::string TimedGraph::words(std::uint32_t state) const {
    const State s = states->decode(state);
    const NetTables& n = states->world.net->tables();
    std::string text;
    const auto add = [&text](const std::string& part) {
        text += (text.empty() ? "" : ", ") + part;
    };
    // What is left of the tokens that wait; where time is exact, now is 0.
    std::vector<std::vector<std::int64_t>> left(s.counts.size());
    if (states->form == ClockForm::kExact) {
        for (const Pending& p : s.heap.items) {
            const std::uint32_t i = p.what & Pending::kIndexMask;
            const std::uint32_t kind = p.what & ~Pending::kIndexMask;
            if (kind != Pending::kDelay) {
                left[kind == Pending::kToken ? n.rich[i].place : i].push_back(p.at);
            }
        }
    }
    for (std::uint32_t p = 0; p < s.counts.size(); ++p) {
        const Counts c = s.counts[p];
        if (c.total == 0) {
            continue;
        }
        std::string part = c.total == 1 ? "" : std::to_string(c.total) + " ";
        part += n.places.path(p);
        if (c.ready != c.total) {
            part += c.ready == 0 ? " (not ready"
                                 : " (" + std::to_string(c.total - c.ready) + " not ready";
            std::sort(left[p].begin(), left[p].end());
            for (std::size_t i = 0; i < left[p].size(); ++i) {
                part += (i == 0 ? ": " : ", ") + time_in_words(left[p][i]);
            }
            part += ")";
        }
        add(part);
    }
    if (text.empty()) {
        text = "nothing";
    }
    for (std::uint32_t d = 0; d < s.data.size(); ++d) {
        const ValueType type = n.declarations.data[d].type;
        const ValueKind kind = type.kind;
        if (kind == ValueKind::kEnum && type.enumeration < n.declarations.enums.size()) {
            const auto& values = n.declarations.enums[type.enumeration].values;
            if (s.data[d] >= 0 && s.data[d] < static_cast<Value>(values.size())) {
                add(std::string(n.data.path(d)) + " = " +
                    values[static_cast<std::size_t>(s.data[d])]);
                continue;
            }
        }
        add(std::string(n.data.path(d)) + " = " +
            (kind == ValueKind::kBool   ? (s.data[d] != 0 ? "true" : "false")
             : kind == ValueKind::kReal ? number_to_text(real_of_value(s.data[d]))
             : kind == ValueKind::kTime ? time_in_words(s.data[d])
                                        : std::to_string(s.data[d])));
    }
    if (s.offered != kNoIndex) {
        add(std::string(n.events.path(s.offered)) + " occurs");
    }
    return text;
}

std::string TimedGraph::words_of_edge(std::uint32_t edge) const {
    const NetTables& n = states->world.net->tables();
    const std::uint32_t label = graph.edges.items[edge].label;
    if (label == Edge::kPass) {
        if (states->several_starts && edge < graph.edges.starts[1]) {
            return "it begins";
        }
        if (graph.low_ticks.empty()) {
            return "time passes";
        }
        const std::int64_t low = graph.low_ticks[edge];
        const std::int64_t high = graph.high_ticks[edge];
        return low == high ? (low == 0 ? "the outside changes" : time_in_words(low) + " pass")
               : high == SimTime::never().ticks
                   ? "at least " + time_in_words(low) + " pass"
                   : time_in_words(low) + " to " + time_in_words(high) + " pass";
    }
    if ((label & Edge::kEvent) != 0) {
        return std::string(n.events.path(label & ~Edge::kEvent)) + " occurs";
    }
    return std::string(n.transitions.path(label)) + " fires";
}

std::vector<std::uint32_t> TimedGraph::path_to(std::uint32_t state) const {
    constexpr std::uint32_t kNone = ~std::uint32_t{0};
    std::vector<std::uint32_t> by(graph.size(), kNone), from(graph.size(), kNone);
    std::deque<std::uint32_t> open = {graph.initial};
    std::vector<bool> seen(graph.size(), false);
    seen[graph.initial] = true;
    while (!open.empty() && !seen[state]) {
        const std::uint32_t s = open.front();
        open.pop_front();
        for (std::uint32_t e = graph.edges.starts[s]; e < graph.edges.starts[s + 1]; ++e) {
            const std::uint32_t t = graph.edges.items[e].target;
            if (!seen[t]) {
                seen[t] = true;
                by[t] = e;
                from[t] = s;
                open.push_back(t);
            }
        }
    }
    std::vector<std::uint32_t> path;
    for (std::uint32_t s = state; s != graph.initial && by[s] != kNone; s = from[s]) {
        path.push_back(by[s]);
    }
    std::reverse(path.begin(), path.end());
    return path;
}

namespace {

// Movements that last as the script says.
class SaidHost final : public MovementHost {
 public:
    explicit SaidHost(const std::vector<SimTime>& lasts) : lasts_(&lasts) {}
    SimTime begin(ActionIndex, ActivityIndex, SimTime, SimTime duration,
                  std::span<const std::int64_t>) override {
        const SimTime said = next_ < lasts_->size() ? (*lasts_)[next_] : SimTime{0};
        ++next_;
        return duration.ticks >= 0 ? duration : said;
    }
    std::span<const RaisedEvent> raised(ActivityIndex) override { return {}; }
    void cut(ActivityIndex, SimTime) override {}
    void left(ActivityIndex, SimTime) override {}

 private:
    const std::vector<SimTime>* lasts_;
    std::size_t next_ = 0;
};

}  // namespace

// Plays a script in an engine as anybody would.
bool plays(const World& world, const Script& script, std::string* trouble) {
    ScriptedChooser chooser(script.answers);
    SaidHost host(script.movements);
    EngineOptions options;
    options.host = &host;
    options.beat = world.beat;
    Engine engine(*world.net, chooser, options);
    engine.start();
    for (const Script::Outside& o : script.outside) {
        engine.occur(o.event, o.at);
    }
    for (std::size_t i = 0; i < script.firings.size(); ++i) {
        const Script::Firing& f = script.firings[i];
        if (engine.step(f.at.ticks) != Engine::Outcome::kFired ||
            engine.state().last != f.transition.value || engine.state().now != f.at.ticks) {
            if (trouble != nullptr) {
                *trouble = "played again, firing " + std::to_string(i + 1) + " is not " +
                           std::string(world.net->tables().transitions.path(f.transition.value)) +
                           " at " + time_in_words(f.at.ticks);
            }
            return false;
        }
    }
    return true;
}

// Follows the path in an engine that runs from the start, step by step: of all answers those that
// lead to the path's next state.
std::optional<Script> TimedGraph::script(std::span<const std::uint32_t> path, std::string* trouble,
                                         Pace pace) const {
    const auto none = [&](const char* why) -> std::optional<Script> {
        if (trouble != nullptr) {
            *trouble = why;
        }
        return std::nullopt;
    };
    if (states->form == ClockForm::kClasses) {
        return class_script(*this, path, trouble, pace);
    }
    if (states->plain) {
        std::vector<std::uint32_t> firings;
        for (const std::uint32_t e : path) {
            firings.push_back(graph.edges.items[e].label);
        }
        return script_of(*states->world.net, firings, states->world.beat, trouble);
    }
    if (states->form == ClockForm::kReadiness) {
        return none("a readiness graph knows no times");
    }
    Driver d(states->world, ClockForm::kExact);
    Script script;
    std::vector<std::uint8_t> bytes;
    const auto is_state = [&](std::uint32_t state) {
        bytes.clear();
        states->encode(d, bytes);
        const auto wanted = states->store[state];
        return std::equal(bytes.begin(), bytes.end(), wanted.begin(), wanted.end());
    };
    std::vector<Branching::Answer> answers;
    d.chooser.record(&answers);
    const auto keep = [&] {
        for (const Branching::Answer& a : answers) {
            script.answers.push_back(a.answer);
        }
    };
    // The start is a choice of its own where there are several.
    std::uint32_t at = graph.initial;
    std::size_t next = 0;
    if (states->several_starts) {
        if (path.empty()) {
            return Script{};  // nothing to be done yet
        }
        at = graph.edges.items[path[next++]].target;
    }
    bool found = false;
    do {
        d.chooser.rewind();
        answers.clear();
        d.start();
        found = is_state(at);
    } while (!found && d.chooser.next());
    if (!found) {
        return none("the start was not found again");
    }
    keep();
    std::vector<SimTime> movements = d.movements;
    for (; next < path.size(); ++next) {
        const Edge edge = graph.edges.items[path[next]];
        const State here = d.engine.save();
        const std::uint32_t outside = d.outside;
        d.chooser.clear();
        found = false;
        Driver::Step step;
        do {
            d.chooser.rewind();
            answers.clear();
            d.movements = movements;
            d.restore(here, outside);
            found = d.step(step) == Driver::Did::kStep && step.label == edge.label &&
                    step.ticks == graph.low_ticks[path[next]] && is_state(edge.target);
        } while (!found && d.chooser.next());
        if (!found) {
            return none("a step of the path was not found again");
        }
        movements = d.movements;
        keep();
        const SimTime now{d.engine.state().now};
        if (edge.label == Edge::kPass) {
            if (step.ticks == 0) {
                return none("a sensor changes by itself, which no script can say");
            }
        } else if ((edge.label & Edge::kEvent) != 0) {
            if (d.from_outside()) {
                script.outside.push_back({now, {edge.label & ~Edge::kEvent}});
            }
        } else {
            script.firings.push_back({now, {edge.label}});
        }
        script.until = now;
    }
    script.movements = std::move(movements);
    if (!plays(states->world, script, trouble)) {
        return std::nullopt;
    }
    return script;
}

}  // namespace puppetri::proof
