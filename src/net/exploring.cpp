// SPDX-License-Identifier: MIT
// For those who explore: run() taken apart into its smallest steps, and time kept by somebody else
// (net/timekeeper.h).
#include <algorithm>

#include "puppetri/base/require.h"
#include "puppetri/net/engine.h"

namespace puppetri::net {

Engine::Turn Engine::turn() {
    const auto said = [this](Turn turn) { return faulted_ ? Turn::kFault : turn; };
    if (faulted_) {
        return Turn::kFault;
    }
    if (somebody_can_fire()) {
        if (tables_->paced && state_.now < state_.next_beat) {
            advance_to(state_.next_beat);
            return said(Turn::kPassed);
        }
        const std::uint32_t t = select();
        if (tables_->paced) {
            state_.next_beat = state_.now + options_.beat;
        }
        fire(t);
        return said(Turn::kFired);
    }
    if (state_.offered != kNoIndex) {
        end_offer();
        return said(Turn::kOfferEnded);
    }
    if (occurrence_pending_now()) {
        offer_first();
        return said(Turn::kOffered);
    }
    if (options_.free && ask_outside()) {
        return said(Turn::kAsked);
    }
    const std::int64_t next = next_time();
    if (faulted_ || next == SimTime::never().ticks) {
        return said(Turn::kDead);
    }
    if (waits(next)) {
        return Turn::kWaits;
    }
    advance_to(next);
    return said(Turn::kPassed);
}

std::int64_t Engine::wait(Timekeeper::Kind kind, std::uint32_t element, std::int64_t low,
                          std::int64_t high) {
    if (high == 0) {
        return 0;
    }
    const std::int64_t number = options_.timekeeper->begin(kind, element, {low}, {high});
    PUP_REQUIRE(number >= 0 && number <= std::int64_t{1} << 61);
    return number == 0 ? 0 : kWaiting + number;
}

// Instants are numbered 0, 1, 2, ...: that is all that the order of ready tokens needs to know.
void Engine::pass(std::span<const std::int64_t> numbers) {
    PUP_REQUIRE(options_.timekeeper != nullptr && settled());
    const auto over = [&numbers](std::int64_t at) {
        return is_wait(at) &&
               std::find(numbers.begin(), numbers.end(), at - kWaiting) != numbers.end();
    };
    ++state_.now;
    state_.instant_firings = 0;
    instant_log_.clear();
    std::vector<Pending> waiting;
    waiting.swap(state_.heap.items);
    for (const Pending& p : waiting) {
        if (!over(p.at)) {
            state_.heap.push(p);
            continue;
        }
        if ((p.what & ~Pending::kIndexMask) == Pending::kToken && !stale(p)) {
            const std::uint32_t rich = p.what & Pending::kIndexMask;
            take_from_order(rich, p.slot);
            state_.rich[rich].pool[p.slot].ready_at = state_.now;
            place_in_order(rich, p.slot);
            ready_token(rich, p.slot);
        } else {
            ripen(p);
        }
    }
    for (Occurrence& o : state_.occurrences) {
        o.at = over(o.at) ? state_.now : o.at;
    }
    std::sort(state_.occurrences.begin(), state_.occurrences.end(),
              [](const Occurrence& a, const Occurrence& b) { return a.before(b); });  // is a heap
    if (!touch_list_.empty()) {
        look_again(false);
    }
}

// When a token of a place that keeps its order is ready if nothing but its order holds it back:
// with the last one that waits.
std::int64_t Engine::held_back(const RichTokens& place) const {
    const Token* last = nullptr;
    for (std::uint32_t i = place.head; i < place.order.size(); ++i) {
        const Token& token = place.pool[place.order[i]];
        if (is_wait(token.ready_at) && (last == nullptr || token.serial > last->serial)) {
            last = &token;
        }
    }
    return last == nullptr ? state_.now : last->ready_at;
}

// Tokens that all last equally long, or that keep their order, are ready in the order of arrival.
void Engine::collect_unordered() {
    const NetTables& n = *tables_;
    unordered_.assign(n.rich.size(), 0);
    for (std::uint32_t r = 0; r < n.rich.size(); ++r) {
        const std::uint32_t number = n.place[n.rich[r].place].duration;
        const DurationKind kind =
            number == kNoIndex ? DurationKind::kConstant : n.durations[number].kind;
        unordered_[r] = kind != DurationKind::kConstant && kind != DurationKind::kOpen ? 1 : 0;
    }
    for (const Special& s : n.specials) {
        for (const OutputTable& out : s.outputs) {
            if (out.lasts.valid() && out.rich != kNoIndex) {
                unordered_[out.rich] = 1;
            }
        }
    }
    for (std::uint32_t r = 0; r < n.rich.size(); ++r) {
        if (n.rich[r].keeps_order || n.rich[r].by_arrival ||
            n.rich[r].discipline == Discipline::kAny) {
            unordered_[r] = 0;
        }
    }
}

// How many tokens from this position on may each be the first of them, as far as is known: those
// that wait and are alike in all but the time that is left.
std::uint32_t Engine::unordered_from(std::uint32_t rich, std::uint32_t position) const {
    const RichTokens& place = state_.rich[rich];
    const auto end = static_cast<std::uint32_t>(place.order.size());
    const Token& first = place.pool[place.order[position]];
    if (unordered_.empty() || unordered_[rich] == 0 || !is_wait(first.ready_at)) {
        return 1;
    }
    std::uint32_t i = position + 1;
    while (i < end && is_wait(place.pool[place.order[i]].ready_at) &&
           place.pool[place.order[i]].key == first.key) {
        ++i;
    }
    return i - position;
}

}  // namespace puppetri::net
