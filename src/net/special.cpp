// SPDX-License-Identifier: MIT
// Transitions with more to them than counts: guards, bindings, delays, events, data. They are
// `touched` when something that they depend on changes, and looked at again twice per firing: in
// the intermediate marking (after taking, before giving), where they can only stop being marked,
// and after it.
#include <algorithm>

#include "puppetri/net/engine.h"

namespace puppetri::net {

void Engine::touch(std::uint32_t t) {
    const std::uint32_t s = tables_->transition[t].special;
    if (touched_[s] == 0) {
        touched_[s] = 1;
        touch_list_.push_back(t);
    }
}

bool Engine::guard_holds(const Special& s) {
    if (!s.guard.valid()) {
        return true;
    }
    const Evaluated e = tables_->code.evaluate(s.guard, *this);
    if (e.fault != EvalFault::kNone) {
        if (!quiet_) {
            fail_transition(s.transition, "evaluation-fault",
                            std::string("its guard fails: ") + name_of(e.fault),
                            "ask first whether it can be computed: `n > 0 and 1 / n < 2`");
        }
        return false;
    }
    return e.value != 0;
}

// Arcs and guard are satisfied. In the intermediate marking a fault is a no: nobody asked for that
// marking.
bool Engine::marked(const Special& s, bool intermediate) {
    if (hot_[s.transition].unsatisfied != 0) {
        return false;
    }
    if (!s.searches && !s.guard.valid()) {
        return true;
    }
    quiet_ = intermediate;
    const bool yes = s.searches ? bind(s, false) : guard_holds(s);
    quiet_ = false;
    return yes;
}

// How often a transition could fire side by side with itself.
std::uint32_t Engine::degree(const Special& s) const {
    std::uint32_t least = kNoIndex;
    for (const Weighted& w : s.degree) {
        least = std::min(least, state_.counts[w.place].ready / w.weight);
    }
    for (const Weighted& w : s.degree_now) {
        least = std::min(least, state_.counts[w.place].total / w.weight);
    }
    return least == kNoIndex ? 1 : least;
}

bool Engine::offered_to(const Special& s) const {
    return state_.offered != kNoIndex && !state_.offer_consumed &&
           std::find(s.events.begin(), s.events.end(), state_.offered) != s.events.end() &&
           std::find(state_.offer_users.begin(), state_.offer_users.end(), s.transition) ==
               state_.offer_users.end();
}

void Engine::gate_closed(std::uint32_t t) {
    const std::uint32_t number = tables_->transition[t].special;
    leave(t);
    if (marked_[number] != 0) {
        marked_[number] = 0;
        miss_offer(tables_->specials[number]);
        if (tables_->specials[number].delay != kNoIndex) {
            set_clocks(tables_->specials[number].delay, 0);
        }
    }
}

void Engine::look_again(bool intermediate) {
    for (std::size_t i = 0; i < touch_list_.size() && !faulted_; ++i) {
        const std::uint32_t t = touch_list_[i];
        const std::uint32_t number = tables_->transition[t].special;
        const Special& s = tables_->specials[number];
        if ((tables_->transition[t].flags & kOnlyDelayed) != 0) {
            if (!intermediate) {
                look_at_delay(t, number, s.delay);
            }
            continue;  // in the intermediate marking its arcs have closed it already
        }
        const bool yes = marked(s, intermediate);
        if (intermediate) {
            if (!yes) {
                gate_closed(t);
            } else if (marked_[number] != 0 && s.delay != kNoIndex &&
                       !(s.degree.empty() && s.degree_now.empty())) {
                set_clocks(s.delay, std::min(degree(s), running_clocks(s.delay)));
            }
            continue;
        }
        touched_[number] = 0;
        if (!yes) {
            gate_closed(t);
            continue;
        }
        marked_[number] = 1;
        bool fires = s.events.empty() || offered_to(s);
        if (s.delay != kNoIndex) {
            set_clocks(s.delay, degree(s));
            const auto& clocks = state_.clocks[s.delay];
            fires = fires && std::any_of(clocks.begin(), clocks.end(),
                                         [](const Clock& c) { return c.phase == Clock::kDue; });
        }
        if (!fires) {
            leave(t);
            continue;
        }
        if (s.odds.valid()) {
            const double w = odds(t);
            if (w != last_odds_[number]) {
                leave(t);  // changed odds draw again
                last_odds_[number] = w;
            }
        }
        if ((hot_[t].candidate & 3) == 0) {
            enter(t);
        }
    }
    if (!intermediate) {
        touch_list_.clear();
    }
}

double Engine::odds(std::uint32_t t) {
    if ((tables_->transition[t].flags & kHasOdds) == 0) {
        return 1;
    }
    const Special& s = tables_->specials[tables_->transition[t].special];
    if (!s.odds.valid()) {
        return s.constant_odds;
    }
    // Variables in odds are those of the transition's binding.
    if (s.searches) {
        bind(s, false);
    }
    Value v = 0;
    if (!evaluate(s.odds, v)) {
        fail_transition(t, "evaluation-fault", "its odds cannot be computed",
                        "mend the expression");
        return 1;
    }
    const double w = s.odds_is_int ? static_cast<double>(v) : real_of_value(v);
    if (!(w > 0)) {
        fail_transition(t, "odds-not-positive", "its odds are not above 0",
                        "use a guard for what may not fire");
        return 1;
    }
    return w;
}

// -- delays
// ----------------------------------------------------------------------------------------------------------

std::uint32_t Engine::running_clocks(std::uint32_t delay) const {
    std::uint32_t n = 0;
    for (const Clock& c : state_.clocks[delay]) {
        n += c.phase != Clock::kSuspended ? 1 : 0;
    }
    return n;
}

bool Engine::start_clock(std::uint32_t delay, std::int64_t ticks) {
    Clock clock;
    if (!ends_at(ticks, clock.at)) {
        fail_transition(tables_->delays[delay].transition, "time-overflow",
                        "its delay ends after the end of time", "shorten it");
        return false;
    }
    clock.phase = ticks == 0 ? Clock::kDue : Clock::kRunning;
    state_.clocks[delay].push_back(clock);
    if (ticks != 0) {
        state_.heap.push({clock.at, Pending::kDelay | delay, 0});
    }
    return true;
}

// The short way for one clock without memory and nothing else.
void Engine::look_at_delay(std::uint32_t t, std::uint32_t number, std::uint32_t delay) {
    touched_[number] = 0;
    if (hot_[t].unsatisfied != 0) {
        gate_closed(t);
        return;
    }
    marked_[number] = 1;
    if (state_.clocks[delay].empty()) {
        std::int64_t ticks = 0;
        if (!draw(tables_->delays[delay].duration, delay_keys_[delay], state_.delay_draws[delay],
                  delay_ahead_[delay], ChoiceKind::kDelay, t, ticks) ||
            !start_clock(delay, ticks)) {
            return;
        }
    }
    if (state_.clocks[delay][0].phase == Clock::kDue && (hot_[t].candidate & 3) == 0) {
        enter(t);
    }
}

// Brings the number of clocks that run or have run out to `wanted`, at most one per server. The
// youngest stop first; with memory `age` they keep what is left and go on, the last stopped first.
void Engine::set_clocks(std::uint32_t delay, std::uint32_t wanted) {
    const DelayTable& d = tables_->delays[delay];
    std::vector<Clock>& clocks = state_.clocks[delay];
    wanted = std::min(wanted, d.servers);
    std::uint32_t active = running_clocks(delay);
    while (active > wanted) {
        const auto youngest = std::find_if(clocks.rbegin(), clocks.rend(), [](const Clock& c) {
            return c.phase != Clock::kSuspended;
        });
        if (d.memory == DelayMemory::kAge) {
            youngest->at = youngest->phase == Clock::kDue ? 0
                           : waits(youngest->at)          ? youngest->at
                                                          : youngest->at - state_.now;
            youngest->phase = Clock::kSuspended;
        } else {
            clocks.erase(std::next(youngest).base());
        }
        --active;
    }
    while (active < wanted && !faulted_) {
        const auto suspended = std::find_if(clocks.begin(), clocks.end(), [](const Clock& c) {
            return c.phase == Clock::kSuspended;
        });
        std::int64_t ticks = 0;
        if (suspended != clocks.end()) {
            ticks = suspended->at;
            clocks.erase(suspended);
        } else {
            const Special& s = tables_->specials[tables_->transition[d.transition].special];
            if (s.searches) {
                bind(s, false);
            }
            if (!draw(d.duration, delay_keys_[delay], state_.delay_draws[delay],
                      delay_ahead_[delay], ChoiceKind::kDelay, d.transition, ticks)) {
                return;
            }
        }
        if (!start_clock(delay, ticks)) {
            return;
        }
        ++active;
    }
}

void Engine::resample() {
    for (const std::uint32_t number : resampled_) {
        state_.clocks[tables_->specials[number].delay].clear();
        touch(tables_->specials[number].transition);
    }
}

// -- firing
// ----------------------------------------------------------------------------------------------------------

bool Engine::module_is_clean(const Special& s) {
    for (const std::uint32_t number : s.must_be_clean) {
        for (const PlaceIndex inside : tables_->refinements[number].inside) {
            if (state_.counts[inside.value].total != 0) {
                fail_place(inside.value, "module-not-clean",
                           "a token is left inside when its module ends, at " +
                               std::string(tables_->transitions.path(s.transition)),
                           "let the module take all its tokens before its finish");
                return false;
            }
        }
    }
    return true;
}

// Everything of the new state that reads the old one is computed before anything changes.
void Engine::fire_special(std::uint32_t t) {
    const Special& s = tables_->specials[tables_->transition[t].special];
    chosen_.clear();
    if (!s.arcs.empty() && !bind(s, true)) {
        if (!faulted_) {
            fail_transition(t, "internal", "a fireable transition has no binding", "report this");
        }
        return;
    }
    if (options_.listener != nullptr) {
        options_.listener->fires({state_.now}, {t}, *this);
    }
    assigned_.clear();
    for (const auto& [datum, program] : s.assignments) {
        const DatumDraft& d = tables_->declarations.data[datum];
        Value v = 0;
        if (!evaluate(program, v)) {
            fail_transition(t, "evaluation-fault",
                            "what it sets " + d.path + " to cannot be computed",
                            "mend the expression");
            return;
        }
        const bool real = d.type.kind == ValueKind::kReal;
        const auto less = [real](Value a, Value b) {
            return real ? real_of_value(a) < real_of_value(b) : a < b;
        };
        if ((d.low && less(v, *d.low)) || (d.high && less(*d.high, v))) {
            fail_transition(t, "range-left", d.path + " would leave its range",
                            "widen the range, or guard the transition");
            return;
        }
        assigned_.push_back(v);
    }
    given_.clear();
    for (const OutputTable& out : s.outputs) {
        for (const ProgramIndex program : out.attributes) {
            Value v = 0;
            if (!evaluate(program, v)) {
                fail_transition(t, "evaluation-fault", "an attribute cannot be computed",
                                "mend the expression");
                return;
            }
            given_.push_back(v);
        }
        if (out.lasts.valid()) {
            Value v = 0;
            if (!evaluate(out.lasts, v) || v < 0) {
                fail_place(out.place, "negative-duration", "a duration is negative or no number",
                           "give 0 or more");
                return;
            }
            given_.push_back(v);
        }
    }
    if (!s.events.empty()) {
        use_offer(s);
    }
    if (s.delay != kNoIndex) {
        auto& clocks = state_.clocks[s.delay];
        const auto due = std::find_if(clocks.begin(), clocks.end(),
                                      [](const Clock& c) { return c.phase == Clock::kDue; });
        if (due != clocks.end()) {
            clocks.erase(due);
        }
    }

    take_plain(t);
    for (std::size_t i = 0; i < chosen_.size(); ++i) {
        const Chosen c = chosen_[i];
        if (c.kind <= ArcKind::kTakeAllNow) {
            remove_token(c.rich, c.slot,
                         c.kind == ArcKind::kTakeNow || c.kind == ArcKind::kTakeAllNow);
        }
    }
    for (const ArcTable& arc : s.arcs) {
        if (arc.rich == kNoIndex) {  // `all` of a place without records
            Counts& c = state_.counts[arc.place];
            const Counts was = c;
            c.total -= was.ready;
            c.ready = 0;
            change_ready(arc.place, was.ready, 0);
            if (tables_->place[arc.place].kind != PlaceKind::kCount) {
                change_total(arc.place, was.total, was.total - was.ready);
            }
        }
    }
    if (!module_is_clean(s)) {
        return;
    }
    touch(t);
    look_again(true);

    for (std::size_t i = 0; i < s.assignments.size(); ++i) {
        const std::uint32_t datum = s.assignments[i].first;
        if (state_.data[datum] != assigned_[i]) {
            state_.data[datum] = assigned_[i];
            for (const std::uint32_t d : tables_->datum_dependents.row(datum)) {
                touch(d);
            }
        }
    }
    give_plain(t);
    std::size_t next = 0;
    for (const OutputTable& out : s.outputs) {
        if (faulted_) {
            return;
        }
        give_special(out, next);
        next += out.attributes.size() + (out.lasts.valid() ? 1 : 0);
    }
    for (const std::uint32_t e : s.raises) {
        Occurrence o;
        o.at = state_.now;
        o.origin = Occurrence::kRaised;
        o.event = e;
        push_occurrence(o);
    }
    finish_firing(t);
}

}  // namespace puppetri::net
