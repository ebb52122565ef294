// SPDX-License-Identifier: MIT
// From a path of classes to a run in ticks. Instants are unknown times; each token, delay and
// scheduled event that was met bounds the distance of two of them. The earliest solution, if there
// is one, says how long everything lasts; an engine that is told so then runs the path.
// Source  systems of difference constraints by longest paths (Bellman 1958).
#include <algorithm>
#include <map>
#include <numeric>

#include "class_builder.h"
#include "puppetri/net/tables.h"

namespace puppetri::proof {

using namespace net;

namespace {

constexpr std::uint32_t kNone = ~std::uint32_t{0};

// Something that lasts: it begins at one instant and is over at another; if that is not known, it
// still waits at the last one.
struct Lasting {
    Driver::Begun what;
    std::uint32_t from = 0, until = kNone, waits_at = 0;
    std::int64_t ticks = 0;  // solved
};

struct Story {
    std::vector<Lasting> lasting;
    std::uint32_t instants = 1;
    struct Happening {
        std::uint32_t instant = 0, label = 0;
        bool from_outside = false;
    };
    std::vector<Happening> happenings;
    std::vector<Branching::Answer> tokens;  // of `any` places
    std::vector<std::int64_t> times;        // per instant
};

// The answers that make the story.
class Teller final : public Chooser, public MovementHost {
 public:
    Teller(const World& world, const Story& story) : net_(&world.net->tables()) {
        for (const Lasting& l : story.lasting) {
            const bool token = l.what.kind == Timekeeper::Kind::kToken;
            if (l.what.kind == Timekeeper::Kind::kSchedule) {
                continue;
            }
            const std::uint32_t d = token ? net_->place[l.what.element].duration : kNoIndex;
            if (token && d != kNoIndex && net_->durations[d].kind == DurationKind::kAuto) {
                const ActionIndex action = world.net->action({l.what.element});
                movements_[action.value].push_back(l.ticks);
            } else if (l.what.low != l.what.high) {
                drawn_[{token ? 0u : 1u, l.what.element}].push_back(l.ticks);
            }
        }
        for (const Branching::Answer& a : story.tokens) {
            tokens_[a.element].push_back(a.answer);
        }
        for (const Story::Happening& h : story.happenings) {
            if ((h.label & Edge::kEvent) == 0) {
                firings_.push_back(h.label);
            }
        }
    }

    std::int64_t choose(const Choice& c) override {
        const std::int64_t answer = answer_to(c);
        answers.push_back(answer);
        return answer;
    }
    SimTime begin(ActionIndex action, ActivityIndex, SimTime, SimTime duration,
                  std::span<const std::int64_t>) override {
        const SimTime said =
            duration.ticks >= 0 ? duration : SimTime{next_of(movements_[action.value], 0)};
        movements.push_back(said);
        return said;
    }
    std::span<const RaisedEvent> raised(ActivityIndex) override { return {}; }
    void cut(ActivityIndex, SimTime) override {}
    void left(ActivityIndex, SimTime) override {}

    std::vector<std::int64_t> answers;
    std::vector<SimTime> movements;
    std::size_t fired = 0;

 private:
    static std::int64_t next_of(std::vector<std::int64_t>& list, std::int64_t otherwise) {
        if (list.empty()) {
            return otherwise;
        }
        const std::int64_t first = list.front();
        list.erase(list.begin());
        return first;
    }
    std::int64_t answer_to(const Choice& c) {
        switch (c.kind) {
            case ChoiceKind::kTie: {
                const auto end = c.transitions.end();
                const auto it = fired < firings_.size()
                                    ? std::find(c.transitions.begin(), end, firings_[fired])
                                    : end;
                return it == end ? 0 : it - c.transitions.begin();
            }
            case ChoiceKind::kToken:
                return std::clamp<std::int64_t>(next_of(tokens_[c.element], 0), 0,
                                                std::int64_t{c.options} - 1);
            case ChoiceKind::kDuration:
            case ChoiceKind::kDelay:
            case ChoiceKind::kInterval: {
                if (c.low == c.high) {
                    return c.low.ticks;
                }
                const bool delay = c.kind == ChoiceKind::kDelay || c.of_delay;
                return std::clamp(next_of(drawn_[{delay ? 1u : 0u, c.element}], c.drawn.ticks),
                                  c.low.ticks, c.high.ticks);
            }
            default:
                return 0;
        }
    }

    const NetTables* net_;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::int64_t>> drawn_;
    std::map<std::uint32_t, std::vector<std::int64_t>> movements_, tokens_;
    std::vector<std::uint32_t> firings_;
};

// T[to] >= T[from] + ticks.
struct AtLeast {
    std::uint32_t from = 0, to = 0;
    std::int64_t ticks = 0;
};

// How late instant `last` can be: the shortest way to it against the rules. Nothing: for ever.
std::optional<std::int64_t> latest(const std::vector<AtLeast>& rules, std::uint32_t instants) {
    constexpr std::int64_t kNever = SimTime::never().ticks;
    std::vector<std::int64_t> at_most(instants, kNever);
    at_most[0] = 0;
    bool more = true;
    for (std::uint32_t round = 0; more && round <= instants; ++round) {
        more = false;
        for (const AtLeast& r : rules) {
            if (at_most[r.to] != kNever && at_most[r.to] - r.ticks < at_most[r.from]) {
                at_most[r.from] = at_most[r.to] - r.ticks;
                more = true;
            }
        }
    }
    return more || at_most.back() == kNever ? std::nullopt : std::optional(at_most.back());
}

// The times of all instants in multiples of `unit`, the last of them as early or as late as can be.
// False: there are none.
bool solve(Story& story, std::int64_t unit, TimedGraph::Pace pace) {
    std::vector<AtLeast> rules;
    for (std::uint32_t k = 1; k < story.instants; ++k) {
        rules.push_back({k - 1, k, unit});
    }
    for (const Lasting& l : story.lasting) {
        const bool bounded = l.what.high < kWaiting;
        if (l.what.number == 0) {
            continue;
        }
        if (l.until != kNone) {
            rules.push_back({l.from, l.until, std::max(unit, l.what.low)});
            if (bounded) {
                rules.push_back({l.until, l.from, -l.what.high});
            }
        } else if (bounded) {
            rules.push_back({l.waits_at, l.from, unit - l.what.high});
        }
    }
    if (pace == TimedGraph::Pace::kLatest) {
        if (const auto last = latest(rules, story.instants)) {
            rules.push_back({0, story.instants - 1, *last});
        }
    }
    story.times.assign(story.instants, 0);
    bool more = true;
    for (std::uint32_t round = 0; more && round <= story.instants; ++round) {
        more = false;
        for (const AtLeast& r : rules) {
            const std::int64_t t = story.times[r.from] + r.ticks;
            if (t > story.times[r.to]) {
                if (r.to == 0) {
                    return false;
                }
                story.times[r.to] = t;
                more = true;
            }
        }
    }
    if (more) {
        return false;
    }
    for (Lasting& l : story.lasting) {
        l.ticks = l.what.number == 0 ? 0
                  : l.until != kNone
                      ? story.times[l.until] - story.times[l.from]
                      : std::max(std::max(unit, l.what.low),
                                 story.times[l.waits_at] - story.times[l.from] + unit);
    }
    return true;
}

std::optional<Script> tell(const World& world, const Story& story, std::string* trouble) {
    Script script;
    for (const Story::Happening& h : story.happenings) {
        const SimTime at{story.times[h.instant]};
        if ((h.label & Edge::kEvent) == 0) {
            script.firings.push_back({at, {h.label}});
        } else if (h.from_outside) {
            script.outside.push_back({at, {h.label & ~Edge::kEvent}});
        }
    }
    script.until = {story.times.back()};
    Teller teller(world, story);
    EngineOptions options;
    options.host = &teller;
    options.beat = world.beat;
    Engine engine(*world.net, teller, options);
    engine.start();
    for (const Script::Outside& o : script.outside) {
        engine.occur(o.event, o.at);
    }
    while (teller.fired < script.firings.size() &&
           engine.step(script.until.ticks) == Engine::Outcome::kFired &&
           engine.state().last == script.firings[teller.fired].transition.value) {
        ++teller.fired;
    }
    script.answers = std::move(teller.answers);
    script.movements = std::move(teller.movements);
    if (!plays(world, script, trouble)) {
        return std::nullopt;
    }
    return script;
}

}  // namespace

std::optional<Script> class_script(const TimedGraph& graph, std::span<const std::uint32_t> path,
                                   std::string* trouble, TimedGraph::Pace pace) {
    const auto none = [&](const char* why) -> std::optional<Script> {
        if (trouble != nullptr) {
            *trouble = why;
        }
        return std::nullopt;
    };
    const TimedGraph::States& states = *graph.states;
    const Budget budget;
    const GraphRequest request{.net = *states.world.net,
                               .actions = states.world.actions,
                               .outside_events = states.world.outside_events,
                               .beat = states.world.beat,
                               .budget = budget};
    if (states.world.net->paced()) {
        return none("a net without time: its untimed paths are its runs");
    }
    ClassBuilder builder(request, states.observed);
    builder.follow(graph);
    Driver& d = builder.driver();
    const NetTables& n = request.net.tables();
    Story story;
    std::vector<Branching::Answer> answers;
    d.chooser.record(&answers);
    std::map<std::int64_t, std::uint32_t> lasting;  // number in the present state -> story.lasting
    const auto is_state = [&](const Driver::Step& step, std::uint32_t state) {
        return builder.is_at(step, states.store[state]);
    };
    // What the step has done to all that lasts.
    const auto note = [&] {
        const std::uint32_t now = story.instants - 1;
        std::map<std::int64_t, std::uint32_t> all = lasting;
        for (const std::int64_t number : d.passed()) {
            story.lasting[all.at(number)].until = now;
        }
        for (const Driver::Begun& b : d.begun()) {
            if (b.number != 0) {
                all[b.number] = static_cast<std::uint32_t>(story.lasting.size());
            }
            story.lasting.push_back({b, now, b.number == 0 ? now : kNone, now, 0});
        }
        lasting.clear();
        const auto& numbers = builder.track().numbers;
        for (std::size_t i = 0; i < numbers.size(); ++i) {
            const std::uint32_t l = all.at(numbers[i]);
            lasting[static_cast<std::int64_t>(i) + 1] = l;
            story.lasting[l].waits_at = now;
        }
        for (auto& [number, l] : all) {  // cut: it waited up to now
            if (story.lasting[l].until == kNone) {
                story.lasting[l].waits_at = now;
            }
        }
        for (const Branching::Answer& a : answers) {
            if (a.kind == ChoiceKind::kToken &&
                n.rich[n.place_rich[a.element]].discipline == Discipline::kAny) {
                story.tokens.push_back(a);
            }
        }
    };
    std::uint32_t at = graph.graph.initial;
    std::size_t next = 0;
    if (states.several_starts) {
        if (path.empty()) {
            return Script{};  // nothing to be done yet
        }
        at = graph.graph.edges.items[path[next++]].target;
    }
    bool found = false;
    do {
        d.chooser.rewind();
        answers.clear();
        d.start();
        found = is_state({}, at);
    } while (!found && d.chooser.next());
    if (!found) {
        return none("the start was not found again");
    }
    note();
    for (; next < path.size(); ++next) {
        const Edge edge = graph.graph.edges.items[path[next]];
        std::uint32_t outside = 0;
        const State here = states.decode(at, &outside);
        builder.stand_in(at);
        d.chooser.clear();
        Driver::Step step;
        do {
            d.chooser.rewind();
            answers.clear();
            d.restore(here, outside);
            found = d.step(step) == Driver::Did::kStep && step.label == edge.label &&
                    is_state(step, edge.target);
        } while (!found && d.chooser.next());
        if (!found) {
            return none("a step of the path was not found again");
        }
        if (edge.label == Edge::kPass) {
            if (d.from_outside()) {
                return none("a sensor changes by itself, which no script can say");
            }
            ++story.instants;
        } else {
            story.happenings.push_back({story.instants - 1, edge.label, d.from_outside()});
        }
        note();
        at = edge.target;
    }
    // Whole milliseconds if everything is: movements last no fraction of one.
    bool whole = true;
    for (const Lasting& l : story.lasting) {
        whole = whole && l.what.low % kTicksPerMillisecond == 0 &&
                (l.what.high > kWaiting || l.what.high % kTicksPerMillisecond == 0);
    }
    if ((whole && solve(story, kTicksPerMillisecond, pace)) || solve(story, 1, pace)) {
        return tell(states.world, story, trouble);
    }
    return none("the path needs times between two ticks");
}

}  // namespace puppetri::proof
