// SPDX-License-Identifier: MIT
#include "driver.h"

#include <algorithm>
#include <utility>

#include "puppetri/base/require.h"
#include "puppetri/net/tables.h"

namespace puppetri::proof {

using namespace net;

TickRange movement_range(const World& world, std::uint32_t place) {
    const ActionIndex action = world.net->action({place});
    TickRange range;
    if (!action.valid() || action.value >= world.actions.size()) {
        return range;
    }
    // As the engine does: up to a whole millisecond.
    const auto up = [](std::int64_t ticks) {
        const std::int64_t rest = ticks % kTicksPerMillisecond;
        return rest == 0 || ticks > kWaiting ? ticks : ticks - rest + kTicksPerMillisecond;
    };
    range = world.actions[action.value];
    range.low = up(std::max<std::int64_t>(0, range.low));
    range.high = up(range.high);
    return range;
}

EngineOptions Driver::options() {
    EngineOptions o;
    if (form_ == ClockForm::kExact) {
        o.host = this;
        o.beat = world_->beat;
    } else {
        o.timekeeper = this;
        o.beat = 0;
    }
    return o;
}

Driver::Driver(const World& world, ClockForm form)
    : world_(&world), form_(form), engine(*world.net, chooser, options()) {}

void Driver::start() {
    begun_.clear();
    passed_.clear();
    movements.clear();
    next_number_ = 1;
    outside = 0;
    engine.start();
}

void Driver::restore(State state, std::uint32_t outside_so_far) {
    begun_.clear();
    passed_.clear();
    outside = outside_so_far;
    // Numbers that decode() gave are small, and as many as there are things that wait.
    next_number_ = std::int64_t{1} << 32;
    engine.restore(std::move(state));
}

std::int64_t Driver::begin(Kind kind, std::uint32_t element, SimTime low, SimTime high) {
    std::int64_t least = low.ticks;
    std::int64_t most = high.ticks;
    if (kind == Kind::kToken) {
        const NetTables& n = world_->net->tables();
        const std::uint32_t d = n.place[element].duration;
        if (d != kNoIndex && n.durations[d].kind == DurationKind::kAuto && most > kWaiting) {
            const TickRange range = movement_range(*world_, element);
            least = range.low;
            most = range.high;
        }
    }
    Begun b{kind, element, 0, least, most};
    if (most > 0 && (least > 0 || waits_always_ || chooser.pick(2) != 0)) {
        b.number = next_number_++;
    }
    begun_.push_back(b);
    return b.number;
}

SimTime Driver::begin(ActionIndex action, ActivityIndex, SimTime, SimTime duration,
                      std::span<const std::int64_t>) {
    if (duration.ticks >= 0) {
        movements.push_back(duration);
        return duration;
    }
    TickRange range;
    if (action.value < world_->actions.size()) {
        range = world_->actions[action.value];
    }
    const std::int64_t ticks =
        range.low == range.high || chooser.pick(2) == 0 ? range.low : range.high;
    movements.push_back({ticks});
    return {ticks};
}

// Everything has settled but what firings of this instant have raised: events of the same instant
// from outside and of movements come before that.
bool Driver::raised_is_next() const {
    const State& s = engine.state();
    if (s.offered != kNoIndex || s.occurrences.empty() || s.occurrences.front().at > s.now ||
        s.occurrences.front().origin != Occurrence::kRaised) {
        return false;
    }
    for (std::uint32_t t = 0; t < world_->net->transition_count(); ++t) {
        if (engine.fireable({t})) {
            return false;
        }
    }
    return true;
}

// The outside may act in an instant that has settled. True: it does.
bool Driver::ask_outside(Step& out) {
    const std::uint32_t outer = outer_events();
    const auto events = outer + static_cast<std::uint32_t>(world_->movement_events.size());
    const auto sensors = static_cast<std::uint32_t>(world_->free_sensors.size());
    // All sensors at once; of too many one at a time.
    const std::uint32_t settings = sensors == 0 ? 0 : sensors <= 6u ? (1u << sensors) - 1 : sensors;
    const std::uint32_t answer = chooser.pick(1 + events + settings);
    if (answer == 0) {
        return false;
    }
    from_outside_ = true;
    if (answer <= events) {
        const bool from_there = answer <= outer;
        const std::uint32_t e = from_there ? world_->outer_events[answer - 1]
                                           : world_->movement_events[answer - outer - 1];
        outside += !from_there || world_->outside_events == GraphRequest::kAnyNumber ? 0 : 1;
        engine.occur({e}, {engine.state().now});
        engine.turn();
        out.label = Edge::kEvent | e;
        return true;
    }
    const std::uint32_t which = answer - events;
    State s = engine.save();
    for (std::uint32_t i = 0; i < sensors; ++i) {
        if (sensors <= 6u ? ((which >> i) & 1) != 0 : which == i + 1) {
            s.data[world_->free_sensors[i]] ^= 1;
        }
    }
    engine.restore(std::move(s));
    out.label = Edge::kPass;
    return true;
}

Driver::Did Driver::step(Step& out) {
    out = Step{};
    settled_ = false;
    idle_ = false;
    from_outside_ = false;
    passed_.clear();
    if (engine.faulted()) {
        return Did::kFault;
    }
    for (;;) {
        const std::int64_t before = engine.state().now;
        if (raised_is_next() && ask_outside(out)) {
            return engine.faulted() ? Did::kFault : Did::kStep;
        }
        if (engine.settled()) {
            settled_ = true;
            if (form_ != ClockForm::kExact) {
                idle_ = engine.next_time() == SimTime::never().ticks;
                if (ask_outside(out)) {
                    return engine.faulted() ? Did::kFault : Did::kStep;
                }
                std::vector<std::int64_t> over;
                if (idle_ || !chooses_(context_, *this, over)) {
                    return Did::kDead;
                }
                passed_ = over;
                engine.pass(over);
                out.label = Edge::kPass;
                return engine.faulted() ? Did::kFault : Did::kStep;
            }
            idle_ = engine.next_time() == SimTime::never().ticks;
            if (ask_outside(out)) {
                return engine.faulted() ? Did::kFault : Did::kStep;
            }
        }
        switch (engine.turn()) {
            case Engine::Turn::kFired:
                out.label = engine.state().last;
                return Did::kStep;
            case Engine::Turn::kOffered:
                out.label = Edge::kEvent | engine.state().offered;
                return Did::kStep;
            case Engine::Turn::kOfferEnded:
            case Engine::Turn::kAsked:
                continue;
            case Engine::Turn::kPassed:
                out.ticks += engine.state().now - before;
                if (!settled_) {  // a paced net waits for its beat, then fires
                    settled_ = true;
                    continue;
                }
                out.label = Edge::kPass;
                return Did::kStep;
            case Engine::Turn::kWaits:
            case Engine::Turn::kDead:
                return Did::kDead;
            case Engine::Turn::kFault:
                return Did::kFault;
        }
    }
}

}  // namespace puppetri::proof
