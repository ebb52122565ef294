// SPDX-License-Identifier: MIT
// What the workers of one exploration share, and what stops them: the packed form of the net, the
// states found, the questions, the rendezvous at which the table grows and fields are widened.
#pragma once
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "few_semiflows.h"
#include "packing.h"
#include "puppetri/proof/explorer.h"
#include "scanner.h"
#include "state_store.h"

namespace puppetri::proof {

class Stubborn;

// States that wait to be expanded: numbers from..to, all of one segment.
struct Range {
    std::uint32_t from = 0, to = 0;
};

// A place for the next states, and what is left of the work: of one worker.
struct Own {
    std::uint32_t next = 0, end = 0;   // numbers left in the segment being filled
    std::vector<std::uint32_t> spare;  // segments to fill after it, last one first
    std::uint32_t head = 0;            // the first state that is not expanded yet
    std::vector<std::uint32_t> stack;  // depth first: the states that are not expanded yet
    std::uint64_t states = 0, edges = 0, most_tokens = 0;
    std::uint64_t told_states = 0, told_edges = 0;  // to the meter
    Marking bounds;
};

class Search {
 public:
    Search(const PlainNet& net, const ExploreOptions& options, const Budget& budget);
    ~Search();

    const PlainNet& net;
    const ExploreOptions& options;
    const Budget& budget;
    Meter meter;

    // The packed form; replaced when a field has become too small.
    struct Form {
        Packing packing;
        std::vector<std::uint64_t> changes;  // rows of packing.words, per transition
        std::unique_ptr<Scanner> scanner;
        std::unique_ptr<StateStore> store;
    };
    Form form;
    StateIndex index;
    std::vector<std::uint32_t> fill;  // per segment: states in it (of the current ones: at rests)

    // Sets of transitions.
    std::vector<std::uint64_t> alive;                // those that are not optional
    std::vector<std::vector<std::uint64_t>> levels;  // of each level, from the highest; or none
    std::vector<CompiledPredicate> goals;
    CompiledPredicate final;
    // Instances that are not told apart; none unless all invariants of the packing are symmetric:
    // the initial marking is, and no field grows.
    Symmetry symmetry;

    // What has been found: the state, or kNoState.
    std::atomic<std::uint32_t> dead{StateStore::kNoState};
    std::vector<std::atomic<std::uint32_t>> reached;
    std::atomic<std::uint32_t> open_questions{0};
    void answer(std::atomic<std::uint32_t>& question, std::uint32_t state);

    // Why everybody is to stop; also because everything was found: then ended stays kDone.
    std::atomic<Ended> ended{Ended::kDone};
    std::atomic<bool> stop{false};
    void end(Ended why);
    bool counts_states = true;    // against the budget
    bool ended_by_count = false;  // so many states were allowed, and the table is whole
    // Looks at the budget, every few batches of a worker.
    void look(std::uint64_t more_states, std::uint64_t more_edges);
    std::uint64_t bytes() const;
    std::atomic<std::uint64_t> most_bytes{0};

    // A new segment, and room for it in the table. Several threads: under `mutex`.
    // Gives  false if the table has to grow first.
    bool new_segment(std::uint32_t& first);
    // Both leave the index empty: everything is to be inserted again. (`unclear`: its slices are to
    // be cleared before.)
    void grow_index(bool unclear = false);
    // Gives  false if a count does not fit into 32 bits, or there is no memory.
    bool widen(std::span<const std::uint32_t> marking);
    template <unsigned kWords, bool kShared>
    void insert_segment(std::uint32_t segment);

    Own own;                                   // of the first worker
    std::unique_ptr<const Stubborn> stubborn;  // or none

    // What several threads need: all under `mutex`, but the atomic ones.
    std::mutex mutex;
    std::condition_variable awake;  // there is work, or an end, or a rendezvous
    std::condition_variable gate;   // the rendezvous
    std::deque<Range> waiting;
    std::uint32_t workers = 1, idle = 0;
    std::atomic<std::uint32_t> hungry{0};
    bool finished = false;
    std::atomic<bool> pause{false};
    std::uint32_t arrived = 0;
    std::uint64_t generation = 0;
    bool widening = false;
    Marking wider;  // to be widened for these
    std::atomic<std::uint32_t> next_segment{0}, next_slice{0};

 private:
    bool make_form(Form& made);
    void note_bytes(std::uint64_t besides = 0);

    std::vector<Semiflow> semiflows_;
    Marking guess_;
    std::mutex meter_mutex_;
    std::atomic<std::uint64_t> states_{0}, edges_{0}, bytes_now_{0};
};

template <unsigned kWords, bool kShared>
void Search::insert_segment(std::uint32_t segment) {
    constexpr std::uint32_t kAhead = 16;
    const std::uint32_t words = form.packing.words, first = segment << StateStore::kSegmentBits;
    std::vector<std::uint64_t> state(words);
    std::uint64_t hashes[kAhead];
    for (std::uint32_t i = 0; i < fill[segment]; i += kAhead) {
        const std::uint32_t count = std::min(kAhead, fill[segment] - i);
        for (std::uint32_t j = 0; j < count; ++j) {
            form.store->load<kWords>(first + i + j, state.data());
            hashes[j] = hash_of<kWords>(state.data(), words);
            index.prefetch(hashes[j]);
        }
        for (std::uint32_t j = 0; j < count; ++j) {
            index.add<kShared>(hashes[j], first + i + j);
        }
    }
}

}  // namespace puppetri::proof
