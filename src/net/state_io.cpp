// SPDX-License-Identifier: MIT
// States as bytes: numbers of variable length, lists of what is not zero. The queue of plain tokens
// is written; that of tokens with records and of delays follows from them.
#include <algorithm>
#include <limits>

#include "puppetri/base/bit_cast.h"
#include "puppetri/base/hash.h"
#include "puppetri/base/varint.h"
#include "puppetri/net/state.h"
#include "puppetri/net/tables.h"

namespace puppetri::net {

namespace {

constexpr std::uint8_t kVersion = 1;

class Writer {
 public:
    explicit Writer(std::vector<std::uint8_t>& out) : out_(out) {}
    void byte(std::uint8_t b) { out_.push_back(b); }
    void count(std::uint64_t x) { put_varint(out_, x); }
    void number(std::int64_t x) { count(zigzag(x)); }
    void word(std::uint64_t x) {
        for (int i = 0; i < 8; ++i) {
            out_.push_back(static_cast<std::uint8_t>(x >> (8 * i)));
        }
    }
    // The entries that are not zero, each after the gap to it.
    void sparse(const std::vector<std::uint64_t>& list) {
        count(static_cast<std::uint64_t>(
            std::count_if(list.begin(), list.end(), [](std::uint64_t x) { return x != 0; })));
        std::size_t last = 0;
        for (std::size_t i = 0; i < list.size(); ++i) {
            if (list[i] != 0) {
                count(i - last);
                count(list[i]);
                last = i;
            }
        }
    }

 private:
    std::vector<std::uint8_t>& out_;
};

class Reader {
 public:
    explicit Reader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}
    bool fine() const { return fine_; }
    bool at_end() const { return next_ == bytes_.size(); }
    void fail() { fine_ = false; }
    std::uint8_t byte() {
        if (next_ >= bytes_.size()) {
            fine_ = false;
            return 0;
        }
        return bytes_[next_++];
    }
    std::uint64_t count() {
        std::uint64_t x = 0;
        for (int shift = 0; shift < 64; shift += 7) {
            const std::uint8_t b = byte();
            x |= std::uint64_t{b & 0x7Fu} << shift;
            if (b < 0x80) {
                return x;
            }
        }
        fine_ = false;
        return 0;
    }
    // A count below a bound: an index, a length that memory can hold.
    std::uint32_t below(std::uint64_t bound) {
        const std::uint64_t x = count();
        if (x >= bound) {
            fine_ = false;
            return 0;
        }
        return static_cast<std::uint32_t>(x);
    }
    // The number of items to come, each of at least one byte.
    std::uint32_t length() { return below(bytes_.size() - next_ + 1); }
    std::int64_t number() { return unzigzag(count()); }
    // A time, written as its distance from `now`.
    std::int64_t time_from(std::int64_t now) {
        std::int64_t at = 0;
        fine_ = !__builtin_add_overflow(now, number(), &at) && fine_;
        return at;
    }
    std::uint64_t word() {
        std::uint64_t x = 0;
        for (int i = 0; i < 8; ++i) {
            x |= std::uint64_t{byte()} << (8 * i);
        }
        return x;
    }
    void sparse(std::vector<std::uint64_t>& list) {
        const std::uint32_t n = length();
        std::uint64_t i = 0;
        for (std::uint32_t k = 0; k < n && fine_; ++k) {
            i += count();
            if (i >= list.size()) {
                fine_ = false;
                return;
            }
            list[i] = count();
        }
    }

 private:
    std::span<const std::uint8_t> bytes_;
    std::size_t next_ = 0;
    bool fine_ = true;
};

// The plain tokens that are not ready yet, by place and time.
std::vector<Pending> plain_pending(const State& s) {
    std::vector<Pending> list;
    const auto add = [&list](const Pending& p) {
        if ((p.what & ~Pending::kIndexMask) == Pending::kPlain) {
            list.push_back(p);
        }
    };
    for (const PendingRing& ring : s.rings) {
        for (std::uint32_t i = 0; i < ring.size; ++i) {
            add(ring.at(i));
        }
    }
    for (const Pending& p : s.heap.items) {
        add(p);
    }
    std::sort(list.begin(), list.end(), [](const Pending& a, const Pending& b) {
        return a.what != b.what ? a.what < b.what : a.at < b.at;
    });
    return list;
}

std::vector<Occurrence> sorted_occurrences(const State& s) {
    std::vector<Occurrence> list = s.occurrences;
    std::sort(list.begin(), list.end(),
              [](const Occurrence& a, const Occurrence& b) { return a.before(b); });
    return list;
}

bool made_ready(const NetTables& n, std::uint32_t place) {
    return std::any_of(n.declarations.events.begin(), n.declarations.events.end(),
                       [place](const EventDraft& e) { return e.makes_ready.value == place; });
}

std::uint64_t arrivals_before(const RichTokens& place, const Token& token) {
    return static_cast<std::uint64_t>(
        std::count_if(place.order.begin() + place.head, place.order.end(),
                      [&](std::uint32_t i) { return place.pool[i].serial < token.serial; }));
}

constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::max();
constexpr std::size_t kChecksumBytes = 8;

std::uint64_t checksum(std::span<const std::uint8_t> bytes) {
    return Hash64().add_text({reinterpret_cast<const char*>(bytes.data()), bytes.size()}).value();
}

}  // namespace

void canonical(const Net& net, const State& s, std::vector<std::uint8_t>& out) {
    Writer w(out);
    const NetTables& n = net.tables();
    const auto relative = [&](std::int64_t at) { w.number(at == kNever ? -1 : at - s.now); };
    for (const Counts& c : s.counts) {
        w.count(c.ready);
        w.count(c.total - c.ready);
    }
    for (const Value v : s.data) {
        w.number(v);
    }
    for (const Pending& p : plain_pending(s)) {
        w.count(p.what);
        relative(p.at);
    }
    for (std::size_t r = 0; r < s.rich.size(); ++r) {
        const RichTokens& place = s.rich[r];
        const std::uint32_t width = n.rich[r].attributes;
        w.count(place.size());
        for (std::uint32_t i = place.head; i < place.order.size(); ++i) {
            const Token& token = place.pool[place.order[i]];
            w.byte(token.ready ? 1 : 0);
            if (!token.ready) {
                relative(token.ready_at);
            }
            for (std::uint32_t k = 0; k < width; ++k) {
                w.number(place.values[std::size_t{place.order[i]} * width + k]);
            }
            // An event makes the oldest arrival ready, and what is ready at one instant goes by
            // arrival, too.
            if (made_ready(n, n.rich[r].place) && (!token.ready || token.ready_at == s.now)) {
                w.count(1 + arrivals_before(place, token));
            }
        }
        if (n.rich[r].keeps_order) {
            w.number(std::max<std::int64_t>(0, place.last_ready - s.now));
        }
    }
    for (const std::vector<Clock>& clocks : s.clocks) {
        w.count(clocks.size());
        for (const Clock& c : clocks) {
            w.byte(c.phase);
            w.number(c.phase == Clock::kRunning     ? c.at - s.now
                     : c.phase == Clock::kSuspended ? c.at
                                                    : 0);
        }
    }
    const std::vector<Occurrence> occurrences = sorted_occurrences(s);
    for (const Occurrence& o : occurrences) {
        relative(o.at);
        w.count(o.origin);
        w.count(o.event);
        w.number(o.every);
        // Repeated ones keep their place among those of one instant.
        w.count(static_cast<std::uint64_t>(
            std::count_if(occurrences.begin(), occurrences.end(),
                          [&o](const Occurrence& x) { return x.sequence < o.sequence; })));
    }
    w.count(s.offered == kNoIndex ? 0 : std::uint64_t{s.offered} + 1);
    w.byte(s.offer_consumed ? 1 : 0);
    std::vector<std::uint32_t> users =
        s.offered == kNoIndex ? std::vector<std::uint32_t>{} : s.offer_users;
    std::sort(users.begin(), users.end());
    for (const std::uint32_t t : users) {
        w.count(t);
    }
    w.number(std::max<std::int64_t>(0, s.next_beat - s.now));
    w.count(s.free_events);
    w.byte(s.asked_at == s.now && s.asked_firings == s.firings ? 1 : 0);
}

std::uint64_t hash(const Net& net, const State& state) {
    std::vector<std::uint8_t> bytes;
    canonical(net, state, bytes);
    return Hash64().add_text({reinterpret_cast<const char*>(bytes.data()), bytes.size()}).value();
}

std::vector<std::uint8_t> write_state(const Net& net, const State& s) {
    std::vector<std::uint8_t> out;
    Writer w(out);
    const NetTables& n = net.tables();
    w.byte(kVersion);
    w.word(net.hash());
    w.number(s.now);
    w.count(s.firings);
    w.word(s.log_hash);
    w.count(s.last == kNoIndex ? 0 : std::uint64_t{s.last} + 1);
    w.count(s.instant_firings);
    w.number(s.next_beat);
    w.count(s.serials);
    w.count(s.activities);
    w.count(s.sequences);
    std::uint64_t marked = 0;
    for (const Counts& c : s.counts) {
        marked += c.total != 0 ? 1 : 0;
    }
    w.count(marked);
    std::uint32_t last = 0;
    for (std::uint32_t p = 0; p < s.counts.size(); ++p) {
        if (s.counts[p].total != 0) {
            w.count(p - last);
            w.count(s.counts[p].total);
            w.count(s.counts[p].ready);
            last = p;
        }
    }
    for (const Value v : s.data) {
        w.number(v);
    }
    for (std::size_t r = 0; r < s.rich.size(); ++r) {
        const RichTokens& place = s.rich[r];
        const std::uint32_t width = n.rich[r].attributes;
        w.count(place.size());
        w.number(n.rich[r].keeps_order ? place.last_ready : 0);
        for (std::uint32_t i = place.head; i < place.order.size(); ++i) {
            const Token& token = place.pool[place.order[i]];
            w.byte(static_cast<std::uint8_t>((token.ready ? 1 : 0) |
                                             (token.ready_at == kNever ? 2 : 0) |
                                             (token.activity != kNoIndex ? 4 : 0)));
            w.count(s.serials - token.serial);
            w.count(static_cast<std::uint64_t>(s.now - token.arrival));
            if (token.ready_at != kNever) {
                w.number(token.ready_at - s.now);
            }
            if (token.activity != kNoIndex) {
                w.count(s.activities - token.activity);
            }
            if (n.rich[r].key.valid()) {
                w.number(token.key);
            }
            for (std::uint32_t k = 0; k < width; ++k) {
                w.number(place.values[std::size_t{place.order[i]} * width + k]);
            }
        }
    }
    const std::vector<Pending> plain = plain_pending(s);
    w.count(plain.size());
    for (const Pending& p : plain) {
        w.count(p.what);
        w.number(p.at - s.now);
    }
    for (const std::vector<Clock>& clocks : s.clocks) {
        w.count(clocks.size());
        for (const Clock& c : clocks) {
            w.byte(c.phase);
            w.number(c.at);
        }
    }
    w.count(s.occurrences.size());
    for (const Occurrence& o : sorted_occurrences(s)) {
        w.number(o.at - s.now);
        w.count(o.origin);
        w.count(o.rank);
        w.count(o.sequence);
        w.count(o.event);
        w.count(o.activity == kNoIndex ? 0 : std::uint64_t{o.activity} + 1);
        w.number(o.every);
    }
    w.count(s.offered == kNoIndex ? 0 : std::uint64_t{s.offered} + 1);
    if (s.offered != kNoIndex) {
        w.byte(static_cast<std::uint8_t>((s.offer_used ? 1 : 0) | (s.offer_consumed ? 2 : 0)));
        w.count(s.offer_users.size());
        for (const std::uint32_t t : s.offer_users) {
            w.count(t);
        }
    }
    for (const Lottery& l : s.lotteries) {
        w.count(l.tickets.size());
        if (!l.tickets.empty()) {
            w.word(puppetri::bit_cast<std::uint64_t>(l.clock));
            for (const Ticket& t : l.tickets) {
                w.word(puppetri::bit_cast<std::uint64_t>(t.key));
                w.count(t.transition);
            }
        }
    }
    w.sparse(s.ticket_draws);
    w.sparse(s.duration_draws);
    w.sparse(s.delay_draws);
    w.sparse(s.token_draws);
    w.word(checksum(out));
    return out;
}

Checked<State> read_state(const Net& net, std::span<const std::uint8_t> bytes) {
    const NetTables& n = net.tables();
    const auto bad = [](const char* what) {
        Diagnostics list;
        list.push_back({Severity::kError,
                        "bad-snapshot",
                        {},
                        "snapshot",
                        what,
                        "use a snapshot of this very net and version"});
        return Unexpected(std::move(list));
    };
    if (bytes.size() < kChecksumBytes) {
        return bad("these bytes are no snapshot");
    }
    const auto content = bytes.first(bytes.size() - kChecksumBytes);
    Reader r(content);
    if (Reader(bytes.last(kChecksumBytes)).word() != checksum(content)) {
        return bad("the bytes are damaged");
    }
    if (r.byte() != kVersion || r.word() != net.hash()) {
        return bad("these bytes are no snapshot of this net");
    }
    State s;
    const auto places = static_cast<std::uint32_t>(n.places.size());
    const auto transitions = static_cast<std::uint32_t>(n.transitions.size());
    const auto optional = [&](std::uint64_t bound) {
        const std::uint32_t x = r.below(bound + 1);
        return x == 0 ? kNoIndex : x - 1;
    };
    s.now = r.number();
    s.firings = r.count();
    s.log_hash = r.word();
    s.last = optional(transitions);
    s.instant_firings = r.below(1ull << 32);
    s.next_beat = r.number();
    s.serials = r.count();
    s.activities = r.below(1ull << 32);
    s.sequences = r.count();
    s.counts.resize(places);
    const std::uint32_t marked = r.length();
    std::uint64_t p = 0;
    for (std::uint32_t k = 0; k < marked && r.fine(); ++k) {
        p += r.count();
        if (p >= places) {
            return bad("a place that the net does not have");
        }
        s.counts[p].total = r.below(0x8000'0000u);
        s.counts[p].ready = r.below(std::uint64_t{s.counts[p].total} + 1);
    }
    for (std::uint32_t d = 0; d < n.data.size(); ++d) {
        s.data.push_back(r.number());
    }
    std::vector<std::uint64_t> unready(places);
    for (std::uint32_t i = 0; i < places; ++i) {
        unready[i] = s.counts[i].total - s.counts[i].ready;
    }
    s.rich.resize(n.rich.size());
    for (std::uint32_t k = 0; k < n.rich.size(); ++k) {
        RichTokens& place = s.rich[k];
        const std::uint32_t size = r.length();
        place.last_ready = r.number();
        std::uint32_t ready = 0;
        for (std::uint32_t i = 0; i < size && r.fine(); ++i) {
            Token token;
            token.alive = true;
            const std::uint8_t bits = r.byte();
            token.ready = (bits & 1) != 0;
            token.serial = s.serials - r.count();
            token.arrival =
                static_cast<std::int64_t>(static_cast<std::uint64_t>(s.now) - r.count());
            token.ready_at = (bits & 2) != 0 ? kNever : r.time_from(s.now);
            if ((bits & 4) != 0) {
                token.activity = s.activities - r.below(std::uint64_t{s.activities} + 1);
            }
            if (n.rich[k].key.valid()) {
                token.key = r.number();
            }
            for (std::uint32_t v = 0; v < n.rich[k].attributes; ++v) {
                place.values.push_back(r.number());
            }
            ready += token.ready ? 1 : 0;
            if (!token.ready && token.ready_at != kNever) {
                s.heap.push({token.ready_at, Pending::kToken | k, i});
            }
            place.pool.push_back(token);
            place.order.push_back(i);
        }
        const Counts& c = s.counts[n.rich[k].place];
        if (r.fine() && (c.total != size || c.ready != ready)) {
            return bad("counts that do not fit the tokens");
        }
        unready[n.rich[k].place] = 0;
    }
    const std::uint32_t plain = r.length();
    s.rings.resize(n.fifo_ticks.size());
    for (std::uint32_t k = 0; k < plain && r.fine(); ++k) {
        Pending pending;
        pending.what = r.below(places);
        pending.at = r.time_from(s.now);
        if (r.fine() && unready[pending.what]-- == 0) {
            return bad("counts that do not fit the ready times");
        }
        s.heap.push(pending);
    }
    for (const std::uint64_t left : unready) {
        if (r.fine() && left != 0) {
            return bad("counts that do not fit the ready times");
        }
    }
    s.clocks.resize(n.delays.size());
    for (std::uint32_t d = 0; d < n.delays.size(); ++d) {
        const std::uint32_t size = r.length();
        for (std::uint32_t i = 0; i < size && r.fine(); ++i) {
            Clock c;
            c.phase = static_cast<Clock::Phase>(r.below(3));
            c.at = r.number();
            if (c.phase == Clock::kRunning) {
                s.heap.push({c.at, Pending::kDelay | d, 0});
            }
            s.clocks[d].push_back(c);
        }
    }
    const std::uint32_t occurrences = r.length();
    for (std::uint32_t i = 0; i < occurrences && r.fine(); ++i) {
        Occurrence o;
        o.at = r.time_from(s.now);
        o.origin = r.below(3);
        o.rank = r.below(1ull << 32);
        o.sequence = r.count();
        o.event = r.below(n.events.size());
        o.activity = optional(0xFFFF'FFFFu);
        o.every = r.number();
        if (o.every < 0) {
            return bad("an event that is repeated backwards");
        }
        s.occurrences.push_back(o);  // sorted: a heap
    }
    s.offered = optional(n.events.size());
    if (s.offered != kNoIndex) {
        const std::uint8_t bits = r.byte();
        s.offer_used = (bits & 1) != 0;
        s.offer_consumed = (bits & 2) != 0;
        const std::uint32_t users = r.length();
        for (std::uint32_t i = 0; i < users && r.fine(); ++i) {
            s.offer_users.push_back(r.below(transitions));
        }
    }
    s.lotteries.resize(n.level_priority.size());
    for (std::uint32_t l = 0; l < s.lotteries.size(); ++l) {
        const std::uint32_t tickets = r.length();
        if (tickets != 0) {
            s.lotteries[l].clock = puppetri::bit_cast<double>(r.word());
            for (std::uint32_t i = 0; i < tickets && r.fine(); ++i) {
                Ticket t;
                t.key = puppetri::bit_cast<double>(r.word());
                t.transition = r.below(transitions);
                if (r.fine() && (n.transition[t.transition].level != l || !(t.key == t.key))) {
                    return bad("a ticket of another priority");
                }
                s.lotteries[l].tickets.push_back(t);
            }
        }
    }
    s.ticket_draws.resize(transitions);
    s.duration_draws.resize(n.duration_streams);
    s.delay_draws.resize(n.delays.size());
    s.token_draws.resize(n.token_streams);
    r.sparse(s.ticket_draws);
    r.sparse(s.duration_draws);
    r.sparse(s.delay_draws);
    r.sparse(s.token_draws);
    if (!r.fine() || !r.at_end()) {
        return bad("the bytes are damaged");
    }
    return s;
}

}  // namespace puppetri::net
