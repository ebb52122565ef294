// SPDX-License-Identifier: MIT
// The compiled net: immutable, flat, shared by simulator and prover. Places and transitions keep
// the indices that they have in the draft as far as nothing was fused, lowered or merged;
// `place_of_draft` says where each went. What a firing touches lies in rows (CSR) of 8-byte
// entries; names, captions and source positions lie apart.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "puppetri/base/diagnostic.h"
#include "puppetri/base/expr.h"
#include "puppetri/net/draft.h"

namespace puppetri::net {

// Rows of one flat array: row i is items[starts[i] .. starts[i + 1]).
template <class T>
struct Rows {
    std::vector<std::uint32_t> starts = {0};
    std::vector<T> items;

    std::span<const T> row(std::uint32_t i) const {
        return {items.data() + starts[i], items.data() + starts[i + 1]};
    }
    std::uint32_t size() const { return static_cast<std::uint32_t>(starts.size()) - 1; }
    bool operator==(const Rows&) const = default;
};

// `weight` tokens of a place.
struct Weighted {
    std::uint32_t place = 0;
    std::uint32_t weight = 1;
    bool operator==(const Weighted&) const = default;
};

// A transition that waits for a count: at least `threshold`, or (inhibits) fewer.
struct Watcher {
    // The transition; the uppermost bits: inhibits, and (of the transition) gated
    std::uint32_t word = 0;
    std::uint32_t threshold = 1;
    static constexpr std::uint32_t kInhibits = 1u << 31, kGated = 1u << 30;
    std::uint32_t transition() const { return word & (kGated - 1); }
    bool inhibits() const { return (word & kInhibits) != 0; }
    bool gated() const { return (word & kGated) != 0; }
    bool operator==(const Watcher&) const = default;
};

// How a place keeps its tokens.
enum class PlaceKind : std::uint8_t {
    kCount,  // all ready at once: one number
    kTimed,  // a number of tokens, a number of ready ones, and the ready times in the queue
    kRich,   // records with serial, arrival, ready time, attributes, activity
};

// Names, captions, source positions: looked at by people only. The texts live as long as the net.
struct ElementView {
    std::string_view path;
    std::string_view caption;
    SourceSpan where;
};

struct NetTables;  // the inner tables of the engine, net/tables.h

class Net {
 public:
    Net();
    ~Net();
    Net(const Net&);
    Net(Net&&) noexcept;
    Net& operator=(const Net&);
    Net& operator=(Net&&) noexcept;

    std::uint32_t place_count() const;
    std::uint32_t transition_count() const;
    std::uint32_t datum_count() const;
    std::uint32_t event_count() const;

    ElementView place(PlaceIndex p) const;
    ElementView transition(TransitionIndex t) const;
    ElementView datum(DatumIndex d) const;
    ElementView event(EventIndex e) const;

    // By full path, also the old names of fused places. Invalid when there is none.
    PlaceIndex find_place(std::string_view path) const;
    TransitionIndex find_transition(std::string_view path) const;
    DatumIndex find_datum(std::string_view path) const;
    EventIndex find_event(std::string_view path) const;

    // Where a place or transition of the draft went (of a lowered `for d`: t.begin; of a channel's
    // end: the first of its products, invalid where it has none).
    PlaceIndex place_of_draft(PlaceIndex p) const;
    TransitionIndex transition_of_draft(TransitionIndex t) const;

    ActionIndex action(PlaceIndex p) const;  // invalid: none
    // No duration, delay, holding or schedule anywhere: one firing per beat.
    bool paced() const;
    // Data, events, schedule, rules, states, final markings, host atoms: the lowered draft without
    // its places and transitions; indices in it are those of the net.
    const NetDraft& declarations() const;
    // Of the whole net, names and all: equal nets have equal hashes.
    std::uint64_t hash() const;
    // What a run touches per place and per arc, without names, captions and source positions.
    std::size_t hot_bytes() const;
    // Rounding to ticks and the like: not an error.
    const Diagnostics& notes() const;

    const NetTables& tables() const {
        return *tables_;
    }  // net/tables.h: for the engine and provers

 private:
    friend Checked<Net> compile(const NetDraft& draft);
    std::unique_ptr<NetTables> tables_;
};

// Makes plain transitions of what meets: of rendezvous and channels. Rules that speak of a firing
// of a channel's end speak of any of its products afterwards. lower() and compile() begin with
// this; whoever takes drafts apart does it before. Fails  (into `defects`) by code:
// rendezvous-disagree two-channel-ends holding-on-channel
//        two-senders two-receivers channel-within unmatched-channel-end type-mismatch rule-of-many;
//        warns of rendezvous-never.
// Cost   O(size + sends * receives of each channel).
void meet(NetDraft& draft, Diagnostics& defects);

// Rewrites `for d`, refinements, fusions, rendezvous and channels into plain places, transitions
// and arcs. Fails  with all defects of these.
Checked<NetDraft> lower(const NetDraft& draft);

// Lowers, checks everything, lays out.
// Fails  with all defects, by code: unknown-index duplicate-name net-too-large weight-not-positive
//        odds-not-positive source-without-delay two-writers as-without-sibling fused-disagree
//        rendezvous-disagree and others of meet() type-mismatch variable-unbound
//        pattern-on-attribute sensor-assigned range-empty initial-out-of-range negative-duration
//        empty-interval wrong-distribution auto-without-movement capacity-exceeded refined-not-open
//        key-missing expression-too-deep
// Gives  notes() with code rounded-to-tick.
// Cost   O(size).
Checked<Net> compile(const NetDraft& draft);

}  // namespace puppetri::net
