// SPDX-License-Identifier: MIT
// Workers share the table of states, without locks, and a queue of ranges of states, with one. Each
// expands what it finds itself first; a segment that is full, and what is left of one when somebody
// has nothing to do, goes to the queue. The table grows, and fields are widened, when all have come
// to the rendezvous; filling the new table is shared again.
#include "threads.h"

#include <algorithm>
#if !defined(__EMSCRIPTEN__) || defined(__EMSCRIPTEN_PTHREADS__)
#include <thread>
#endif

#include "worker.h"

namespace puppetri::proof {

template <unsigned kWords, bool kShared>
bool Worker<kWords, kShared>::get_work(Range& range) {
    std::unique_lock<std::mutex> lock(s_.mutex);
    while (true) {
        if (s_.stop || s_.finished) {
            return false;
        }
        if (s_.pause) {
            lock.unlock();
            rendezvous();
            lock.lock();
            continue;
        }
        if (!s_.waiting.empty()) {
            range = s_.waiting.front();
            s_.waiting.pop_front();
            return true;
        }
        ++s_.idle;
        s_.hungry = s_.idle;
        if (s_.idle == s_.workers) {
            s_.finished = true;
            s_.awake.notify_all();
        } else {
            s_.awake.wait(
                lock, [&] { return !s_.waiting.empty() || s_.finished || s_.stop || s_.pause; });
        }
        --s_.idle;
        s_.hungry = s_.idle;
    }
}

// Everybody comes here with an empty batch. One enlarges, all fill the new table.
template <unsigned kWords, bool kShared>
void Worker<kWords, kShared>::rendezvous() {
    note_bounds();
    {
        const std::lock_guard<std::mutex> lock(s_.mutex);
        note_fill();
    }
    const auto meet = [&](auto&& act) {
        std::unique_lock<std::mutex> lock(s_.mutex);
        const std::uint64_t generation = s_.generation;
        ++s_.arrived;
        s_.gate.wait(lock, [&] { return s_.generation != generation || s_.arrived >= s_.workers; });
        if (s_.generation == generation) {
            act();
            s_.arrived = 0;
            ++s_.generation;
            s_.gate.notify_all();
        }
    };
    meet([&] {
        if (s_.widening) {
            if (!s_.widen(s_.wider)) {
                s_.end(Ended::kMemory);
            }
            s_.widening = false;
            s_.next_slice = s_.index.slices();  // it is clear
        } else {
            s_.grow_index(true);
            s_.next_slice = 0;
        }
        s_.next_segment = 0;
    });
    // Fresh memory is made where it is first written to: that is shared too.
    for (std::uint32_t slice = 0; !s_.stop && (slice = s_.next_slice++) < s_.index.slices();) {
        s_.index.clear_slice(slice);
    }
    meet([] {});
    adopt_form();
    other_form_ = kWords != 0 && words_ != kWords;
    if (!s_.stop) {
        const std::uint32_t segments = s_.form.store->segments();
        while (true) {
            const std::uint32_t segment = s_.next_segment++;
            if (segment >= segments) {
                break;
            }
            if (other_form_) {
                s_.template insert_segment<0, true>(segment);
            } else {
                s_.template insert_segment<kWords, true>(segment);
            }
        }
    }
    meet([&] { s_.pause = false; });
}

template <unsigned kWords, bool kShared>
void Worker<kWords, kShared>::want_wider() {
    if (!wanted_fits_) {
        s_.end(Ended::kStates);
        return;
    }
    {
        const std::lock_guard<std::mutex> lock(s_.mutex);
        if (!s_.widening) {
            s_.widening = true;
            s_.wider = wanted_;
        }
        for (std::uint32_t p = 0; p < wanted_.size(); ++p) {
            s_.wider[p] = std::max(s_.wider[p], wanted_[p]);
        }
        s_.pause = true;
        s_.awake.notify_all();
    }
    rendezvous();
}

template <unsigned kWords, bool kShared>
bool Worker<kWords, kShared>::share() {
    Range range;
    while (!s_.stop) {
        if (other_form_) {  // another worker goes on, with all that is left
            const std::lock_guard<std::mutex> lock(s_.mutex);
            note_fill();
            if (range.from < range.to) {
                s_.waiting.push_back(range);
                s_.awake.notify_one();
            }
            return false;
        }
        if (s_.pause) {
            rendezvous();
            continue;
        }
        if (!reserve()) {
            break;
        }
        if (other_form_) {
            continue;
        }
        if (range.from == range.to) {
            if (own_.head < own_.next) {
                range = {own_.head, own_.next};
                own_.head = own_.next;
            } else if (!get_work(range)) {
                break;
            } else {
                continue;  // there may have been a rendezvous
            }
        }
        bool narrow = false;
        while (range.from < range.to && count_ < kBatch && !narrow) {
            narrow = !expand(range.from);
            range.from += narrow ? 0 : 1;
        }
        resolve();
        tell();
        if (narrow) {
            want_wider();
        }
        // What somebody else could do: the rest of this range, or what has just been found.
        if (s_.hungry.load(std::memory_order_relaxed) != 0 &&
            (own_.next - own_.head) + (range.to - range.from) > 1) {
            const std::lock_guard<std::mutex> lock(s_.mutex);
            if (range.to - range.from > 1) {
                const std::uint32_t middle = range.from + (range.to - range.from) / 2;
                s_.waiting.push_back({middle, range.to});
                range.to = middle;
                s_.awake.notify_one();
            } else {
                give_away();
            }
        }
    }
    const std::lock_guard<std::mutex> lock(s_.mutex);
    note_fill();
    note_bounds();
    --s_.workers;
    s_.awake.notify_all();
    s_.gate.notify_all();
    return true;
}

namespace {

// Fields that grow may come to need more words: then each thread goes on with another worker.
void body(Search& search, Own& own) {
    for (bool done = false; !done;) {
        switch (search.form.packing.words) {
            case 1:
                done = Worker<1, true>(search, own).share();
                break;
            case 2:
                done = Worker<2, true>(search, own).share();
                break;
            default:
                done = Worker<0, true>(search, own).share();
        }
    }
}

void work(Search& search, std::vector<Own>& owns) {
#if !defined(__EMSCRIPTEN__) || defined(__EMSCRIPTEN_PTHREADS__)
    std::vector<std::thread> threads;
    for (std::size_t i = 1; i < owns.size(); ++i) {
        threads.emplace_back([&, i] { body(search, owns[i]); });
    }
#endif
    body(search, owns[0]);
#if !defined(__EMSCRIPTEN__) || defined(__EMSCRIPTEN_PTHREADS__)
    for (std::thread& t : threads) {
        t.join();
    }
#endif
}

}  // namespace

std::vector<Own> run_together(Search& search, unsigned threads) {
#if defined(__EMSCRIPTEN__) && !defined(__EMSCRIPTEN_PTHREADS__)
    threads = 1;
#endif
    // What the first worker has left to do, cut at the ends of segments.
    Own& first = search.own;
    for (std::uint32_t from = first.head; from < first.next;) {
        const std::uint32_t end = (from | (StateStore::kSegment - 1)) + 1;
        search.waiting.push_back({from, std::min(end, first.next)});
        from = std::min(end, first.next);
    }
    first.head = first.next;
    std::vector<Own> owns(threads);
    owns[0] = std::move(first);
    search.workers = threads;
    // The others begin with an empty segment each.
    for (std::size_t i = 1; i < owns.size(); ++i) {
        std::uint32_t segment = 0;
        while (!search.stop && !search.new_segment(segment)) {
            search.grow_index();
            for (std::uint32_t s = 0; !search.stop && s < search.form.store->segments(); ++s) {
                search.insert_segment<0, false>(s);
            }
        }
        owns[i].next = owns[i].head = segment;
        owns[i].end = segment + StateStore::kSegment;
    }
    work(search, owns);
    return owns;
}

}  // namespace puppetri::proof
