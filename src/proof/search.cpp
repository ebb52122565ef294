// SPDX-License-Identifier: MIT
// The shared part of an exploration.
#include "search.h"

#include <algorithm>

#include "stubborn.h"

namespace puppetri::proof {

namespace {

constexpr std::uint32_t kFirstGuess = 15;  // at most; fields grow when they have to

using Set = std::vector<std::uint64_t>;

Set set_of(const PlainNet& net, auto&& member) {
    Set set(std::max(1u, (net.transition_count() + 63) / 64), 0);
    for (std::uint32_t t = 0; t < net.transition_count(); ++t) {
        if (member(t)) {
            set[t / 64] |= std::uint64_t{1} << (t & 63);
        }
    }
    return set;
}

}  // namespace

Search::Search(const PlainNet& n, const ExploreOptions& o, const Budget& b)
    : net(n), options(o), budget(b), meter(b, "explicit"), reached(o.goals.size()) {
    semiflows_ = few_semiflows(net);
    // Where nothing is known: tokens move, so what is in one place may come to another.
    std::uint32_t guess = 1;
    for (const std::uint32_t count : net.initial) {
        guess = std::max(guess, std::min(count, kFirstGuess));
    }
    guess_.assign(net.place_count(), guess);
    alive = set_of(net, [&](std::uint32_t t) { return net.optional.empty() || !net.optional[t]; });
    if (net.has_levels) {
        Marking values(net.level.begin(), net.level.end());
        std::sort(values.rbegin(), values.rend());
        values.erase(std::unique(values.begin(), values.end()), values.end());
        for (const std::uint32_t level : values) {
            levels.push_back(set_of(net, [&](std::uint32_t t) { return net.level[t] == level; }));
        }
    }
    for (const Predicate& goal : options.goals) {
        goals.emplace_back(net, goal);
    }
    if (options.final != nullptr) {
        final = CompiledPredicate(net, *options.final);
    }
    for (auto& r : reached) {
        r = StateStore::kNoState;
    }
    open_questions = static_cast<std::uint32_t>(goals.size()) + (options.find_dead ? 1 : 0);
    if (!make_form(form) || index.entries() == 0) {
        end(Ended::kMemory);
        return;
    }
    if (options.symmetry != nullptr && !form.packing.grows) {
        symmetry = keeping(*options.symmetry, net.initial);
    }
    std::vector<std::uint64_t> state(form.packing.words);
    form.packing.encode(net.initial, state);
    std::uint32_t first = 0;
    if (!new_segment(first)) {
        end(Ended::kMemory);
        return;
    }
    own.next = first;
    own.end = first + StateStore::kSegment;
    form.store->write<0>(own.next, state.data());
    if (options.witnesses) {
        form.store->parent(own.next) = StateStore::kNoState;
    }
    index.add<false>(hash_of<0>(state.data(), form.packing.words), own.next);
    own.stack = {own.next};
    ++own.next;
    own.states = 1;
}

Search::~Search() = default;

bool Search::make_form(Form& made) {
    made.packing = make_packing(net, semiflows_, guess_);
    made.changes.clear();
    for (std::uint32_t t = 0; t < net.transition_count(); ++t) {
        const Set change = made.packing.change(net, t);
        made.changes.insert(made.changes.end(), change.begin(), change.end());
    }
    made.scanner = std::make_unique<Scanner>(net, made.packing);
    made.store =
        std::make_unique<StateStore>(made.packing.bytes, made.packing.words, options.witnesses);
    return true;
}

void Search::answer(std::atomic<std::uint32_t>& question, std::uint32_t state) {
    std::uint32_t open = StateStore::kNoState;
    if (question.compare_exchange_strong(open, state) && --open_questions == 0 &&
        options.stop_when_found) {
        stop = true;
    }
}

void Search::end(Ended why) {
    Ended none = Ended::kDone;
    ended.compare_exchange_strong(none, why);
    stop = true;
}

std::uint64_t Search::bytes() const {
    return form.store->bytes() + index.bytes() + form.scanner->bytes();
}

void Search::note_bytes(std::uint64_t besides) {
    const std::uint64_t now = bytes() + besides;
    bytes_now_ = now;
    most_bytes = std::max(most_bytes.load(), now);
}

void Search::look(std::uint64_t more_states, std::uint64_t more_edges) {
    const std::uint64_t states = states_ += more_states, edges = edges_ += more_edges;
    const std::unique_lock<std::mutex> lock(meter_mutex_, std::try_to_lock);
    if (!lock.owns_lock()) {
        return;
    }
    const Ended why = meter.look(counts_states ? states : 0, edges, 0,
                                 bytes_now_.load(std::memory_order_relaxed));
    if (why != Ended::kDone) {
        ended_by_count = why == Ended::kStates;
        end(why);
    }
}

bool Search::new_segment(std::uint32_t& first) {
    const std::uint64_t states = (std::uint64_t{form.store->segments()} + 1)
                                 << StateStore::kSegmentBits;
    if (states > index.limit()) {
        return false;
    }
    first = form.store->add_segment();
    if (first == StateStore::kNoState) {
        end(Ended::kMemory);
        first = 0;
        return true;
    }
    fill.push_back(0);
    note_bytes();
    return true;
}

void Search::grow_index(bool unclear) {
    const std::uint64_t states = (std::uint64_t{form.store->segments()} + workers)
                                 << StateStore::kSegmentBits;
    const std::uint32_t entries = StateIndex::entries_for(
        index.entries(), std::max(states, index.limit() + std::uint64_t{1}));
    // What the larger table would hold beyond the budget is not tried.
    if (form.store->bytes() + std::uint64_t{entries} * 4 > budget.bytes ||
        !(unclear ? index.make_unclear(entries) : index.make(entries))) {
        end(Ended::kMemory);
    }
    if (index.limit() < states) {
        end(Ended::kStates);
    }
    note_bytes();
}

bool Search::widen(std::span<const std::uint32_t> marking) {
    for (std::uint32_t p = 0; p < guess_.size(); ++p) {
        const std::uint64_t room = form.packing.room[p];
        if (room != kUnknownBound) {
            // What has become too small gets at least one bit more; the others keep theirs.
            guess_[p] = std::max(static_cast<std::uint32_t>(room), marking[p]);
        }
    }
    Form made;
    if (!make_form(made)) {
        return false;
    }
    // Both forms are there for a while.
    const std::uint64_t moved =
        (std::uint64_t{fill.size()} << StateStore::kSegmentBits) * made.packing.bytes;
    if (bytes() + moved > budget.bytes) {
        return false;
    }
    std::vector<std::uint64_t> from(form.packing.words), to(made.packing.words);
    Marking m(net.place_count());
    for (std::uint32_t segment = 0; segment < fill.size(); ++segment) {
        const std::uint32_t first = made.store->add_segment();
        if (first == StateStore::kNoState) {
            return false;
        }
        for (std::uint32_t id = first; id < first + fill[segment]; ++id) {
            form.store->load<0>(id, from.data());
            form.packing.decode(from, m);
            made.packing.encode(m, to);
            made.store->write<0>(id, to.data());
            if (options.witnesses) {
                made.store->parent(id) = form.store->parent(id);
            }
        }
        note_bytes(made.store->bytes());
        form.store->drop_before(first);
    }
    form = std::move(made);
    return index.make(index.entries());
}

}  // namespace puppetri::proof
