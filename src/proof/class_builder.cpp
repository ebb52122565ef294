// SPDX-License-Identifier: MIT
#include "class_builder.h"

#include <algorithm>

#include "puppetri/base/varint.h"
#include "puppetri/net/tables.h"

namespace puppetri::proof {

using namespace net;

ClassBuilder::ClassBuilder(const GraphRequest& request, bool observed)
    : TimedBuilder(request, ClockForm::kClasses, "state classes"), observed_(observed) {
    check(request);
    states_ = graph_.states.get();
    states_->observed = observed;
    zone_ = passed_ = Zone(observed ? 1 : 0);
    driver_->choose_with(
        [](void* self, Driver& driver, std::vector<std::int64_t>& over) {
            return static_cast<ClassBuilder*>(self)->choose(driver, over);
        },
        this);
}

void ClassBuilder::check(const GraphRequest& request) {
    const NetTables& n = request.net.tables();
    for (std::string& what : misused_time_left(request.net)) {
        graph_.why_not.push_back(std::move(what));
    }
    if (carries_time_left(request.net)) {
        graph_.why_not.emplace_back("a token carries the time left of another");
    }
    const std::uint32_t places = request.net.place_count();
    drawn_.assign(places + request.net.transition_count(), 0);
    const auto is_drawn = [](const DurationTable& d) {
        return d.kind == DurationKind::kDistribution ? std::uint8_t{1} : std::uint8_t{0};
    };
    for (std::uint32_t p = 0; p < places; ++p) {
        const std::uint32_t d = n.place[p].duration;
        drawn_[p] = d == kNoIndex ? std::uint8_t{0} : is_drawn(n.durations[d]);
    }
    for (const DelayTable& d : n.delays) {
        drawn_[places + d.transition] = is_drawn(d.duration);
        if (d.memory == DelayMemory::kAge) {
            graph_.why_not.push_back("transition " + std::string(n.transitions.path(d.transition)) +
                                     " has a delay that is stopped and goes on");
        }
    }
    const auto check_values = [&](const std::string& who, const DurationTable& d) {
        if (d.kind == DurationKind::kDistribution &&
            d.distribution == DistributionKind::kDiscrete) {
            graph_.not_exact.push_back(who +
                                       " lasts one of several times: everything between "
                                       "them was allowed");
        }
    };
    for (std::uint32_t p = 0; p < places; ++p) {
        if (n.place[p].duration != kNoIndex) {
            check_values("place " + std::string(n.places.path(p)),
                         n.durations[n.place[p].duration]);
        }
    }
    for (const DelayTable& d : n.delays) {
        check_values("transition " + std::string(n.transitions.path(d.transition)), d.duration);
    }
    std::vector<bool> unordered(n.rich.size(), false);
    for (std::uint32_t r = 0; r < n.rich.size(); ++r) {
        const std::uint32_t d = n.place[n.rich[r].place].duration;
        unordered[r] = d != kNoIndex && n.durations[d].kind != DurationKind::kConstant &&
                       n.durations[d].kind != DurationKind::kOpen;
    }
    for (const Special& s : n.specials) {
        for (const OutputTable& out : s.outputs) {
            if (out.lasts.valid() && out.rich != kNoIndex) {
                unordered[out.rich] = true;
            }
        }
    }
    for (std::uint32_t r = 0; r < n.rich.size(); ++r) {
        if (unordered[r] && n.rich[r].keeps_order) {
            graph_.why_not.push_back("place " + std::string(n.places.path(n.rich[r].place)) +
                                     " keeps the order of tokens that last differently long");
        }
    }
    for (const Special& s : n.specials) {
        for (const ArcTable& arc : s.arcs) {
            if (arc.rich != kNoIndex && unordered[arc.rich] &&
                (arc.kind == ArcKind::kTakeNow || arc.kind == ArcKind::kReadNow)) {
                graph_.not_exact.push_back(
                    "transition " + std::string(n.transitions.path(s.transition)) +
                    ": any of the waiting tokens of " + std::string(n.places.path(arc.place)) +
                    " was taken for the first");
            }
        }
    }
}

TimedGraph ClassBuilder::make() {
    const World& world = graph_.states->world;
    const NetTables& n = request_.net.tables();
    for (const std::uint32_t e : world.movement_events) {
        graph_.not_exact.push_back("event " + std::string(n.events.path(e)) +
                                   " is raised by a movement: it was tried at any instant");
    }
    if (world.free_sensors.size() > 6) {
        graph_.not_over.emplace_back("more than six sensors change at one instant");
    }
    graph_.assumptions = assumed(world);
    graph_.graph.over = graph_.not_over.empty();
    graph_.graph.exact = graph_.not_exact.empty();
    return build();
}

// What was over is looked up in the state that was left: its numbers are the variables'.
bool ClassBuilder::coincidental(Driver& driver) {
    if (driver.passed().size() < 2) {
        return false;
    }
    collect_waiting(request_.net, graph_.states->decode(graph_.graph.edges.size()), waiting_);
    const std::uint32_t places = request_.net.place_count();
    return std::any_of(waiting_.begin(), waiting_.end(), [&](const Waiting& w) {
        const std::vector<std::int64_t>& over = driver.passed();
        return w.kind != Waiting::kSchedule &&
               drawn_[w.kind == Waiting::kDelay ? places + w.element : w.element] != 0 &&
               std::find(over.begin(), over.end(), w.number) != over.end();
    });
}

void ClassBuilder::follow(const TimedGraph& graph) {
    states_ = graph.states.get();
    graph_.states->world = states_->world;
}

void ClassBuilder::enter(std::uint32_t state) {
    std::size_t at = 0;
    states_->decode(state, nullptr, &at);
    const std::span<const std::uint8_t> bytes = states_->store[state];
    zone_ = Zone(static_cast<std::uint32_t>(get_varint(bytes, at)));
    for (std::uint32_t i = 0; i <= zone_.variables(); ++i) {
        for (std::uint32_t j = 0; j <= zone_.variables(); ++j) {
            zone_.set(i, j, states_->codec.time(static_cast<std::uint32_t>(get_varint(bytes, at))));
        }
    }
}

// Which variables reach 0 first, all together. The first of them by number leads: those before it
// are later, those after it equal or later. Every choice that is offered is possible.
bool ClassBuilder::choose(Driver& driver, std::vector<std::int64_t>& over) {
    const std::uint32_t n = zone_.variables() - (observed_ ? 1 : 0);
    if (n == 0) {
        return false;
    }
    const auto led = [&](std::uint32_t i, Zone& z) {
        for (std::uint32_t j = 1; j <= n; ++j) {
            if (j != i && !z.add(i, j, j < i ? Bound::below(0) : Bound::at_most(0))) {
                return false;
            }
        }
        return true;
    };
    std::vector<std::uint32_t> leaders;
    for (std::uint32_t i = 1; i <= n; ++i) {
        Zone z = zone_;
        if (led(i, z)) {
            leaders.push_back(i);
        }
    }
    // With events from outside time may also end in between.
    const bool between = driver.may_come();
    const auto count = static_cast<std::uint32_t>(leaders.size());
    const std::uint32_t answer = driver.chooser.pick(count + (between ? 1 : 0));
    passed_ = zone_;
    if (answer == count) {
        low_ = 1;
        high_ = SimTime::never().ticks;
        const auto earlier = [&](std::uint32_t i) {
            const std::int64_t most = zone_.bound(i, 0);
            if (most != Bound::kInfinite) {
                passed_.set(i, 0, Bound::below(Bound::limit(most)));
            }
            return most;
        };
        for (std::uint32_t i = 1; i <= n; ++i) {
            const std::int64_t most = earlier(i);
            high_ = most == Bound::kInfinite ? high_ : std::min(high_, Bound::limit(most) - 1);
            passed_.set(0, i, Bound::below(0));
        }
        if (observed_) {
            earlier(n + 1);
            passed_.set(0, n + 1, Bound::kInfinite);
        }
        high_ = std::max(low_, high_);
        return passed_.close() && !(passed_ == zone_);
    }
    const std::uint32_t leader = leaders[answer];
    led(leader, passed_);
    over.push_back(leader);
    for (std::uint32_t j = leader + 1; j <= n; ++j) {
        const bool may_equal = !passed_.would_be_empty(j, leader, Bound::at_most(0));
        const bool may_wait = !passed_.would_be_empty(leader, j, Bound::below(0));
        const bool equal = may_equal && (!may_wait || driver.chooser.pick(2) == 0);
        if (equal) {
            passed_.add(j, leader, Bound::at_most(0));
            over.push_back(j);
        } else {
            passed_.add(leader, j, Bound::below(0));
        }
    }
    const std::int64_t least = passed_.bound(0, leader);
    const std::int64_t most = passed_.bound(leader, 0);
    low_ = -Bound::limit(least) + (Bound::strict(least) ? 1 : 0);
    high_ = most == Bound::kInfinite ? SimTime::never().ticks
                                     : Bound::limit(most) - (Bound::strict(most) ? 1 : 0);
    high_ = std::max(low_, high_);
    passed_.fall_until(leader);
    return true;
}

std::pair<std::int64_t, std::int64_t> ClassBuilder::ticks(const Driver::Step& step) {
    return step.label == Edge::kPass && !driver_->from_outside()
               ? std::pair{low_, high_}
               : std::pair<std::int64_t, std::int64_t>{0, 0};
}

// Variables are numbered as they are met in the marking; alike tokens of one place, which are met
// in any order, by their bounds.
bool ClassBuilder::encode(Driver& driver, const Driver::Step& step,
                          std::vector<std::uint8_t>& out) {
    const bool passed = step.label == Edge::kPass && !driver.from_outside();
    const Zone& before = passed ? passed_ : zone_;
    const std::uint32_t old = before.variables() - (observed_ ? 1 : 0);
    collect_waiting(request_.net, driver.engine.state(), waiting_);
    std::vector<std::int64_t> numbers;
    std::vector<std::uint32_t> group;  // the place of alike tokens; none
    for (const Waiting& w : waiting_) {
        if (std::find(numbers.begin(), numbers.end(), w.number) == numbers.end()) {
            numbers.push_back(w.number);
            group.push_back(w.kind == Waiting::kPlace ? w.element : kNoIndex);
        }
    }
    std::vector<std::uint32_t> from;
    for (const std::int64_t number : numbers) {
        from.push_back(number <= old ? static_cast<std::uint32_t>(number) : Zone::kFresh);
    }
    if (observed_) {
        from.push_back(old + 1);
    }
    Zone zone = before.chosen(from);
    for (const Driver::Begun& b : driver.begun()) {
        const auto at = std::find(numbers.begin(), numbers.end(), b.number);
        if (at != numbers.end()) {
            const auto i = static_cast<std::uint32_t>(at - numbers.begin()) + 1;
            zone.set(i, 0, Bound::at_most(b.high));
            zone.set(0, i, b.low == 0 ? Bound::below(0) : Bound::at_most(-b.low));
        }
    }
    for (std::uint32_t i = 1; i <= zone.variables(); ++i) {
        for (std::uint32_t j = 1; j <= zone.variables(); ++j) {
            if (i != j && (from[i - 1] == Zone::kFresh || from[j - 1] == Zone::kFresh)) {
                zone.set(i, j, Bound::add(zone.bound(i, 0), zone.bound(0, j)));
            }
        }
    }
    std::vector<std::uint32_t> order;
    for (std::uint32_t i = 1; i <= zone.variables(); ++i) {
        order.push_back(i);
    }
    for (std::size_t i = 0; i < numbers.size();) {
        std::size_t end = i + 1;
        while (end < numbers.size() && group[i] != kNoIndex && group[end] == group[i]) {
            ++end;
        }
        std::stable_sort(order.begin() + static_cast<std::ptrdiff_t>(i),
                         order.begin() + static_cast<std::ptrdiff_t>(end),
                         [&zone](std::uint32_t a, std::uint32_t b) {
                             return std::pair{zone.bound(a, 0), zone.bound(0, a)} <
                                    std::pair{zone.bound(b, 0), zone.bound(0, b)};
                         });
        i = end;
    }
    track_.zone = zone.chosen(order);
    track_.numbers.clear();
    std::unordered_map<std::int64_t, std::uint32_t> variables;
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        const std::int64_t number = numbers[order[i] - 1];
        variables[number] = static_cast<std::uint32_t>(i);
        track_.numbers.push_back(number);
    }
    if (!keep(driver, step, track_.zone)) {
        return false;
    }
    states_->encode(driver, out, &variables);
    put_varint(out, track_.zone.variables());
    for (const std::int64_t b : track_.zone.bounds()) {
        put_varint(out, states_->codec.intern(b));
    }
    if (mark_) {
        out.push_back(kMark);
    }
    return true;
}

bool ClassBuilder::is_at(const Driver::Step& step, std::span<const std::uint8_t> state) {
    std::vector<std::uint8_t> bytes;
    if (!encode(*driver_, step, bytes)) {
        return false;
    }
    const bool marked = state.size() == bytes.size() + 1 && state.back() == kMark;
    return std::equal(bytes.begin(), bytes.end(), state.begin(), state.end() - (marked ? 1 : 0));
}

}  // namespace puppetri::proof
