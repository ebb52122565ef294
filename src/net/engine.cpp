// SPDX-License-Identifier: MIT
// The heart: who may fire, who does, what it changes, and when time goes on. Transitions are
// counted down: each knows how many of its conditions on counts do not hold, and a place tells only
// those whose threshold it crosses. What is not plain is in special.cpp, binding.cpp, tokens.cpp,
// events.cpp.
#include "puppetri/net/engine.h"

#include <algorithm>

#include "heap.h"
#include "puppetri/base/require.h"
#include "puppetri/net/log_hash.h"

namespace puppetri::net {

namespace {

constexpr auto earlier = [](const Pending& a, const Pending& b) { return a.at < b.at; };

}  // namespace

void PendingRing::grow() {
    std::vector<Pending> bigger(items.empty() ? 4 : 2 * items.size());
    for (std::uint32_t i = 0; i < size; ++i) {
        bigger[i] = at(i);
    }
    items.swap(bigger);
    head = 0;
}

void PendingHeap::push(const Pending& p) { heap_push<4>(items, p, earlier); }
void PendingHeap::pop() { heap_pop<4>(items, earlier); }

Engine::Engine(const Net& net, Chooser& chooser, const EngineOptions& options)
    : net_(&net),
      tables_(&net.tables()),
      chooser_(&chooser),
      random_(chooser.draws_from_streams()),
      options_(options),
      flip_(options.antithetic ? ~std::uint64_t{0} : 0) {
    const NetTables& n = *tables_;
    const std::uint64_t seed = options.seed;
    hot_.resize(n.transitions.size());
    for (std::uint32_t t = 0; t < n.transitions.size(); ++t) {
        const TransitionRow& row = n.transition[t];
        hot_[t].path_hash = hash_text(n.transitions.path(t));
        hot_[t].takes = row.takes;
        hot_[t].gives = row.gives;
        hot_[t].end = n.transition[t + 1].takes;
        hot_[t].level = row.level;
        hot_[t].flags = row.flags;
        for (std::uint32_t i = row.takes; i < hot_[t].end && i < row.takes + 2; ++i) {
            hot_[t].few[i - row.takes] = n.arcs[i];
        }
        hot_[t].ticket_key = random_ ? stream_key(seed, n.transitions.path(t), "ticket") : 0;
    }
    const auto ahead = [this](const DurationTable& d) {
        if (d.kind != DurationKind::kDistribution || d.constants.size() != 1 ||
            d.distribution != DistributionKind::kExponential) {
            return kNoIndex;
        }
        ahead_.emplace_back();
        return static_cast<std::uint32_t>(ahead_.size()) - 1;
    };
    for (const std::uint32_t p : n.stream_place) {
        duration_keys_.push_back(stream_key(seed, n.places.path(p), "duration"));
        duration_ahead_.push_back(ahead(n.durations[n.place[p].duration]));
    }
    for (const std::uint32_t p : n.token_stream_place) {
        token_keys_.push_back(stream_key(seed, n.places.path(p), "token"));
    }
    for (const DelayTable& d : n.delays) {
        delay_keys_.push_back(stream_key(seed, n.transitions.path(d.transition), "delay"));
        delay_ahead_.push_back(ahead(d.duration));
    }
    if (options.free && !random_) {
        std::vector<bool> set(n.data.size(), false);
        for (std::uint32_t e = 0; e < n.events.size(); ++e) {
            const EventDraft& event = n.declarations.events[e];
            if (event.sets.valid()) {
                set[event.sets.value] = true;
            }
            if (event.outside) {
                outside_events_.push_back(e);
            }
        }
        std::sort(outside_events_.begin(), outside_events_.end(),
                  [&](auto a, auto b) { return n.events.rank(a) < n.events.rank(b); });
        for (std::uint32_t d = 0; d < n.data.size(); ++d) {
            if (n.declarations.data[d].sensor && !set[d]) {
                free_sensors_.push_back(d);
            }
        }
    }
    std::uint32_t variables = 0;
    for (std::uint32_t s = 0; s < n.specials.size(); ++s) {
        const Special& special = n.specials[s];
        variables = std::max(variables, special.variables);
        if (special.delay != kNoIndex && n.delays[special.delay].memory == DelayMemory::kResample) {
            resampled_.push_back(s);
        }
    }
    variables_.resize(variables);
    bound_.resize(variables);
    for (const DurationTable& d : n.durations) {
        if (d.kind == DurationKind::kAs) {
            sibling_ticks_.resize(n.places.size());
        }
    }
    if (options.timekeeper != nullptr) {
        PUP_REQUIRE(!random_ && options.host == nullptr);
        collect_unordered();
    }
}

void Engine::start() {
    const NetTables& n = *tables_;
    state_ = State{};
    faulted_ = false;
    state_.counts.resize(n.places.size());
    for (const DatumDraft& d : n.declarations.data) {
        state_.data.push_back(d.initial);
    }
    state_.rich.resize(n.rich.size());
    state_.rings.resize(n.fifo_ticks.size());
    state_.clocks.resize(n.delays.size());
    state_.lotteries.resize(n.level_priority.size());
    state_.duration_draws.resize(n.duration_streams);
    state_.delay_draws.resize(n.delays.size());
    state_.token_draws.resize(n.token_streams);
    rebuild();
    start_marking();
    for (const ScheduledEvent& s : n.declarations.schedule) {
        Occurrence o;
        o.at = options_.timekeeper == nullptr || s.at.ticks == 0
                   ? s.at.ticks
                   : wait(Timekeeper::Kind::kSchedule, s.event.value, s.at.ticks, s.at.ticks);
        o.event = s.event.value;
        o.every = s.every ? s.every->ticks : 0;
        push_occurrence(o);
    }
    look_again(false);
}

void Engine::restore(State state) {
    PUP_REQUIRE(state.counts.size() == tables_->places.size());
    state_ = std::move(state);
    faulted_ = false;
    rebuild();
    for (std::uint32_t t = 0; t < state_.ticket_draws.size(); ++t) {
        hot_[t].ticket_draws = state_.ticket_draws[t];
    }
    look_again(false);
    // Losers of this instant get their tickets back.
    for (std::uint32_t l = 0; l < state_.lotteries.size(); ++l) {
        std::vector<Ticket> tickets;
        tickets.swap(state_.lotteries[l].tickets);
        const double clock = state_.lotteries[l].clock;
        for (Ticket ticket : tickets) {
            Hot& h = hot_[ticket.transition];
            if ((h.candidate & kStatus) != kFresh) {
                continue;
            }
            leave(ticket.transition);
            h.candidate |= kRaced;
            ++levels_[l].live_raced;
            ticket.stamp = h.candidate;
            state_.lotteries[l].tickets.push_back(ticket);
        }
        std::sort(state_.lotteries[l].tickets.begin(), state_.lotteries[l].tickets.end(),
                  [](const Ticket& a, const Ticket& b) { return a.key < b.key; });
        state_.lotteries[l].clock = levels_[l].live_raced != 0 ? clock : 0;
    }
}

State Engine::save() const {
    State s = state_;
    s.ticket_draws.clear();
    for (std::uint32_t t = 0; t < hot_.size() && random_; ++t) {
        s.ticket_draws.push_back(hot_[t].ticket_draws);
    }
    for (Lottery& l : s.lotteries) {
        settle_lottery(l);
        std::erase_if(l.tickets,
                      [this](const Ticket& t) { return hot_[t.transition].candidate != t.stamp; });
        std::sort(l.tickets.begin(), l.tickets.end(), [](const Ticket& a, const Ticket& b) {
            return a.key != b.key ? a.key < b.key : a.transition < b.transition;
        });
    }
    return s;
}

// Conditions, candidates and gates from the state.
void Engine::rebuild() {
    const NetTables& n = *tables_;
    for (Hot& h : hot_) {
        h.unsatisfied = 0;
        h.candidate = 0;
        h.ticket_draws = 0;
    }
    levels_.assign(n.level_priority.size(), Level{});
    if (levels_.size() <= 64) {
        const std::size_t few = std::min<std::size_t>(64, n.transitions.size());
        for (std::uint32_t l = 0; l < levels_.size(); ++l) {
            levels_[l].fresh.reserve(2 * few + 65);  // see enter()
            state_.lotteries[l].run.reserve(few);
            state_.lotteries[l].tickets.reserve(2 * few);
        }
    }
    marked_.assign(n.specials.size(), 0);
    touched_.assign(n.specials.size(), 0);
    last_odds_.assign(n.specials.size(), 1);
    touch_list_.clear();
    instant_log_.clear();
    const auto count = [this](std::span<const Watcher> row, std::uint32_t tokens) {
        for (const Watcher& w : row) {
            const bool holds = (tokens >= w.threshold) != w.inhibits();
            hot_[w.transition()].unsatisfied += holds ? 0 : 1;
        }
    };
    for (std::uint32_t p = 0; p < n.places.size(); ++p) {
        count(n.ready_watchers(p), state_.counts[p].ready);
        count(n.total_watchers(p), state_.counts[p].total);
    }
    for (std::uint32_t t = 0; t < n.transitions.size(); ++t) {
        if (hot_[t].flags != 0) {
            touch(t);
        } else if (hot_[t].unsatisfied == 0) {
            enter(t);
        }
    }
}

void Engine::enter(std::uint32_t t) {
    Hot& h = hot_[t];
    h.candidate |= kFresh;
    Level& l = levels_[level_of(t)];
    if (l.fresh.size() > 2 * l.live_fresh + 64) {
        std::erase_if(l.fresh,
                      [this](const Fresh& f) { return hot_[f.transition].candidate != f.stamp; });
    }
    l.fresh.push_back({t, h.candidate});
    ++l.live_fresh;
}

void Engine::leave(std::uint32_t t) {
    Hot& h = hot_[t];
    const std::uint32_t status = h.candidate & kStatus;
    if (status == 0) {
        return;
    }
    const std::uint32_t level = level_of(t);
    Level& l = levels_[level];
    if (status == kFresh) {
        if (--l.live_fresh == 0) {
            l.fresh.clear();
        }
    } else if (--l.live_raced == 0) {
        Lottery& lottery = state_.lotteries[level];
        lottery.tickets.clear();
        lottery.run.clear();
        lottery.head = 0;
        lottery.clock = 0;
        lottery.lazy = false;
        lottery.front_key = -1;
    }
    h.candidate = (h.candidate | kStatus) + 1;
}

// A condition on a count begins or ceases to hold.
inline void Engine::cross(const Watcher& w, std::uint32_t from, std::uint32_t to) {
    const bool is = to >= w.threshold;
    if ((from >= w.threshold) == is) {
        return;
    }
    const std::uint32_t t = w.transition();
    if (is != w.inhibits()) {
        if (--hot_[t].unsatisfied == 0) {
            w.gated() ? touch(t) : enter(t);
        }
    } else if (hot_[t].unsatisfied++ == 0) {
        w.gated() ? gate_closed(t) : leave(t);
    }
}

inline void Engine::ready_changed(std::uint32_t p, std::uint32_t from, std::uint32_t to) {
    const PlaceRow& row = tables_->place[p];
    if (row.ready != row.total) {
        cross(row.first, from, to);
        for (std::uint32_t i = row.ready + 1; i < row.total; ++i) {
            cross(tables_->watchers[i], from, to);
        }
    }
    if (row.has_dependents) {
        touch_dependents(p);
    }
}

inline void Engine::total_changed(std::uint32_t p, std::uint32_t from, std::uint32_t to) {
    const PlaceRow& row = tables_->place[p];
    for (std::uint32_t i = row.total, end = tables_->place[p + 1].ready; i < end; ++i) {
        cross(tables_->watchers[i], from, to);
    }
    if (row.has_dependents) {
        touch_dependents(p);
    }
}

void Engine::touch_dependents(std::uint32_t p) {
    for (const std::uint32_t t : tables_->place_dependents.row(p)) {
        touch(t);
    }
}

void Engine::change_ready(std::uint32_t p, std::uint32_t from, std::uint32_t to) {
    ready_changed(p, from, to);
}
void Engine::change_total(std::uint32_t p, std::uint32_t from, std::uint32_t to) {
    total_changed(p, from, to);
}

// -- ties
// ------------------------------------------------------------------------------------------------------------

// The winner of the highest priority, no longer a candidate; kNoIndex: nobody can fire.
std::uint32_t Engine::select() {
    std::uint32_t level = 0;
    const auto count = static_cast<std::uint32_t>(levels_.size());
    while (level < count && levels_[level].live_fresh + levels_[level].live_raced == 0) {
        ++level;
    }
    if (level == count) {
        return kNoIndex;
    }
    Level& l = levels_[level];
    if (!random_) {
        return ask_tie(level);
    }
    if (l.live_fresh == 1 && l.live_raced == 0) {
        // Alone: whatever its ticket, it wins and nobody is left to compare with. The draw is
        // counted, not made.
        while (hot_[l.fresh.back().transition].candidate != l.fresh.back().stamp) {
            l.fresh.pop_back();
        }
        const std::uint32_t t = l.fresh.back().transition;
        ++hot_[t].ticket_draws;
        leave(t);
        return t;
    }
    return race(level);
}

// -- firing
// ----------------------------------------------------------------------------------------------------------

void Engine::take_plain(std::uint32_t t) {
    for (const Weighted& w : takes(t)) {
        Counts& c = state_.counts[w.place];
        const Counts was = c;
        c.ready -= w.weight;
        c.total -= w.weight;
        ready_changed(w.place, was.ready, was.ready - w.weight);
        if (tables_->place[w.place].kind != PlaceKind::kCount) {
            total_changed(w.place, was.total, was.total - w.weight);
        }
    }
}

void Engine::give_plain(std::uint32_t t) {
    for (const Weighted& w : gives(t)) {
        Counts& c = state_.counts[w.place];
        if (c.total + w.weight > 0x7FFF'FFFF) {
            fail_place(w.place, "too-many-tokens", "more than 2147483647 tokens",
                       "bound the place");
            return;
        }
        if (tables_->place[w.place].kind == PlaceKind::kCount) {
            const Counts was = c;
            c.ready += w.weight;
            c.total += w.weight;
            ready_changed(w.place, was.ready, was.ready + w.weight);
        } else {
            give_timed(w.place, w.weight);
        }
    }
}

void Engine::give_timed(std::uint32_t p, std::uint32_t weight) {
    const std::uint32_t number = tables_->place[p].duration;
    const bool constant =
        number == kNoIndex || (tables_->durations[number].kind == DurationKind::kConstant &&
                               options_.timekeeper == nullptr);
    for (std::uint32_t k = 0; k < weight; ++k) {
        std::int64_t ticks = 0;
        std::uint32_t fifo = kNoIndex;
        if (constant) {
            if (number != kNoIndex) {
                ticks = tables_->durations[number].ticks;
                fifo = tables_->durations[number].fifo;
            }
        } else if (!draw_place(p, ticks)) {
            return;
        }
        add_timed(p, ticks, fifo);
    }
}

void Engine::add_timed(std::uint32_t p, std::int64_t ticks, std::uint32_t fifo) {
    Counts& c = state_.counts[p];
    const Counts was = c;
    ++c.total;
    total_changed(p, was.total, was.total + 1);
    if (options_.listener != nullptr) {
        std::int64_t ready = SimTime::never().ticks;
        ends_at(ticks, ready);
        options_.listener->arrives({state_.now}, {p}, {ready});
    }
    if (ticks == 0) {
        ++c.ready;
        ready_changed(p, was.ready, was.ready + 1);
        return;
    }
    Pending pending;
    pending.what = Pending::kPlain | p;
    if (!ends_at(ticks, pending.at)) {
        fail_place(p, "time-overflow", "a token would be ready after the end of time",
                   "shorten its duration");
        return;
    }
    if (fifo != kNoIndex) {
        state_.rings[fifo].push(pending);
    } else {
        state_.heap.push(pending);
    }
}

void Engine::fire(std::uint32_t t) {
    ++state_.firings;
    state_.last = t;
    state_.log_hash = log_hash_step(state_.log_hash, state_.now, hot_[t].path_hash);
    if (++state_.instant_firings + 1024 > options_.firings_per_instant) {
        watch_instant(t);
    }
    if (options_.listener != nullptr) {
        options_.listener->fired({state_.now}, {t});
    }
    const std::uint8_t flags = hot_[t].flags;
    if ((flags & kFiresSpecially) != 0) {
        if ((flags & kOnlyDelayed) == 0) {
            fire_special(t);
            return;
        }
        state_.clocks[tables_->specials[tables_->transition[t].special].delay].clear();
    }
    if (options_.listener != nullptr) {
        options_.listener->fires({state_.now}, {t}, *this);
    }
    take_plain(t);
    if (!touch_list_.empty()) {
        look_again(true);
    }
    give_plain(t);
    finish_firing(t);
}

void Engine::finish_firing(std::uint32_t t) {
    if ((hot_[t].flags & kGated) != 0) {
        touch(t);
    } else if (hot_[t].unsatisfied == 0 && (hot_[t].candidate & kStatus) == 0) {
        enter(t);
    }
    if (!resampled_.empty()) {
        resample();
    }
    if (!touch_list_.empty()) {
        look_again(false);
    }
}

// -- time
// ------------------------------------------------------------------------------------------------------------

bool Engine::stale(const Pending& p) const {
    const std::uint32_t index = p.what & Pending::kIndexMask;
    switch (p.what & ~Pending::kIndexMask) {
        case Pending::kToken: {
            const Token& token = state_.rich[index].pool[p.slot];
            return !token.alive || token.ready || token.ready_at != p.at;
        }
        case Pending::kDelay:
            return std::none_of(
                state_.clocks[index].begin(), state_.clocks[index].end(),
                [&](const Clock& c) { return c.phase == Clock::kRunning && c.at == p.at; });
        default:
            return false;
    }
}

// When the next token, delay or holding is ready; never if none.
std::int64_t Engine::next_pending() {
    std::int64_t next = SimTime::never().ticks;
    for (PendingRing& ring : state_.rings) {
        while (ring.size != 0 && stale(ring.front())) {
            ring.pop();
        }
        if (ring.size != 0 && ring.front().at < next) {
            next = ring.front().at;
        }
    }
    while (!state_.heap.items.empty() && stale(state_.heap.items.front())) {
        state_.heap.pop();
    }
    if (!state_.heap.items.empty() && state_.heap.items.front().at < next) {
        next = state_.heap.items.front().at;
    }
    return next;
}

void Engine::ripen(const Pending& p) {
    const std::uint32_t index = p.what & Pending::kIndexMask;
    if ((p.what & ~Pending::kIndexMask) == Pending::kPlain) {
        const std::uint32_t was = state_.counts[index].ready++;
        ready_changed(index, was, was + 1);
        return;
    }
    if (stale(p)) {
        return;
    }
    if ((p.what & ~Pending::kIndexMask) == Pending::kToken) {
        ready_token(index, p.slot);
        return;
    }
    for (Clock& c : state_.clocks[index]) {
        if (c.phase == Clock::kRunning && c.at == p.at) {
            c.phase = Clock::kDue;
            break;
        }
    }
    touch(tables_->delays[index].transition);
}

// The same for tokens that are about to be ready.
void Engine::look_ahead(const PendingRing& ring) const {
    const NetTables& n = *tables_;
    const auto place = [&](std::uint32_t i) -> std::uint32_t {
        const Pending& p = ring.at(i);
        return (p.what & ~Pending::kIndexMask) == Pending::kPlain ? p.what : 0;
    };
    __builtin_prefetch(&n.place[place(12)]);
    __builtin_prefetch(&state_.counts[place(12)]);
    __builtin_prefetch(&hot_[n.place[place(5)].first.transition()]);
}

void Engine::advance_to(std::int64_t at) {
    state_.now = at;
    state_.instant_firings = 0;
    instant_log_.clear();
    for (PendingRing& ring : state_.rings) {
        while (ring.size != 0 && ring.front().at <= at) {
            const Pending p = ring.front();
            ring.pop();
            if (ring.size >= kManyTickets) {
                look_ahead(ring);
            }
            ripen(p);
        }
    }
    while (!state_.heap.items.empty() && state_.heap.items.front().at <= at) {
        const Pending p = state_.heap.items.front();
        state_.heap.pop();
        ripen(p);
    }
    if (!touch_list_.empty()) {
        look_again(false);
    }
}

bool Engine::somebody_can_fire() const {
    for (const Level& l : levels_) {
        if (l.live_fresh + l.live_raced != 0) {
            return true;
        }
    }
    return false;
}

std::int64_t Engine::next_time() {
    if (faulted_) {
        return SimTime::never().ticks;
    }
    if (somebody_can_fire()) {
        return tables_->paced ? std::max(state_.now, state_.next_beat) : state_.now;
    }
    if (state_.offered != kNoIndex) {
        return state_.now;
    }
    std::int64_t next = next_pending();
    if (!state_.occurrences.empty()) {
        next = std::min(next, std::max(state_.now, state_.occurrences.front().at));
    }
    return next;
}

void Engine::pass_to(SimTime at) {
    PUP_REQUIRE(at.ticks >= state_.now && next_time() > at.ticks);
    state_.now = at.ticks;
}

bool Engine::settled() {
    return !somebody_can_fire() && state_.offered == kNoIndex && !occurrence_pending_now();
}

Engine::Outcome Engine::step(std::int64_t until) { return run(until, state_.firings + 1); }

Engine::Outcome Engine::run(std::int64_t until, std::uint64_t firings) {
    for (;;) {
        if (faulted_) {
            return Outcome::kFault;
        }
        if (state_.firings >= firings) {
            return Outcome::kFired;
        }
        if (tables_->paced && state_.now < state_.next_beat && somebody_can_fire()) {
            if (state_.next_beat > until) {
                state_.now = std::max(state_.now, until);
                return Outcome::kSettled;
            }
            advance_to(state_.next_beat);
        }
        const std::uint32_t t = select();
        if (t != kNoIndex) {
            if (tables_->paced) {
                state_.next_beat = state_.now + options_.beat;
            }
            fire(t);
            continue;
        }
        if (state_.offered != kNoIndex) {
            end_offer();
            continue;
        }
        std::int64_t next = next_pending();
        if (!state_.occurrences.empty()) {
            if (state_.occurrences.front().at <= state_.now) {
                offer_first();
                continue;
            }
            next = std::min(next, state_.occurrences.front().at);
        }
        if (options_.free && ask_outside()) {
            continue;
        }
        if (next == SimTime::never().ticks) {
            return Outcome::kDead;
        }
        if (next > until) {
            state_.now = std::max(state_.now, until);
            return Outcome::kSettled;
        }
        advance_to(next);
    }
}

}  // namespace puppetri::net
