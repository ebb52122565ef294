// SPDX-License-Identifier: MIT
// Marked places after one another with what waits in them, then data, delays, occurrences. Numbers
// have variable length; times are few and many bytes long, so they are kept apart and numbered.
#include "state_codec.h"

#include <algorithm>
#include <limits>

#include "puppetri/base/require.h"
#include "puppetri/base/varint.h"
#include "puppetri/net/timekeeper.h"

namespace puppetri::proof {

using namespace net;

namespace {

constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::max();

class Writer {
 public:
    explicit Writer(std::vector<std::uint8_t>& out) : out_(out) {}
    void byte(unsigned b) { out_.push_back(static_cast<std::uint8_t>(b)); }
    void count(std::uint64_t x) { put_varint(out_, x); }
    void number(std::int64_t x) { count(zigzag(x)); }

 private:
    std::vector<std::uint8_t>& out_;
};

// Reads what Writer wrote: no checks, these bytes come from nowhere else.
class Reader {
 public:
    explicit Reader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}
    std::uint8_t byte() { return bytes_[next_++]; }
    std::uint64_t count() { return get_varint(bytes_, next_); }
    std::uint32_t small() { return static_cast<std::uint32_t>(count()); }
    std::int64_t number() { return unzigzag(count()); }
    std::size_t at() const { return next_; }

 private:
    std::span<const std::uint8_t> bytes_;
    std::size_t next_ = 0;
};

// Of a token with a record.
enum TokenBit : unsigned { kReady = 1, kOpen = 2, kReadyNow = 4 };

bool is_plain(const Pending& p) { return (p.what & ~Pending::kIndexMask) == Pending::kPlain; }

// The plain tokens that are not ready yet, by place and time.
void plain_pending(const State& s, std::vector<Pending>& list) {
    list.clear();
    for (const PendingRing& ring : s.rings) {
        for (std::uint32_t i = 0; i < ring.size; ++i) {
            if (is_plain(ring.at(i))) {
                list.push_back(ring.at(i));
            }
        }
    }
    for (const Pending& p : s.heap.items) {
        if (is_plain(p)) {
            list.push_back(p);
        }
    }
    std::sort(list.begin(), list.end(), [](const Pending& a, const Pending& b) {
        return a.what != b.what ? a.what < b.what : a.at < b.at;
    });
}

std::vector<Occurrence> sorted_occurrences(const State& s) {
    std::vector<Occurrence> list = s.occurrences;
    std::sort(list.begin(), list.end(), [](const Occurrence& a, const Occurrence& b) {
        if (is_wait(a.at) && is_wait(b.at)) {
            return a.sequence < b.sequence;  // which is first, nobody knows
        }
        return a.before(b);
    });
    return list;
}

}  // namespace

void collect_waiting(const Net& net, const State& s, std::vector<Waiting>& out) {
    const NetTables& n = net.tables();
    out.clear();
    std::vector<Pending> plain;
    plain_pending(s, plain);
    std::size_t next = 0;
    for (std::uint32_t p = 0; p < n.places.size(); ++p) {
        for (; next < plain.size() && plain[next].what == p; ++next) {
            out.push_back({Waiting::kPlace, p, plain[next].at - kWaiting, 0});
        }
        if (n.place_rich.empty() || n.place_rich[p] == kNoIndex) {
            continue;
        }
        const RichTokens& place = s.rich[n.place_rich[p]];
        const std::uint32_t width = n.rich[n.place_rich[p]].attributes;
        for (std::uint32_t i = place.head; i < place.order.size(); ++i) {
            const std::uint32_t slot = place.order[i];
            const Token& token = place.pool[slot];
            if (!token.ready && is_wait(token.ready_at)) {
                out.push_back({Waiting::kRecord, p, token.ready_at - kWaiting, token.serial});
            }
            for (std::uint32_t k = 0; k < width; ++k) {
                const Value v = place.values[std::size_t{slot} * width + k];
                if (is_wait(v)) {
                    out.push_back({Waiting::kAttribute, p, v - kWaiting, token.serial});
                }
            }
        }
    }
    for (std::uint32_t d = 0; d < s.clocks.size(); ++d) {
        for (const Clock& c : s.clocks[d]) {
            if (c.phase != Clock::kDue && is_wait(c.at)) {
                out.push_back({c.phase == Clock::kRunning ? Waiting::kDelay : Waiting::kSuspended,
                               n.delays[d].transition, c.at - kWaiting, 0});
            }
        }
    }
    for (const Occurrence& o : sorted_occurrences(s)) {
        if (is_wait(o.at)) {
            out.push_back({Waiting::kSchedule, o.event, o.at - kWaiting, 0});
        }
    }
}

StateCodec::StateCodec(const Net& net, ClockForm form) : tables_(&net.tables()), form_(form) {
    made_ready_.assign(tables_->rich.size(), 0);
    for (const EventDraft& e : tables_->declarations.events) {
        if (e.makes_ready.valid() && !tables_->place_rich.empty() &&
            tables_->place_rich[e.makes_ready.value] != kNoIndex) {
            made_ready_[tables_->place_rich[e.makes_ready.value]] = 1;
        }
    }
}

std::uint32_t StateCodec::intern(std::int64_t time) {
    const auto [it, fresh] = numbers_.try_emplace(time, static_cast<std::uint32_t>(times_.size()));
    if (fresh) {
        times_.push_back(time);
    }
    return it->second;
}

void StateCodec::encode(const State& s, std::vector<std::uint8_t>& out,
                        const std::unordered_map<std::int64_t, std::uint32_t>* variables) {
    const NetTables& n = *tables_;
    Writer w(out);
    const auto time = [&](std::int64_t at) {
        if (is_wait(at)) {
            if (form_ == ClockForm::kClasses) {
                w.count(variables->at(at - kWaiting));
            }
        } else {
            w.count(intern(at - s.now));
        }
    };
    plain_pending(s, pending_);
    std::uint32_t marked = 0;
    for (const Counts& c : s.counts) {
        marked += c.total != 0 ? 1 : 0;
    }
    w.count(marked);
    std::size_t next = 0;
    std::uint32_t last = 0;
    for (std::uint32_t p = 0; p < s.counts.size(); ++p) {
        const Counts c = s.counts[p];
        if (c.total == 0) {
            continue;
        }
        w.count(p - last);
        last = p;
        w.count(2 * std::uint64_t{c.total - 1} + (c.ready == c.total ? 0 : 1));
        if (c.ready != c.total) {
            w.count(c.ready);
        }
        if (form_ == ClockForm::kClasses) {
            std::vector<std::uint32_t> list;
            for (; next < pending_.size() && pending_[next].what == p; ++next) {
                list.push_back(variables->at(pending_[next].at - kWaiting));
            }
            std::sort(list.begin(), list.end());
            for (const std::uint32_t v : list) {
                w.count(v);
            }
        }
        for (; next < pending_.size() && pending_[next].what == p; ++next) {
            time(pending_[next].at);
        }
        if (n.place_rich.empty() || n.place_rich[p] == kNoIndex) {
            continue;
        }
        const std::uint32_t r = n.place_rich[p];
        const RichTokens& place = s.rich[r];
        const std::uint32_t width = n.rich[r].attributes;
        for (std::uint32_t i = place.head; i < place.order.size(); ++i) {
            const std::uint32_t slot = place.order[i];
            const Token& token = place.pool[slot];
            const bool open = !token.ready && token.ready_at == kNever;
            const bool now = token.ready && made_ready_[r] != 0 && token.ready_at == s.now;
            w.byte((token.ready ? kReady : 0u) | (open ? kOpen : 0u) | (now ? kReadyNow : 0u));
            if (!token.ready && !open) {
                time(token.ready_at);
            }
            if (n.rich[r].key.valid()) {
                w.number(token.key);
            }
            for (std::uint32_t k = 0; k < width; ++k) {
                const Value v = place.values[std::size_t{slot} * width + k];
                w.number(is_wait(v) ? kWaiting : v);
                if (is_wait(v)) {
                    time(v);
                }
            }
            if (made_ready_[r] != 0) {  // then the order of arrival decides who is made ready
                std::uint32_t rank = 0;
                for (std::uint32_t j = place.head; j < place.order.size(); ++j) {
                    rank += place.pool[place.order[j]].serial < token.serial ? 1 : 0;
                }
                w.count(rank);
            }
        }
        if (n.rich[r].keeps_order && form_ == ClockForm::kExact) {
            w.count(intern(std::max<std::int64_t>(0, place.last_ready - s.now)));
        }
    }
    for (const Value v : s.data) {
        w.number(v);
    }
    for (const std::vector<Clock>& clocks : s.clocks) {
        w.count(clocks.size());
        for (const Clock& c : clocks) {
            // A suspended one keeps what is left, also nothing.
            const bool none = c.phase == Clock::kSuspended && c.at == 0;
            w.byte(c.phase + (none ? 4u : 0u));
            if (c.phase == Clock::kRunning) {
                time(c.at);
            } else if (c.phase == Clock::kSuspended && !none) {
                is_wait(c.at) ? time(c.at) : w.count(intern(c.at));
            }
        }
    }
    const std::vector<Occurrence> occurrences = sorted_occurrences(s);
    w.count(occurrences.size());
    for (const Occurrence& o : occurrences) {
        std::uint32_t rank = 0;
        for (const Occurrence& other : occurrences) {
            rank += other.sequence < o.sequence ? 1 : 0;
        }
        w.byte(is_wait(o.at) ? 1 : 0);
        time(o.at);
        w.count(o.origin);
        w.count(o.rank);
        w.count(rank);
        w.count(o.event);
        w.count(o.every == 0 ? 0 : 1 + std::uint64_t{intern(o.every)});
    }
    w.count(s.offered == kNoIndex ? 0 : std::uint64_t{s.offered} + 1);
    if (s.offered != kNoIndex) {
        w.byte(s.offer_consumed ? 1 : 0);
        std::vector<std::uint32_t> users = s.offer_users;
        std::sort(users.begin(), users.end());
        w.count(users.size());
        for (const std::uint32_t t : users) {
            w.count(t);
        }
    }
    if (n.paced && form_ == ClockForm::kExact) {
        w.count(intern(std::max<std::int64_t>(0, s.next_beat - s.now)));
    }
}

State StateCodec::decode(std::span<const std::uint8_t> bytes, std::size_t* length) const {
    const NetTables& n = *tables_;
    Reader r(bytes);
    State s;
    s.now = 0;
    s.serials = 1;
    std::int64_t number = 0;
    const auto wait = [&]() -> std::int64_t {
        return kWaiting + 1 +
               (form_ == ClockForm::kClasses ? static_cast<std::int64_t>(r.count()) : number++);
    };
    const auto time = [&] { return form_ == ClockForm::kExact ? times_[r.count()] : wait(); };
    s.counts.resize(n.places.size());
    s.rich.resize(n.rich.size());
    s.rings.resize(n.fifo_ticks.size());
    s.clocks.resize(n.delays.size());
    s.lotteries.resize(n.level_priority.size());
    s.duration_draws.resize(n.duration_streams);
    s.delay_draws.resize(n.delays.size());
    s.token_draws.resize(n.token_streams);
    const std::uint32_t marked = r.small();
    std::uint32_t p = 0;
    for (std::uint32_t m = 0; m < marked; ++m) {
        p += r.small();
        const std::uint64_t code = r.count();
        Counts& c = s.counts[p];
        c.total = static_cast<std::uint32_t>(code / 2) + 1;
        c.ready = code % 2 == 0 ? c.total : r.small();
        if (n.place_rich.empty() || n.place_rich[p] == kNoIndex) {
            for (std::uint32_t k = c.ready; k < c.total; ++k) {
                s.heap.push({time(), Pending::kPlain | p, 0});
            }
            continue;
        }
        const std::uint32_t rich = n.place_rich[p];
        const RichPlaceTable& table = n.rich[rich];
        RichTokens& place = s.rich[rich];
        for (std::uint32_t i = 0; i < c.total; ++i) {
            Token token;
            token.alive = true;
            token.arrival = -1;
            const unsigned bits = r.byte();
            token.ready = (bits & kReady) != 0;
            token.ready_at = (bits & kReadyNow) != 0 ? 0
                             : token.ready           ? -1
                             : (bits & kOpen) != 0   ? kNever
                                                     : time();
            if (table.key.valid()) {
                token.key = r.number();
            }
            for (std::uint32_t k = 0; k < table.attributes; ++k) {
                const Value v = r.number();
                place.values.push_back(v == kWaiting ? time() : v);
            }
            // Newest first: the last one in the order is the oldest.
            token.serial = s.serials + (made_ready_[rich] != 0                    ? r.count()
                                        : table.discipline == Discipline::kNewest ? c.total - 1 - i
                                                                                  : i);
            if (!token.ready && token.ready_at != kNever) {
                s.heap.push({token.ready_at, Pending::kToken | rich, i});
            }
            place.pool.push_back(token);
            place.order.push_back(i);
        }
        s.serials += c.total;
        if (table.keeps_order && form_ == ClockForm::kExact) {
            place.last_ready = times_[r.count()];
        }
    }
    s.data.reserve(n.data.size());
    for (std::uint32_t d = 0; d < n.data.size(); ++d) {
        s.data.push_back(r.number());
    }
    for (std::uint32_t d = 0; d < n.delays.size(); ++d) {
        for (std::uint32_t k = r.small(); k > 0; --k) {
            Clock c;
            const unsigned phase = r.byte();
            c.phase = static_cast<Clock::Phase>(phase & 3);
            if (c.phase == Clock::kRunning) {
                c.at = time();
                s.heap.push({c.at, Pending::kDelay | d, 0});
            } else if (c.phase == Clock::kSuspended && phase < 4) {
                c.at = time();
            }
            s.clocks[d].push_back(c);
        }
    }
    const std::uint32_t occurrences = r.small();
    for (std::uint32_t i = 0; i < occurrences; ++i) {
        Occurrence o;
        o.at = r.byte() != 0 ? wait() : times_[r.count()];
        o.origin = r.small();
        o.rank = r.small();
        o.sequence = r.count();
        o.event = r.small();
        const std::uint64_t every = r.count();
        o.every = every == 0 ? 0 : times_[every - 1];
        s.occurrences.push_back(o);
    }
    std::sort(s.occurrences.begin(), s.occurrences.end(),
              [](const Occurrence& a, const Occurrence& b) { return a.before(b); });
    s.sequences = occurrences;
    const std::uint64_t offered = r.count();
    s.offered = offered == 0 ? kNoIndex : static_cast<std::uint32_t>(offered - 1);
    if (s.offered != kNoIndex) {
        s.offer_used = true;
        s.offer_consumed = r.byte() != 0;
        for (std::uint32_t k = r.small(); k > 0; --k) {
            s.offer_users.push_back(r.small());
        }
    }
    if (n.paced && form_ == ClockForm::kExact) {
        s.next_beat = times_[r.count()];
    }
    if (length != nullptr) {
        *length = r.at();
    }
    return s;
}

}  // namespace puppetri::proof
