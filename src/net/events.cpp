// SPDX-License-Identifier: MIT
// Occurrences of events: offered one at a time, after everything of the instant has settled. Those
// from outside come first, in file order, then those of movements by the path of their place, then
// raised ones in firing order.
#include <algorithm>

#include "heap.h"
#include "puppetri/base/require.h"
#include "puppetri/net/engine.h"

namespace puppetri::net {

bool Occurrence::before(const Occurrence& o) const {
    if (at != o.at) {
        return at < o.at;
    }
    if (origin != o.origin) {
        return origin < o.origin;
    }
    if (rank != o.rank) {
        return rank < o.rank;
    }
    return sequence < o.sequence;
}

namespace {
bool sooner(const Occurrence& a, const Occurrence& b) { return a.before(b); }
}  // namespace

void Engine::occur(EventIndex event, SimTime at) {
    PUP_REQUIRE(event.value < tables_->events.size() && at.ticks >= state_.now);
    Occurrence o;
    o.at = at.ticks;
    o.event = event.value;
    push_occurrence(o);
}

void Engine::push_occurrence(Occurrence o) {
    o.sequence = state_.sequences++;
    heap_push<2>(state_.occurrences, o, sooner);
}

bool Engine::occurrence_pending_now() const {
    return !state_.occurrences.empty() && state_.occurrences.front().at <= state_.now;
}

// Needs an occurrence of now or before, and nothing offered.
void Engine::offer_first() {
    const Occurrence o = state_.occurrences.front();
    heap_pop<2>(state_.occurrences, sooner);
    if (o.every != 0) {
        Occurrence again = o;
        const std::int64_t ticks =
            options_.timekeeper == nullptr
                ? o.every
                : wait(Timekeeper::Kind::kSchedule, o.event, o.every, o.every);
        if (waits(ticks)) {
            again.at = ticks;
            heap_push<2>(state_.occurrences, again, sooner);
        } else if (!__builtin_add_overflow(o.at, o.every, &again.at)) {
            heap_push<2>(state_.occurrences, again, sooner);  // keeps its place in the file's order
        }
    }
    state_.offered = o.event;
    state_.offer_used = false;
    state_.offer_consumed = false;
    state_.offer_users.clear();
    if (options_.listener != nullptr) {
        options_.listener->occurs({state_.now}, {o.event});
    }
    const EventDraft& e = tables_->declarations.events[o.event];
    if (e.sets.valid()) {
        state_.offer_used = true;
        const Value v = e.sets_to ? 1 : 0;
        if (state_.data[e.sets.value] != v) {
            state_.data[e.sets.value] = v;
            for (const std::uint32_t t : tables_->datum_dependents.row(e.sets.value)) {
                touch(t);
            }
        }
    }
    if (e.makes_ready.valid()) {
        make_ready(e.makes_ready.value);
    }
    for (const std::uint32_t t : tables_->event_listeners.row(o.event)) {
        touch(t);
    }
    look_again(false);
    // Who hears only the next occurrence must have waited for it when it came.
    for (const std::uint32_t t : tables_->event_listeners.row(o.event)) {
        const std::uint32_t number = tables_->transition[t].special;
        if (marked_[number] == 0) {
            miss_offer(tables_->specials[number]);
        }
    }
}

// From now on this occurrence is none for a transition that hears only the next one.
void Engine::miss_offer(const Special& s) {
    if (s.next_event && offered_to(s)) {
        state_.offer_users.push_back(s.transition);
    }
}

// Free runs: the instant has settled; does the outside do something before time passes? True: it
// did. Sensors are asked once per settled marking, events again after each that occurs.
bool Engine::ask_outside() {
    if (random_ || (state_.asked_at == state_.now && state_.asked_firings == state_.firings)) {
        return false;
    }
    Choice choice;
    if (state_.free_events < options_.free_events && !outside_events_.empty()) {
        choice.kind = ChoiceKind::kEvent;
        choice.element = kNoIndex;
        choice.options = static_cast<std::uint32_t>(outside_events_.size()) + 1;
        const std::int64_t answer = chooser_->choose(choice);
        PUP_REQUIRE(answer >= 0 && answer < choice.options);
        if (answer > 0) {
            ++state_.free_events;
            occur({outside_events_[static_cast<std::size_t>(answer) - 1]}, {state_.now});
            return true;
        }
    }
    state_.asked_at = state_.now;
    state_.asked_firings = state_.firings;
    bool changed = false;
    for (const std::uint32_t d : free_sensors_) {
        choice.kind = ChoiceKind::kFreeGuard;
        choice.element = d;
        choice.options = 2;
        const std::int64_t answer = chooser_->choose(choice);
        PUP_REQUIRE(answer == 0 || answer == 1);
        if (state_.data[d] != answer) {
            state_.data[d] = answer;
            changed = true;
            for (const std::uint32_t t : tables_->datum_dependents.row(d)) {
                touch(t);
            }
        }
    }
    if (changed) {
        look_again(false);
    }
    return changed;
}

// A transition fires with the occurrence that is offered.
void Engine::use_offer(const Special& s) {
    state_.offer_used = true;
    state_.offer_users.push_back(s.transition);
    if (tables_->declarations.events[state_.offered].consumed) {
        state_.offer_consumed = true;
        for (const std::uint32_t t : tables_->event_listeners.row(state_.offered)) {
            touch(t);
        }
    }
}

void Engine::end_offer() {
    const std::uint32_t event = state_.offered;
    state_.offered = kNoIndex;
    if (!state_.offer_used) {
        if (options_.listener != nullptr) {
            options_.listener->lost({state_.now}, {event});
        }
        note("lost-event", "event " + std::string(tables_->events.path(event)), "nothing used it");
    }
    for (const std::uint32_t t : tables_->event_listeners.row(event)) {
        touch(t);
    }
    look_again(false);
}

// A movement was cut: what it would have raised later does not happen.
void Engine::forget_activity(std::uint32_t activity) {
    const std::size_t before = state_.occurrences.size();
    std::erase_if(state_.occurrences, [&](const Occurrence& o) {
        return o.origin == Occurrence::kMovement && o.activity == activity && o.at > state_.now;
    });
    if (state_.occurrences.size() != before) {
        std::sort(state_.occurrences.begin(), state_.occurrences.end(),
                  sooner);  // sorted is a heap
    }
}

}  // namespace puppetri::net
