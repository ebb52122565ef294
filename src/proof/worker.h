// SPDX-License-Identifier: MIT
// The inner loop. States are expanded until a batch of successors has come together; their places
// in the table are fetched into the cache while the batch is made and looked at afterwards, so that
// the memory works on many of them at a time: its latency is what a simple loop waits for.
#pragma once
#include <bit>
#include <cstdint>
#include <vector>

#include "search.h"
#include "stubborn.h"

namespace puppetri::proof {

// kWords: of 64 bits per state; 0: as many as the packing says. kShared: others work too.
template <unsigned kWords, bool kShared>
class Worker {
 public:
    Worker(Search& search, Own& own) : s_(search), own_(own) { adopt_form(); }

    // Breadth first, alone, until everything is expanded, so many states are known, or somebody
    // says stop; or until the packing has another number of words: then another worker goes on.
    void breadth_first(std::uint64_t up_to_states) {
        while (own_.head < own_.next && own_.states < up_to_states && !s_.stop) {
            if (!reserve()) {
                break;
            }
            const std::uint32_t end = own_.next;
            while (own_.head < end && count_ < kBatch) {
                if (!expand(own_.head)) {
                    resolve();
                    if (!widen_alone()) {
                        return;
                    }
                    break;
                }
                ++own_.head;
            }
            resolve();
            tell();
        }
        note_fill();
        note_bounds();
    }

    // The same depth first: what is deep is found sooner.
    void depth_first() {
        depth_first_ = true;
        while (!own_.stack.empty() && !s_.stop) {
            if (!reserve()) {
                break;
            }
            // Some states together, so that there is something to fetch ahead.
            bool narrow = false;
            while (!own_.stack.empty() && count_ < kDeepBatch && !narrow) {
                const std::uint32_t id = own_.stack.back();
                own_.stack.pop_back();
                narrow = !expand(id);
                if (narrow) {
                    own_.stack.push_back(id);
                }
            }
            resolve();
            if (narrow && !widen_alone()) {
                return;
            }
            tell();
        }
        note_fill();
        note_bounds();
    }

    // With others, until everything is expanded.
    // Gives  false if the packing has got another number of words: another worker is to go on.
    bool share();

    // Raises the bounds by what was seen.
    void note_bounds() {
        own_.bounds.resize(s_.net.place_count(), 0);
        s_.form.scanner->raise_bounds(sight_, own_.bounds);
        own_.most_tokens = std::max(own_.most_tokens, sight_.most_tokens);
    }

    // For whoever builds a graph. What a state enables, and the tokens of its places:
    void look_at(std::uint32_t id) {
        store_->template load<kWords>(id, state_.data());
        scanner_->scan(state_.data(), sight_);
    }
    std::uint32_t tokens(std::uint32_t place) const {
        return scanner_->tokens(state_.data(), sight_, place);
    }
    const Scanner::Sight& sight() const { return sight_; }
    // The numbers of the successors, all of which are known, in the order of transitions.
    template <class Take>
    void successors(std::uint32_t id, Take&& take) {
        expand(id);
        for (std::uint32_t i = 0; i < count_; ++i) {
            take(labels_[i], find(i));
        }
        count_ = 0;
    }

 private:
    static constexpr std::uint32_t kBatch = 192, kDeepBatch = 48;
    static constexpr std::uint32_t kAhead = 8;

    std::uint32_t words() const { return kWords != 0 ? kWords : words_; }

    void adopt_form() {
        words_ = s_.form.packing.words;
        scanner_ = s_.form.scanner.get();
        store_ = s_.form.store.get();
        changes_ = s_.form.changes.data();
        sight_ = scanner_->make_sight();
        set_words_ = scanner_->words();
        capacity_ = kBatch + s_.net.transition_count();
        state_.assign(words_, 0);
        batch_.assign(std::uint64_t{capacity_} * words_, 0);
        hashes_.assign(capacity_, 0);
        labels_.assign(capacity_, 0);
        parents_.assign(capacity_, 0);
        fire_.assign(set_words_, 0);
        marking_.assign(s_.net.place_count(), 0);
    }

    // Numbers for all that a batch can bring.
    bool reserve() {
        while (own_.end - own_.next + own_.spare.size() * StateStore::kSegment < capacity_) {
            std::uint32_t first = 0;
            bool made = false;
            if constexpr (kShared) {
                const std::lock_guard<std::mutex> lock(s_.mutex);
                made = s_.new_segment(first);
                if (!made) {
                    s_.pause = true;
                    s_.awake.notify_all();
                }
            } else {
                made = s_.new_segment(first);
            }
            if (s_.stop) {
                return false;
            }
            if (made) {
                own_.spare.insert(own_.spare.begin(), first);
                continue;
            }
            if constexpr (kShared) {
                rendezvous();
            } else {
                note_fill();
                s_.grow_index();
                if (s_.stop) {
                    return false;
                }
                insert_all();
            }
        }
        return true;
    }

    void note_fill() {
        const std::uint32_t segment = (own_.end - 1) >> StateStore::kSegmentBits;
        s_.fill[segment] = own_.next - (segment << StateStore::kSegmentBits);
    }

    void insert_all() {
        for (std::uint32_t i = 0; i < s_.form.store->segments(); ++i) {
            s_.template insert_segment<kWords, false>(i);
        }
    }

    // Gives  false if this worker cannot go on: an end, or another number of words.
    bool widen_alone() {
        note_fill();
        note_bounds();
        if (!wanted_fits_ || !s_.widen(wanted_)) {
            s_.end(wanted_fits_ ? Ended::kMemory : Ended::kStates);
            return false;
        }
        if (kWords != 0 && s_.form.packing.words != kWords) {
            for (std::uint32_t i = 0; i < s_.form.store->segments(); ++i) {
                s_.template insert_segment<0, false>(i);
            }
            return false;
        }
        adopt_form();
        insert_all();
        return true;
    }

    void tell() {
        if (++batches_ % 16 == 0) {
            s_.look(own_.states - own_.told_states, own_.edges - own_.told_edges);
            own_.told_states = own_.states;
            own_.told_edges = own_.edges;
        }
    }

    // Adds the successors of a state to the batch.
    // Gives  false, and has done nothing, if one of them does not fit: see wanted_.
    bool expand(std::uint32_t id) {
        look_at(id);
        const std::uint64_t* enabled = sight_.enabled.data();
        if (!s_.levels.empty()) {
            enabled = of_highest_level(enabled);
        }
        if (scanner_->may_grow()) {
            const std::uint64_t* fits = sight_.enabled.data() + set_words_;
            std::uint64_t missing = 0;
            for (std::uint32_t w = 0; w < set_words_; ++w) {
                missing |= enabled[w] & ~fits[w];
            }
            if (missing != 0) {
                want(enabled, fits);
                return false;
            }
        }
        if (s_.open_questions.load(std::memory_order_relaxed) != 0) {
            ask(id);
        }
        if (s_.options.reduce && s_.stubborn) {
            for (std::uint32_t w = 0; w < set_words_; ++w) {
                fire_[w] = enabled[w];
            }
            s_.form.packing.decode(state_, marking_);
            s_.stubborn->reduce(marking_, fire_, scratch_);
            enabled = fire_.data();
        }
        if (!s_.symmetry.none()) {
            add_representatives(id, enabled);
            return true;
        }
        const std::uint64_t* const state = state_.data();
        std::uint32_t count = count_;
        for (std::uint32_t w = 0; w < set_words_; ++w) {
            for (std::uint64_t left = enabled[w]; left != 0; left &= left - 1) {
                const std::uint32_t t = w * 64 + static_cast<std::uint32_t>(std::countr_zero(left));
                const std::uint64_t* const change = changes_ + std::uint64_t{t} * words();
                std::uint64_t* const made = batch_.data() + std::uint64_t{count} * words();
                for (std::uint32_t i = 0; i < words(); ++i) {
                    made[i] = state[i] + change[i];
                }
                const std::uint64_t hash = hash_of<kWords>(made, words_);
                hashes_[count] = hash;
                labels_[count] = t;
                parents_[count] = id;
                s_.index.prefetch(hash);
                ++count;
            }
        }
        own_.edges += count - count_;
        count_ = count;
        return true;
    }

    // The successors' representatives: unpacked, sorted, packed again.
    void add_representatives(std::uint32_t id, const std::uint64_t* enabled) {
        for (std::uint32_t t = 0; t < s_.net.transition_count(); ++t) {
            if ((enabled[t / 64] >> (t & 63) & 1) == 0) {
                continue;
            }
            const std::uint64_t* const change = changes_ + std::uint64_t{t} * words();
            const std::span<std::uint64_t> made(batch_.data() + std::uint64_t{count_} * words(),
                                                words());
            for (std::uint32_t i = 0; i < words(); ++i) {
                made[i] = state_[i] + change[i];
            }
            s_.form.packing.decode(made, marking_);
            make_canonical(s_.symmetry, marking_);
            s_.form.packing.encode(marking_, made);
            hashes_[count_] = hash_of<kWords>(made.data(), words_);
            labels_[count_] = t;
            parents_[count_] = id;
            s_.index.prefetch(hashes_[count_]);
            ++count_;
            ++own_.edges;
        }
    }

    const std::uint64_t* of_highest_level(const std::uint64_t* enabled) {
        for (const std::vector<std::uint64_t>& level : s_.levels) {
            std::uint64_t any = 0;
            for (std::uint32_t w = 0; w < set_words_; ++w) {
                fire_[w] = enabled[w] & level[w];
                any |= fire_[w];
            }
            if (any != 0) {
                break;
            }
        }
        return fire_.data();
    }

    void ask(std::uint32_t id) {
        const auto count = [&](std::uint32_t place) { return tokens(place); };
        if (s_.options.find_dead &&
            s_.dead.load(std::memory_order_relaxed) == StateStore::kNoState) {
            std::uint64_t any = 0;
            for (std::uint32_t w = 0; w < set_words_; ++w) {
                any |= sight_.enabled[w] & s_.alive[w];
            }
            if (any == 0 && (s_.options.final == nullptr || !s_.final.holds_by(count))) {
                s_.answer(s_.dead, id);
            }
        }
        for (std::size_t g = 0; g < s_.goals.size(); ++g) {
            if (s_.reached[g].load(std::memory_order_relaxed) == StateStore::kNoState &&
                s_.goals[g].holds_by(count)) {
                s_.answer(s_.reached[g], id);
            }
        }
    }

    // What the fields have to hold.
    void want(const std::uint64_t* enabled, const std::uint64_t* fits) {
        s_.form.packing.decode(state_, marking_);
        wanted_.assign(marking_.size(), 0);
        wanted_fits_ = true;
        for (std::uint32_t t = 0; t < s_.net.transition_count(); ++t) {
            if (((enabled[t / 64] & ~fits[t / 64]) >> (t & 63) & 1) == 0) {
                continue;
            }
            Marking next = marking_;
            wanted_fits_ = s_.net.fire(next, t) && wanted_fits_;
            for (std::uint32_t p = 0; p < next.size(); ++p) {
                wanted_[p] = std::max(wanted_[p], next[p]);
            }
        }
    }

    // Looks the batch up and inserts what is new.
    void resolve() {
        const std::uint32_t id_mask = s_.index.id_mask();
        for (std::uint32_t i = 0; i < count_; ++i) {
            if (i + kAhead < count_) {
                const std::uint64_t hash = hashes_[i + kAhead];
                const std::uint32_t entry =
                    s_.index.slot(s_.index.home(hash)).load(std::memory_order_acquire);
                if (entry != 0 && (entry & ~id_mask) == s_.index.tag(hash)) {
                    store_->prefetch((entry & id_mask) - 1);
                }
            }
            insert(i, id_mask);
        }
        count_ = 0;
    }

    void insert(std::uint32_t i, std::uint32_t id_mask) {
        const std::uint64_t hash = hashes_[i];
        const std::uint64_t* const state = batch_.data() + std::uint64_t{i} * words();
        const std::uint32_t tag = s_.index.tag(hash);
        bool written = false;
        for (std::uint32_t at = s_.index.home(hash);; at = s_.index.next(at)) {
            std::uint32_t entry = s_.index.slot(at).load(std::memory_order_acquire);
            if (entry == 0) {
                if (!written) {
                    if (own_.next == own_.end) {
                        next_segment();
                    }
                    store_->template write<kWords>(own_.next, state);
                    if (store_->has_parents()) {
                        store_->parent(own_.next) = parents_[i];
                    }
                    written = true;
                }
                const std::uint32_t mine = tag | (own_.next + 1);
                if constexpr (kShared) {
                    if (s_.index.slot(at).compare_exchange_strong(entry, mine,
                                                                  std::memory_order_acq_rel)) {
                        break;
                    }
                } else {
                    s_.index.slot(at).store(mine, std::memory_order_relaxed);
                    break;
                }
            }
            if ((entry & ~id_mask) == tag &&
                store_->template equal<kWords>((entry & id_mask) - 1, state)) {
                return;
            }
        }
        if (depth_first_) {
            own_.stack.push_back(own_.next);
        }
        ++own_.next;
        ++own_.states;
    }

    std::uint32_t find(std::uint32_t i) const {
        const std::uint64_t* const state = batch_.data() + std::uint64_t{i} * words();
        const std::uint32_t tag = s_.index.tag(hashes_[i]), id_mask = s_.index.id_mask();
        for (std::uint32_t at = s_.index.home(hashes_[i]);; at = s_.index.next(at)) {
            const std::uint32_t entry = s_.index.slot(at).load(std::memory_order_relaxed);
            if (entry == 0) {
                return StateStore::kNoState;
            }
            if ((entry & ~id_mask) == tag &&
                store_->template equal<kWords>((entry & id_mask) - 1, state)) {
                return (entry & id_mask) - 1;
            }
        }
    }

    // Needs  a spare segment: reserve() has seen to it.
    void next_segment() {
        if constexpr (kShared) {
            const std::lock_guard<std::mutex> lock(s_.mutex);
            note_fill();
            give_away();
        } else {
            note_fill();
        }
        own_.next = own_.spare.back();
        own_.end = own_.next + StateStore::kSegment;
        if constexpr (kShared) {
            own_.head = own_.next;
        }
        own_.spare.pop_back();
    }

    // The rest of the own segment to whoever has nothing to do. Under the mutex.
    void give_away() {
        if (own_.head < own_.next) {
            s_.waiting.push_back({own_.head, own_.next});
            own_.head = own_.next;
            s_.awake.notify_one();
        }
    }

    bool get_work(Range& range);
    void rendezvous();
    void want_wider();

    Search& s_;
    Own& own_;
    const Scanner* scanner_ = nullptr;
    StateStore* store_ = nullptr;
    const std::uint64_t* changes_ = nullptr;
    Scanner::Sight sight_;
    Stubborn::Scratch scratch_;
    std::uint32_t words_ = 1, set_words_ = 1, capacity_ = 0, count_ = 0;
    std::uint32_t batches_ = 0;
    bool depth_first_ = false;
    bool other_form_ = false;  // after a rendezvous: the packing is for another worker
    std::vector<std::uint64_t> state_, batch_, hashes_, fire_;
    std::vector<std::uint32_t> labels_, parents_;
    Marking marking_, wanted_;
    bool wanted_fits_ = true;
};

}  // namespace puppetri::proof
