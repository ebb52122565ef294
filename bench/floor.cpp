// SPDX-License-Identifier: MIT
// The minimal loops. What each leaves out compared with the engine: thresholds and weights of arcs,
// priorities, tokens counted in places, everything that another net might need.
#include "floor.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <deque>
#include <string>
#include <vector>

#include "models.h"
#include "puppetri/base/elementary.h"
#include "puppetri/base/hash.h"
#include "puppetri/base/random.h"
#include "puppetri/base/rational.h"
#include "puppetri/net/log_hash.h"

namespace puppetri::bench {
namespace {

class LogHash {
 public:
    void add(std::int64_t now, std::uint64_t path_hash) {
        value_ = net::log_hash_step(value_, now, path_hash);
        ++firings_;
    }
    std::uint64_t value() const { return net::log_hash_value(value_, firings_); }

 private:
    std::uint64_t value_ = 0;
    std::uint64_t firings_ = 0;
};

// First in, first out.
class Ring {
 public:
    explicit Ring(std::uint32_t capacity) : items_(std::bit_ceil(capacity + 1)) {}
    bool empty() const { return head_ == tail_; }
    std::int64_t next() const { return items_[head_ & mask()].at; }
    std::uint32_t pop() { return items_[head_++ & mask()].who; }
    void push(std::int64_t at, std::uint32_t who) { items_[tail_++ & mask()] = {at, who}; }

 private:
    struct Item {
        std::int64_t at;
        std::uint32_t who;
    };
    std::uint32_t mask() const { return static_cast<std::uint32_t>(items_.size()) - 1; }
    std::vector<Item> items_;
    std::uint32_t head_ = 0;
    std::uint32_t tail_ = 0;
};

struct Ticket {
    double key;
    std::uint32_t transition;
    bool operator<(const Ticket& other) const {
        return key > other.key;
    }  // the least on top of a heap
};

// n philosophers: grabs 0 .. n-1, then the ends of the three phases.
class Philosophers {
 public:
    Philosophers(std::uint32_t n, std::uint64_t seed)
        : n_(n),
          free_(n, 1),
          state_(4 * n, kNo),
          draws_(4 * n, 0),
          rings_{Ring(n), Ring(n), Ring(n)} {
        for (std::uint32_t t = 0; t < 4 * n; ++t) {
            const std::string path = "t" + std::to_string(t);
            keys_.push_back(stream_key(seed, path, "ticket"));
            paths_.push_back(hash_text(path));
        }
        thinking_.assign(n, 1);
        for (std::uint32_t i = 0; i < n; ++i) {
            enter(i);
        }
    }

    std::uint64_t run(std::uint64_t firings) {
        while (firings > 0) {
            if (waiting_ == 0) {
                advance();
                continue;
            }
            fire(select());
            --firings;
        }
        return hash_.value();
    }

 private:
    enum Status : std::uint8_t { kNo, kFresh, kRaced };

    std::uint32_t right(std::uint32_t i) const { return i + 1 == n_ ? 0 : i + 1; }
    std::uint32_t left(std::uint32_t i) const { return i == 0 ? n_ - 1 : i - 1; }

    void enter(std::uint32_t t) {
        state_[t] = kFresh;
        fresh_.push_back(t);
        ++waiting_;
    }
    void leave(std::uint32_t t) {
        if (state_[t] == kRaced && --raced_ == 0) {
            tickets_.clear();
            clock_ = 0;
        }
        state_[t] = kNo;
        --waiting_;
    }
    // A ticket or an entry in fresh_ may be of a grab that a neighbour has made impossible: then
    // its status says so. It cannot have come back meanwhile within the same instant: eating takes
    // time.
    std::uint32_t select() {
        if (waiting_ == 1 && raced_ == 0) {
            while (state_[fresh_.back()] != kFresh) {
                fresh_.pop_back();
            }
            const std::uint32_t t = fresh_.back();
            fresh_.clear();
            ++draws_[t];
            leave(t);
            return t;
        }
        for (const std::uint32_t t : fresh_) {
            if (state_[t] == kFresh) {
                state_[t] = kRaced;
                ++raced_;
                const double u = uniform_from_bits(random_bits(keys_[t], draws_[t]++));
                tickets_.push_back({clock_ - puppetri::log(u), t});
                std::push_heap(tickets_.begin(), tickets_.end());
            }
        }
        fresh_.clear();
        for (;;) {
            const Ticket winner = tickets_.front();
            std::pop_heap(tickets_.begin(), tickets_.end());
            tickets_.pop_back();
            if (state_[winner.transition] == kRaced) {
                clock_ = winner.key;
                leave(winner.transition);
                return winner.transition;
            }
        }
    }
    void try_grab(std::uint32_t i) {
        if (thinking_[i] != 0 && free_[i] != 0 && free_[right(i)] != 0) {
            enter(i);
        }
    }
    void fire(std::uint32_t t) {
        hash_.add(now_, paths_[t]);
        if (t < n_) {
            thinking_[t] = free_[t] = free_[right(t)] = 0;
            for (const std::uint32_t neighbour : {left(t), right(t)}) {
                if (state_[neighbour] != kNo) {
                    leave(neighbour);
                }
            }
        }
        if (t < 3 * n_) {
            const std::uint32_t phase = t < n_ ? 0 : t < 2 * n_ ? 1 : 2;
            rings_[phase].push(now_ + kPhilosopherPhases[phase], t + n_);
            return;
        }
        const std::uint32_t i = t - 3 * n_;
        thinking_[i] = free_[i] = free_[right(i)] = 1;
        try_grab(left(i));
        try_grab(i);
        try_grab(right(i));
    }
    void advance() {
        now_ = SimTime::never().ticks;
        for (const Ring& ring : rings_) {
            now_ = ring.empty() ? now_ : std::min(now_, ring.next());
        }
        for (Ring& ring : rings_) {
            while (!ring.empty() && ring.next() == now_) {
                enter(ring.pop());
            }
        }
    }

    std::uint32_t n_;
    std::vector<std::uint8_t> free_;  // fork i lies on the table
    std::vector<std::uint8_t> thinking_;
    std::vector<std::uint8_t> state_;
    std::vector<std::uint64_t> draws_;
    std::vector<std::uint64_t> keys_;
    std::vector<std::uint64_t> paths_;
    std::vector<std::uint32_t> fresh_;
    std::vector<Ticket> tickets_;
    Ring rings_[3];
    std::uint32_t waiting_ = 0;
    std::uint32_t raced_ = 0;
    double clock_ = 0;
    std::int64_t now_ = 0;
    LogHash hash_;
};

// A duration as the engine draws it.
std::int64_t exponential(std::uint64_t key, std::uint64_t& count, double mean_s) {
    const double u = uniform_from_bits(random_bits(key, count++));
    return nearest_tick(mean_s * -puppetri::log(u)).ticks;
}

}  // namespace

std::uint64_t philosophers_floor(std::uint32_t n, std::uint64_t seed, std::uint64_t firings) {
    return Philosophers(n, seed).run(firings);
}

std::uint64_t hold_floor(std::uint32_t n, std::uint64_t seed, std::uint64_t firings) {
    const std::uint64_t key = stream_key(seed, "pending", "duration");
    const std::uint64_t path = hash_text("event");
    std::uint64_t count = 0;
    std::vector<std::int64_t> heap;
    const auto later = [](std::int64_t a, std::int64_t b) { return a > b; };
    for (std::uint32_t i = 0; i < n; ++i) {
        heap.push_back(exponential(key, count, kHoldMean_s));
    }
    std::make_heap(heap.begin(), heap.end(), later);
    LogHash hash;
    for (; firings > 0; --firings) {
        const std::int64_t now = heap.front();
        hash.add(now, path);
        // The new time sinks from the top: one pass instead of a pop and a push.
        const std::int64_t next = now + exponential(key, count, kHoldMean_s);
        std::size_t i = 0;
        for (;;) {
            std::size_t child = 2 * i + 1;
            if (child >= heap.size()) {
                break;
            }
            if (child + 1 < heap.size() && heap[child + 1] < heap[child]) {
                ++child;
            }
            if (next <= heap[child]) {
                break;
            }
            heap[i] = heap[child];
            i = child;
        }
        heap[i] = next;
    }
    return hash.value();
}

namespace {

// Arrivals, services and the log; `come` and `go` keep what is to be known of the customers.
template <class Come, class Go>
std::uint64_t play_mm1(std::uint64_t seed, std::uint64_t firings, Come come, Go go) {
    const std::uint64_t arrive_key = stream_key(seed, "arrive", "delay");
    const std::uint64_t serve_key = stream_key(seed, "serve", "delay");
    const std::uint64_t arrive_path = hash_text("arrive");
    const std::uint64_t serve_path = hash_text("serve");
    constexpr std::int64_t kNever = SimTime::never().ticks;
    std::uint64_t arrivals = 0;
    std::uint64_t services = 0;
    std::uint64_t queue = 0;
    std::int64_t arrival = exponential(arrive_key, arrivals, kArrivalMean_s);
    std::int64_t departure = kNever;
    LogHash hash;
    for (; firings > 0; --firings) {
        // Exact coincidences in ticks have probability 1e-9 per event; the hash would show one.
        if (arrival < departure) {
            const std::int64_t now = arrival;
            hash.add(now, arrive_path);
            come(now);
            arrival = now + exponential(arrive_key, arrivals, kArrivalMean_s);
            if (queue++ == 0) {
                departure = now + exponential(serve_key, services, kServiceMean_s);
            }
        } else {
            const std::int64_t now = departure;
            hash.add(now, serve_path);
            go(now);
            departure =
                --queue != 0 ? now + exponential(serve_key, services, kServiceMean_s) : kNever;
        }
    }
    return hash.value();
}

}  // namespace

std::uint64_t mm1_floor(std::uint64_t seed, std::uint64_t firings) {
    return play_mm1(
        seed, firings, [](std::int64_t) {}, [](std::int64_t) {});
}

QueueSums mm1_customers_floor(std::uint64_t seed, std::uint64_t firings) {
    struct Customer {
        std::int64_t number, arrived;
    };
    std::deque<Customer> queue;
    std::int64_t number = 0, last = 0, longest = 0;
    double area = 0, stays = 0;
    std::uint64_t left = 0;
    const auto pass = [&](std::int64_t now) {
        area += static_cast<double>(now - last) * static_cast<double>(queue.size());
        last = now;
    };
    QueueSums out;
    out.log_hash = play_mm1(
        seed, firings,
        [&](std::int64_t now) {
            pass(now);
            queue.push_back({number++, now});
        },
        [&](std::int64_t now) {
            pass(now);
            const std::int64_t stay = now - queue.front().arrived;
            queue.pop_front();
            stays += static_cast<double>(stay);
            longest = std::max(longest, stay);
            ++left;
        });
    constexpr auto kTicks = static_cast<double>(kTicksPerSecond);
    out.mean_length = area / static_cast<double>(last);
    out.mean_stay_s = stays / static_cast<double>(left) / kTicks;
    out.longest_stay_s = static_cast<double>(longest) / kTicks;
    return out;
}

}  // namespace puppetri::bench
