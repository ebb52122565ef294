// SPDX-License-Identifier: MIT
// Tokens with records: their order in the place, their readiness, and the movements that they stand
// for.
#include <algorithm>

#include "puppetri/net/engine.h"

namespace puppetri::net {

namespace {

constexpr std::int64_t kOpen = -1;  // as a duration

// Earliest ready time, then earliest arrival, then serial. `kept`: by a timekeeper, so that of two
// that wait nobody knows which will be ready first. `by_arrival`: whatever they last.
bool older(const Token& a, const Token& b, bool by_arrival, bool kept) {
    if (!by_arrival && a.ready_at != b.ready_at &&
        !(kept && is_wait(a.ready_at) && is_wait(b.ready_at))) {
        return a.ready_at < b.ready_at;
    }
    if (a.arrival != b.arrival) {
        return a.arrival < b.arrival;
    }
    return a.serial < b.serial;
}

}  // namespace

bool Engine::comes_before(const RichPlaceTable& r, const Token& a, const Token& b) const {
    const bool kept = options_.timekeeper != nullptr;
    switch (r.discipline) {
        case Discipline::kOldest:
            return older(a, b, r.by_arrival, kept);
        case Discipline::kNewest:
            return older(b, a, r.by_arrival, kept);
        case Discipline::kAny:
            return a.serial < b.serial;
        case Discipline::kLeast:
        case Discipline::kMost:
            break;
    }
    const bool real = r.key_is_real;
    const auto less = [real](Value x, Value y) {
        return real ? real_of_value(x) < real_of_value(y) : x < y;
    };
    if (less(a.key, b.key) || less(b.key, a.key)) {
        return less(a.key, b.key) == (r.discipline == Discipline::kLeast);
    }
    return older(a, b, r.by_arrival, kept);
}

void Engine::place_in_order(std::uint32_t rich, std::uint32_t slot) {
    RichTokens& place = state_.rich[rich];
    const RichPlaceTable& table = tables_->rich[rich];
    const auto position =
        std::upper_bound(place.order.begin() + place.head, place.order.end(), slot,
                         [&](std::uint32_t a, std::uint32_t b) {
                             return comes_before(table, place.pool[a], place.pool[b]);
                         });
    place.order.insert(position, slot);
}

void Engine::take_from_order(std::uint32_t rich, std::uint32_t slot) {
    RichTokens& place = state_.rich[rich];
    const auto it = std::find(place.order.begin() + place.head, place.order.end(), slot);
    if (it == place.order.begin() + place.head) {
        ++place.head;
        if (place.head == place.order.size()) {
            place.order.clear();
            place.head = 0;
        } else if (place.head >= 32 && 2 * place.head >= place.order.size()) {
            place.order.erase(place.order.begin(), place.order.begin() + place.head);
            place.head = 0;
        }
    } else {
        place.order.erase(it);
    }
}

// A token arrives: `ticks` is its duration, kOpen, or of `auto` whatever the host says; `ready`: at
// once.
void Engine::add_token(std::uint32_t p, std::span<const Value> attributes, std::int64_t ticks,
                       bool ready) {
    const std::uint32_t rich = tables_->place_rich[p];
    const RichPlaceTable& table = tables_->rich[rich];
    RichTokens& place = state_.rich[rich];
    Token token;
    token.alive = true;
    token.serial = state_.serials++;
    token.arrival = state_.now;
    if (table.key.valid()) {
        attributes_ = attributes.data();
        const bool fine = evaluate(table.key, token.key);
        attributes_ = nullptr;
        if (!fine) {
            fail_place(p, "evaluation-fault", "the key of its discipline cannot be computed",
                       "mend the expression");
            return;
        }
    }
    if (table.action.valid() && options_.host != nullptr) {
        token.activity = state_.activities++;
        const DurationKind kind = tables_->place[p].duration == kNoIndex
                                      ? DurationKind::kConstant
                                      : tables_->durations[tables_->place[p].duration].kind;
        const bool asks = kind == DurationKind::kAuto && !ready && ticks == kOpen;
        const std::int64_t given = asks ? -1 : ticks == kOpen ? SimTime::never().ticks : ticks;
        const SimTime said = options_.host->begin(table.action, {token.activity}, {state_.now},
                                                  {ready ? 0 : given}, attributes);
        if (said.ticks < 0) {
            fail_place(p, "movement-impossible", "its movement cannot be done",
                       "see what the stage says about it");
            return;
        }
        if (asks) {
            // Up to a whole millisecond, so that the last bits of a movement decide nothing.
            const std::int64_t rest = said.ticks % kTicksPerMillisecond;
            ticks = rest == 0 ? said.ticks : said.ticks - rest + kTicksPerMillisecond;
        }
    } else if (table.action.valid()) {
        token.activity = state_.activities++;
    }
    token.ready_at = SimTime::never().ticks;
    if (ready || ticks == 0) {
        ticks = 0;
        token.ready_at = state_.now;
    } else if (ticks != kOpen && !ends_at(ticks, token.ready_at)) {
        fail_place(p, "time-overflow", "a token would be ready after the end of time",
                   "shorten its duration");
        return;
    }
    if (!sibling_ticks_.empty()) {
        if (sibling_ticks_[p] == kOpen - 1) {
            sibling_ticks_[p] = ticks;
        }
    }
    if (table.keeps_order && !ready && token.ready_at != SimTime::never().ticks &&
        !waits(token.ready_at)) {
        token.ready_at = std::max(token.ready_at, place.last_ready);
        place.last_ready = token.ready_at;
    }
    if (options_.timekeeper != nullptr && table.keeps_order && !ready && ticks == 0) {
        token.ready_at = held_back(place);
    }
    token.ready = token.ready_at <= state_.now;

    std::uint32_t slot = 0;
    if (place.free.empty()) {
        slot = static_cast<std::uint32_t>(place.pool.size());
        place.pool.push_back(token);
        place.values.resize(place.values.size() + table.attributes);
    } else {
        slot = place.free.back();
        place.free.pop_back();
        place.pool[slot] = token;
    }
    std::copy(attributes.begin(), attributes.end(),
              place.values.begin() + static_cast<std::ptrdiff_t>(slot) * table.attributes);
    place_in_order(rich, slot);

    Counts& c = state_.counts[p];
    const Counts was = c;
    ++c.total;
    change_total(p, was.total, was.total + 1);
    if (token.ready) {
        ++c.ready;
        change_ready(p, was.ready, was.ready + 1);
    } else if (token.ready_at != SimTime::never().ticks) {
        Pending pending;
        pending.at = token.ready_at;
        pending.what = Pending::kToken | rich;
        pending.slot = slot;
        const std::uint32_t number = tables_->place[p].duration;
        const std::uint32_t fifo = number == kNoIndex ? kNoIndex : tables_->durations[number].fifo;
        if (fifo != kNoIndex && ticks == tables_->durations[number].ticks &&
            token.ready_at == state_.now + ticks) {
            state_.rings[fifo].push(pending);
        } else {
            state_.heap.push(pending);
        }
    }
    if (token.activity != kNoIndex && options_.host != nullptr) {
        for (const RaisedEvent& raised : options_.host->raised({token.activity})) {
            if (!raised.event.valid() || raised.event.value >= tables_->events.size()) {
                continue;
            }
            Occurrence o;
            o.at = std::max(state_.now, raised.at.ticks);
            o.origin = Occurrence::kMovement;
            o.rank = tables_->places.rank(p);
            o.event = raised.event.value;
            o.activity = token.activity;
            push_occurrence(o);
        }
    }
}

void Engine::remove_token(std::uint32_t rich, std::uint32_t slot, bool now) {
    const RichPlaceTable& table = tables_->rich[rich];
    RichTokens& place = state_.rich[rich];
    const Token token = place.pool[slot];
    if (options_.listener != nullptr) {
        options_.listener->leaves({state_.now}, {table.place}, {token.arrival});
    }
    take_from_order(rich, slot);
    place.pool[slot].alive = false;
    place.free.push_back(slot);
    Counts& c = state_.counts[table.place];
    const Counts was = c;
    --c.total;
    if (token.ready) {
        --c.ready;
        change_ready(table.place, was.ready, was.ready - 1);
    }
    change_total(table.place, was.total, was.total - 1);
    const bool cut = now && !token.ready;
    if (cut && table.keeps_order) {
        place.last_ready = 0;
        for (std::uint32_t i = place.head; i < place.order.size(); ++i) {
            const std::int64_t at = place.pool[place.order[i]].ready_at;
            if (at != SimTime::never().ticks && !waits(at)) {
                place.last_ready = std::max(place.last_ready, at);
            }
        }
    }
    if (token.activity != kNoIndex) {
        if (cut) {
            forget_activity(token.activity);
        }
        if (options_.host != nullptr) {
            if (cut) {
                options_.host->cut({token.activity}, {state_.now});
            }
            options_.host->left({token.activity}, {state_.now});
        }
    }
}

void Engine::ready_token(std::uint32_t rich, std::uint32_t slot) {
    state_.rich[rich].pool[slot].ready = true;
    const std::uint32_t p = tables_->rich[rich].place;
    const std::uint32_t was = state_.counts[p].ready++;
    change_ready(p, was, was + 1);
}

// The owner of an open place says so: its oldest token that is not ready.
void Engine::make_ready(std::uint32_t p) {
    const std::uint32_t rich = tables_->place_rich[p];
    RichTokens& place = state_.rich[rich];
    std::uint32_t best = kNoIndex;
    for (std::uint32_t i = place.head; i < place.order.size(); ++i) {
        const std::uint32_t slot = place.order[i];
        const Token& token = place.pool[slot];
        if (!token.ready && (best == kNoIndex || token.serial < place.pool[best].serial)) {
            best = slot;
        }
    }
    if (best == kNoIndex) {
        return;
    }
    state_.offer_used = true;
    take_from_order(rich, best);
    place.pool[best].ready_at = state_.now;
    place_in_order(rich, best);
    ready_token(rich, best);
}

// One output with records, a duration of its own, or siblings; its values start at given_[first].
void Engine::give_special(const OutputTable& out, std::size_t first) {
    const std::size_t width = out.attributes.size();
    for (std::uint32_t k = 0; k < out.weight && !faulted_; ++k) {
        const std::span<const Value> attributes(given_.data() + first, width);
        std::int64_t ticks = 0;
        if (!sibling_ticks_.empty() && k == 0) {
            sibling_ticks_[out.place] = kOpen - 1;  // to be set by this token
        }
        if (out.lasts.valid()) {
            ticks = given_[first + width];
            if (options_.timekeeper != nullptr && !is_wait(ticks)) {
                ticks = wait(Timekeeper::Kind::kToken, out.place, ticks, ticks);
            }
        } else {
            attributes_ = attributes.data();
            const bool fine = draw_place(out.place, ticks);
            attributes_ = nullptr;
            if (!fine) {
                return;
            }
        }
        if (out.rich != kNoIndex) {
            add_token(out.place, attributes, ticks, false);
            continue;
        }
        if (!sibling_ticks_.empty() && k == 0) {
            sibling_ticks_[out.place] = ticks;
        }
        if (tables_->place[out.place].kind == PlaceKind::kCount) {
            Counts& c = state_.counts[out.place];
            const Counts was = c;
            ++c.ready;
            ++c.total;
            change_ready(out.place, was.ready, was.ready + 1);
        } else {
            // A duration of its own may end before one that was pushed earlier: never into the
            // ring.
            const std::uint32_t number = tables_->place[out.place].duration;
            const bool ring = !out.lasts.valid() && number != kNoIndex && !waits(ticks) &&
                              tables_->durations[number].kind == DurationKind::kConstant;
            add_timed(out.place, ticks, ring ? tables_->durations[number].fifo : kNoIndex);
        }
    }
}

// The initial tokens arrive at time 0 and age like others unless they are ready.
void Engine::start_marking() {
    for (const NetTables::Initial& initial : tables_->initial) {
        const std::uint32_t p = initial.place;
        const bool rich = !tables_->place_rich.empty() && tables_->place_rich[p] != kNoIndex;
        for (std::uint32_t k = 0; k < initial.count && !faulted_; ++k) {
            std::int64_t ticks = 0;
            if (!sibling_ticks_.empty() && k == 0) {
                sibling_ticks_[p] = kOpen - 1;
            }
            if (!initial.ready) {
                attributes_ = initial.attributes.data();
                const bool fine = draw_place(p, ticks);
                attributes_ = nullptr;
                if (!fine) {
                    return;
                }
            }
            if (rich) {
                add_token(p, initial.attributes, ticks, initial.ready);
                continue;
            }
            if (!sibling_ticks_.empty() && k == 0) {
                sibling_ticks_[p] = ticks;
            }
            Counts& c = state_.counts[p];
            if (tables_->place[p].kind == PlaceKind::kCount) {
                const Counts was = c;
                ++c.ready;
                ++c.total;
                change_ready(p, was.ready, was.ready + 1);
            } else {
                const std::uint32_t number = tables_->place[p].duration;
                add_timed(p, ticks,
                          number == kNoIndex || waits(ticks) ? kNoIndex
                                                             : tables_->durations[number].fifo);
            }
        }
    }
}

}  // namespace puppetri::net
