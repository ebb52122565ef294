// SPDX-License-Identifier: MIT
// The inner tables of a compiled net: what the engine walks. Plain transitions (all arcs on places
// without records, no guard, delay, event, data) need only `takes`, `gives` and the watchers; all
// else is in `Special`, one per transition that has any of it.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "puppetri/base/expr.h"
#include "puppetri/net/net.h"

namespace puppetri::net {

inline constexpr std::uint32_t kNoIndex = ~std::uint32_t{0};

struct DurationTable {
    DurationKind kind = DurationKind::kConstant;
    DistributionKind distribution = DistributionKind::kConstant;
    std::int64_t ticks = 0;  // of kConstant
    ProgramIndex a, b;       // of kExpression, kInterval
    struct Parameter {
        ProgramIndex program;
        ValueKind kind = ValueKind::kReal;
    };
    std::vector<Parameter> parameters;
    std::vector<double> constants;  // the parameters (seconds), if none of them can change
    std::uint32_t sibling = kNoIndex;
    std::uint32_t stream = kNoIndex;  // number of its random stream; kNoIndex: nothing to draw
    std::uint32_t fifo = kNoIndex;    // of kConstant > 0: queue of all tokens that last as long
};

struct RichPlaceTable {
    std::uint32_t place = 0;
    std::uint32_t attributes = 0;
    Discipline discipline = Discipline::kOldest;
    bool by_arrival = false;
    bool key_is_real = false;
    bool keeps_order = false;
    ProgramIndex key;
    ActionIndex action;
    std::uint32_t token_stream = kNoIndex;  // of `any`
};

// A test or taking on tokens with records, or an `all` on a place without.
struct PatternTable {
    std::uint32_t attribute = 0;
    std::uint32_t binds = kNoIndex;
    ProgramIndex equals;
};
struct ArcTable {
    ArcKind kind = ArcKind::kTake;
    std::uint32_t place = 0;
    std::uint32_t rich = kNoIndex;
    std::uint32_t weight = 1;
    std::uint32_t time_left = kNoIndex;
    std::vector<PatternTable> pattern;
};
struct OutputTable {
    std::uint32_t place = 0;
    std::uint32_t rich = kNoIndex;
    std::uint32_t weight = 1;
    std::vector<ProgramIndex> attributes;
    ProgramIndex lasts;
};
struct DelayTable {
    std::uint32_t transition = 0;
    DurationTable duration;
    DelayMemory memory = DelayMemory::kEnabling;
    std::uint32_t servers = 1;
};
struct Special {
    std::uint32_t transition = 0;
    bool searches = false;  // patterns or time left: marked only if a binding is found
    bool depends = false;  // marked by more than counts: looked at again when what it reads changes
    std::vector<ArcTable> arcs;  // on rich places, and `all`; in source order, `all` last
    std::vector<OutputTable>
        outputs;  // on rich places, or with a duration of their own; siblings first
    std::uint32_t variables = 0;
    ProgramIndex guard;
    ProgramIndex odds;  // invalid: constant
    bool odds_is_int = false;
    double constant_odds = 1;
    std::vector<std::uint32_t> events;
    bool next_event = false;  // see TransitionDraft
    std::vector<std::uint32_t> raises;
    std::uint32_t delay = kNoIndex;
    std::vector<std::pair<std::uint32_t, ProgramIndex>> assignments;
    std::vector<std::uint32_t> must_be_clean;  // refinements
    // Of multi-server delays: how often enabled, by the ready tokens and (`now`) by all of a place.
    std::vector<Weighted> degree, degree_now;
};

// Paths, captions and positions of many elements in few allocations.
class Names {
 public:
    void reserve(std::uint32_t count) { entries_.reserve(count); }
    void add(std::string_view path, std::string_view caption, const SourceSpan& where);
    // Sorts by path; to be called once, after the last add. Other names (of fused places) may be
    // added for `find`.
    void sort(std::vector<std::pair<std::string, std::uint32_t>> aliases = {});

    std::uint32_t size() const { return static_cast<std::uint32_t>(entries_.size()); }
    ElementView operator[](std::uint32_t i) const;
    std::string_view path(std::uint32_t i) const;
    std::uint32_t find(std::string_view path) const;  // kNoIndex: none
    // The place in the order of paths.
    std::uint32_t rank(std::uint32_t i) const { return ranks_[i]; }
    bool operator==(const Names&) const = default;

 private:
    struct Entry {
        std::uint32_t path = 0, caption = 0, end = 0;  // offsets in text_
        std::uint32_t file = 0, line = 0, column = 0, length = 1;
        bool operator==(const Entry&) const = default;
    };
    std::string text_;
    std::vector<std::string> files_;
    std::vector<Entry> entries_;
    std::vector<std::uint32_t> order_, ranks_;
    std::vector<std::pair<std::string, std::uint32_t>> aliases_;
};

enum TransitionFlag : std::uint8_t {
    kFiresSpecially = 1,  // more than counts happens when it fires
    kGated = 2,           // satisfied arcs are not enough: guard, binding, delay or event
    kHasOdds = 4,         // odds other than 1
    // Gated by a delay with one server and enabling memory, and nothing else is special
    kOnlyDelayed = 8,
};

// The arcs of a transition; the row after it says where they end.
struct TransitionRow {
    std::uint32_t takes = 0;  // where its arcs from places without records begin in `arcs`,
    std::uint32_t gives = 0;  // and those to places without records and with the place's duration
    std::uint32_t special = kNoIndex;
    std::uint16_t level = 0;  // 0: the highest priority
    std::uint8_t flags = 0;
};

// What a change of a place reads; the row after it says where its watchers end.
struct PlaceRow {
    // Where its watchers of the number of ready tokens begin in `watchers`,
    std::uint32_t ready = 0;
    // and those of the number of tokens (never of kCount: there both are one)
    std::uint32_t total = 0;
    std::uint32_t duration = kNoIndex;  // of kTimed and kRich: number in `durations`; kNoIndex: 0
    Watcher first;                      // a copy of watchers[ready], if there is one
    PlaceKind kind = PlaceKind::kCount;
    bool has_dependents = false;
};

struct NetTables {
    Names places, transitions, data, events;
    std::vector<std::uint32_t> place_map, transition_map;  // from the draft

    // Places.
    std::vector<PlaceRow> place;  // and one more
    std::vector<Watcher> watchers;
    std::vector<std::uint32_t> place_rich;  // empty, or per place the number in `rich`
    Rows<std::uint32_t> place_dependents;   // transitions to look at again when the place changes
    Rows<std::uint32_t> datum_dependents;
    std::vector<DurationTable> durations;
    std::vector<RichPlaceTable> rich;
    std::vector<std::int64_t> fifo_ticks;  // the constant durations that many tokens share
    std::uint32_t duration_streams = 0, token_streams = 0;
    std::vector<std::uint32_t> stream_place;  // duration stream -> place
    std::vector<std::uint32_t> token_stream_place;

    // Transitions.
    std::vector<TransitionRow> transition;  // and one more
    std::vector<Weighted> arcs;
    std::vector<Special> specials;
    std::vector<DelayTable> delays;
    std::vector<std::int64_t> level_priority;  // descending
    std::vector<std::uint8_t>
        level_has_odds;  // some transition of the priority has odds other than 1
    std::vector<std::uint32_t> unconditional;  // transitions without any condition on counts

    std::span<const Weighted> takes(std::uint32_t t) const {
        return {arcs.data() + transition[t].takes, arcs.data() + transition[t].gives};
    }
    std::span<const Weighted> gives(std::uint32_t t) const {
        return {arcs.data() + transition[t].gives, arcs.data() + transition[t + 1].takes};
    }
    std::span<const Watcher> ready_watchers(std::uint32_t p) const {
        return {watchers.data() + place[p].ready, watchers.data() + place[p].total};
    }
    std::span<const Watcher> total_watchers(std::uint32_t p) const {
        return {watchers.data() + place[p].total, watchers.data() + place[p + 1].ready};
    }

    Rows<std::uint32_t> event_listeners;
    Code code;
    // Everything but places and transitions: data, events, schedule, rules, finals, host atoms.
    NetDraft declarations;
    std::vector<RefinementDraft> refinements;
    struct Initial {
        std::uint32_t place = 0, count = 0;
        bool ready = false;
        std::vector<Value> attributes;
    };
    std::vector<Initial> initial;  // siblings before those that last as long
    struct FinalMarking {
        Formula condition;
        std::vector<ProgramIndex> programs;  // of its expressions
    };
    std::vector<FinalMarking> finals;
    // Of declarations.measures, in a code of their own: measuring changes no net.
    struct MeasurePrograms {
        ProgramIndex value;
        std::vector<ProgramIndex> from, to;
    };
    std::vector<MeasurePrograms> measures;
    Code measure_code;
    Diagnostics notes;
    std::uint64_t hash = 0;
    bool paced = false;
};

}  // namespace puppetri::net
