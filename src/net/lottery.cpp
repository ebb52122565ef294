// SPDX-License-Identifier: MIT
// Ties: the race of tickets, and the question to a chooser that is not random (docs/semantics.md,
// "Ties").
#include <algorithm>

#include "heap.h"
#include "puppetri/base/elementary.h"
#include "puppetri/base/require.h"
#include "puppetri/net/engine.h"

namespace puppetri::net {

// -ln(u) / odds, the t's next ticket.
double Engine::ticket(std::uint32_t t) {
    const double u = uniform_from_bits(random_bits(hot_[t].ticket_key, hot_[t].ticket_draws++));
    const double e = -puppetri::log(u);
    return (hot_[t].flags & kHasOdds) != 0 ? e / odds(t) : e;
}

// Large nets wait for memory, not for arithmetic: what the next firings will read is asked for some
// firings ahead.
void Engine::prefetch_arcs(std::uint32_t t) const {
    const Hot& h = hot_[t];
    const Weighted* arcs = arcs_of(h);
    for (std::uint32_t i = 0; i < h.end - h.takes && i < 6; ++i) {
        __builtin_prefetch(&tables_->place[arcs[i].place]);
        __builtin_prefetch(&state_.counts[arcs[i].place]);
    }
}

void Engine::look_ahead(const Lottery& lottery) const {
    const Ticket* next = lottery.run.data() + lottery.head;
    if (lottery.run.size() - lottery.head > kAhead) {
        __builtin_prefetch(&hot_[next[kAhead].transition]);
        __builtin_prefetch(arcs_of(hot_[next[12].transition]));
        prefetch_arcs(next[8].transition);
        const Hot& soon = hot_[next[4].transition];
        const Weighted* arcs = arcs_of(soon);
        for (std::uint32_t i = 0; i < soon.end - soon.takes && i < 6; ++i) {
            __builtin_prefetch(&hot_[tables_->place[arcs[i].place].first.transition()]);
        }
    }
    if (lottery.tickets.size() > kManyTickets) {
        // The next winners are near the root.
        for (std::size_t i = 3; i < 7; ++i) {
            __builtin_prefetch(&hot_[lottery.tickets[i].transition]);
        }
        prefetch_arcs(lottery.tickets[1].transition);
        prefetch_arcs(lottery.tickets[2].transition);
    }
}

// The lottery as tickets alone, for keeping.
void Engine::settle_lottery(Lottery& lottery) {
    for (std::size_t i = lottery.head; i < lottery.run.size(); ++i) {
        Ticket t = lottery.run[i];
        t.key = -puppetri::log(-t.key);
        lottery.tickets.push_back(t);
    }
    if (lottery.lazy) {
        lottery.clock = -puppetri::log(lottery.last_u);
    }
    lottery.run.clear();
    lottery.head = 0;
    lottery.lazy = false;
    lottery.front_key = -1;
}

// Who became fireable since the last firing draws a ticket, counted from the lottery's clock; the
// least wins and sets the clock; losers keep theirs. When no loser is left, the clock starts again
// from 0: what has no partner to be compared with needs no common origin.
std::uint32_t Engine::race(std::uint32_t level) {
    Level& l = levels_[level];
    Lottery& lottery = state_.lotteries[level];
    const auto before = [this](const Ticket& a, const Ticket& b) {
        return a.key != b.key ? a.key < b.key
                              : hot_[a.transition].path_hash < hot_[b.transition].path_hash;
    };
    if (l.live_fresh != 0) {
        const bool together = l.live_raced == 0 && tables_->level_has_odds[level] == 0;
        if (lottery.lazy) {
            lottery.clock = -puppetri::log(lottery.last_u);
            lottery.lazy = false;
        }
        const std::size_t entered = l.fresh.size();
        for (std::size_t i = 0; i < entered; ++i) {
            const Fresh& f = l.fresh[i];
            if (i + kAhead < entered) {
                __builtin_prefetch(&hot_[l.fresh[i + kAhead].transition]);
            }
            Hot& h = hot_[f.transition];
            if (h.candidate != f.stamp) {
                continue;
            }
            h.candidate += kRaced - kFresh;
            const std::uint32_t t = f.transition;
            if (together) {
                const double u = uniform_from_bits(random_bits(h.ticket_key, h.ticket_draws++));
                lottery.run.push_back({-u, t, h.candidate});
            } else {
                heap_push<2>(lottery.tickets, {lottery.clock + ticket(t), t, h.candidate}, before);
            }
        }
        if (together) {
            std::sort(lottery.run.begin(), lottery.run.end(), before);
        }
        l.live_raced += l.live_fresh;
        l.live_fresh = 0;
        l.fresh.clear();
    }
    while (lottery.head < lottery.run.size() &&
           hot_[lottery.run[lottery.head].transition].candidate !=
               lottery.run[lottery.head].stamp) {
        ++lottery.head;
        lottery.front_key = -1;
    }
    while (!lottery.tickets.empty() &&
           hot_[lottery.tickets.front().transition].candidate != lottery.tickets.front().stamp) {
        heap_pop<2>(lottery.tickets, before);
    }
    bool from_run = lottery.head < lottery.run.size();
    if (from_run && !lottery.tickets.empty()) {
        Ticket first = lottery.run[lottery.head];
        if (lottery.front_key < 0) {
            lottery.front_key = -puppetri::log(-first.key);
        }
        first.key = lottery.front_key;
        from_run = before(first, lottery.tickets.front());
    }
    std::uint32_t winner = 0;
    if (from_run) {
        winner = lottery.run[lottery.head].transition;
        lottery.last_u = -lottery.run[lottery.head].key;
        lottery.lazy = lottery.front_key < 0;
        lottery.clock = lottery.front_key;
        lottery.front_key = -1;
        ++lottery.head;
    } else {
        winner = lottery.tickets.front().transition;
        lottery.clock = lottery.tickets.front().key;
        lottery.lazy = false;
        heap_pop<2>(lottery.tickets, before);
    }
    if (l.live_raced > kAhead) {
        look_ahead(lottery);
    }
    leave(winner);
    return winner;
}

std::uint32_t Engine::ask_tie(std::uint32_t level) {
    Level& l = levels_[level];
    options_list_.clear();
    for (const Fresh& f : l.fresh) {
        if (hot_[f.transition].candidate == f.stamp) {
            options_list_.push_back(f.transition);
        }
    }
    // Tickets of a random run that goes on under this chooser are void.
    for (const Ticket& kept : state_.lotteries[level].tickets) {
        if (hot_[kept.transition].candidate == kept.stamp) {
            options_list_.push_back(kept.transition);
        }
    }
    std::sort(options_list_.begin(), options_list_.end(), [this](std::uint32_t a, std::uint32_t b) {
        return tables_->transitions.rank(a) < tables_->transitions.rank(b);
    });
    std::int64_t answer = 0;
    if (options_list_.size() > 1) {
        odds_list_.clear();
        for (const std::uint32_t t : options_list_) {
            odds_list_.push_back(odds(t));
        }
        Choice choice;
        choice.kind = ChoiceKind::kTie;
        choice.element = kNoIndex;
        choice.options = static_cast<std::uint32_t>(options_list_.size());
        choice.transitions = options_list_;
        choice.odds = odds_list_;
        answer = chooser_->choose(choice);
        PUP_REQUIRE(answer >= 0 && answer < static_cast<std::int64_t>(choice.options));
    }
    const std::uint32_t t = options_list_[static_cast<std::size_t>(answer)];
    leave(t);
    return t;
}

}  // namespace puppetri::net
