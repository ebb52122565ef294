// SPDX-License-Identifier: MIT
// The timed state of a net: all of it, apart from the net and from what can be computed again. A
// regular value: copy it, keep it, give it back to an engine. Two states with the same future have
// the same `canonical` bytes, whatever their history: times count from now, serial numbers count
// only as an order.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "puppetri/base/diagnostic.h"
#include "puppetri/base/expr.h"
#include "puppetri/base/time.h"
#include "puppetri/net/net.h"

namespace puppetri::net {

struct Counts {
    std::uint32_t ready = 0;
    std::uint32_t total = 0;  // ready or not
    bool operator==(const Counts&) const = default;
};

// Something that happens at a time by itself. 16 bytes; entries may be stale (a token that was
// cut), which is found out when they are looked at.
struct Pending {
    enum Kind : std::uint32_t { kPlain = 0, kToken = 1u << 30, kDelay = 2u << 30 };
    static constexpr std::uint32_t kIndexMask = (1u << 30) - 1;

    std::int64_t at = 0;
    // Kind and index: of the place, of the place with records, of the delay
    std::uint32_t what = 0;
    std::uint32_t slot = 0;  // of the token
};

// First in, first out, in a ring that grows by doubling: tokens that all last equally long.
struct PendingRing {
    std::vector<Pending> items;  // a power of two, or empty
    std::uint32_t head = 0, size = 0;

    const Pending& front() const { return items[head]; }
    const Pending& at(std::uint32_t i) const { return items[(head + i) & (items.size() - 1)]; }
    void pop() {
        head = (head + 1) & (static_cast<std::uint32_t>(items.size()) - 1);
        --size;
    }
    void push(const Pending& p) {
        if (size == items.size()) {
            grow();
        }
        items[(head + size) & (items.size() - 1)] = p;
        ++size;
    }
    void grow();
};

// A heap with four children per node: least time first.
struct PendingHeap {
    std::vector<Pending> items;

    void push(const Pending& p);
    void pop();
};

struct Token {
    std::uint64_t serial = 0;
    std::int64_t arrival = 0;
    std::int64_t ready_at = 0;  // SimTime::never(): open
    Value key = 0;              // of `least` and `most`
    std::uint32_t activity = ~std::uint32_t{0};
    bool ready = false;
    bool alive = false;
};

// The tokens of a place with records.
struct RichTokens {
    std::vector<Token> pool;
    std::vector<Value> values;         // the attributes, a row per slot of the pool
    std::vector<std::uint32_t> free;   // unused slots
    std::vector<std::uint32_t> order;  // slots in the order of the discipline, from `head`
    std::uint32_t head = 0;
    std::int64_t last_ready = 0;  // of `keeps order`

    std::uint32_t size() const { return static_cast<std::uint32_t>(order.size()) - head; }
};

// A clock of a delay.
struct Clock {
    enum Phase : std::uint8_t { kRunning, kDue, kSuspended };
    std::int64_t at = 0;  // running: when it has run out; suspended: what is left
    Phase phase = kRunning;
};

struct Occurrence {
    enum Class : std::uint32_t { kOutside, kMovement, kRaised };
    std::int64_t at = 0;
    std::uint32_t origin = kOutside;
    std::uint32_t rank = 0;  // of a movement's: the place in the order of paths
    std::uint64_t sequence = 0;
    std::uint32_t event = 0;
    std::uint32_t activity = ~std::uint32_t{0};
    std::int64_t every = 0;  // scheduled again and again
    bool before(const Occurrence& o) const;
};

// A transition that lost a tie in this instant and keeps its ticket.
struct Ticket {
    double key = 0;
    std::uint32_t transition = 0;
    std::uint32_t stamp = 0;  // of the engine
};

// The race of one priority. Those who entered together when nobody was waiting are sorted by their
// uniform numbers, greatest first, in `run`: of equal odds that is the order of their tickets
// -ln(u), and most logarithms are never needed. Who comes later gets its ticket, counted from the
// clock, in the heap.
struct Lottery {
    std::vector<Ticket> run;      // keys are -u; from `head`; may hold stale ones
    std::vector<Ticket> tickets;  // a heap, least key first; may hold stale ones
    std::uint32_t head = 0;
    bool lazy = false;  // the clock is -ln(last_u), not computed yet
    double last_u = 1;
    double clock = 0;
    double front_key = -1;  // the ticket of the run's first, once computed
};

struct State {
    std::int64_t now = 0;
    std::uint64_t firings = 0;
    std::uint64_t log_hash = 0;
    std::uint32_t last = ~std::uint32_t{0};  // the last transition that fired
    std::uint32_t instant_firings = 0;       // in this instant
    std::int64_t next_beat = 0;              // of paced nets: no firing before
    std::uint64_t serials = 0;
    std::uint32_t activities = 0;
    std::uint64_t sequences = 0;  // of occurrences

    std::vector<Counts> counts;
    std::vector<Value> data;
    std::vector<RichTokens> rich;
    std::vector<PendingRing> rings;  // one per constant duration
    PendingHeap heap;
    std::vector<std::vector<Clock>> clocks;  // one list per delay
    std::vector<Occurrence> occurrences;     // a heap

    // Of free runs: outside events so far, and where the outside was asked last.
    std::uint32_t free_events = 0;
    std::int64_t asked_at = -1;
    std::uint64_t asked_firings = 0;

    // The occurrence that is being offered.
    std::uint32_t offered = ~std::uint32_t{0};
    bool offer_used = false;
    bool offer_consumed = false;
    std::vector<std::uint32_t> offer_users;  // transitions that have fired with it

    std::vector<Lottery> lotteries;  // one per priority
    // How many numbers each stream has given; those of tickets are kept by the engine and filled in
    // by save().
    std::vector<std::uint64_t> ticket_draws, duration_draws, delay_draws, token_draws;
};

// The bytes of everything that decides the future except the streams: for comparing and hashing
// states.
void canonical(const Net& net, const State& state, std::vector<std::uint8_t>& out);
std::uint64_t hash(const Net& net, const State& state);

// Everything, compact, to be read back. Needs a state of this net.
std::vector<std::uint8_t> write_state(const Net& net, const State& state);
// Fails  (code bad-snapshot) when the bytes are not a state of this net.
Checked<State> read_state(const Net& net, std::span<const std::uint8_t> bytes);

}  // namespace puppetri::net
