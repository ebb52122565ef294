// SPDX-License-Identifier: MIT
// The draft of a net: what notations build and `compile` (net/net.h) turns into an immutable Net.
// Plain data, indices into its own vectors, full paths as names ("a.with_ball.P4"); the order of
// declarations decides nothing but the order of lists. Nothing is checked here: `compile` reports
// all defects at once.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "puppetri/base/diagnostic.h"
#include "puppetri/base/distribution.h"
#include "puppetri/base/expr.h"
#include "puppetri/base/index.h"
#include "puppetri/base/time.h"
#include "puppetri/net/formula.h"
#include "puppetri/net/host.h"
#include "puppetri/net/indices.h"
#include "puppetri/net/measure.h"

namespace puppetri::net {

struct EnumDraft {
    std::string name;
    std::vector<std::string> values;
};

struct AttributeDraft {
    std::string name;
    ValueType type;
};

// How long: of a token in its place, or of a transition's delay.
enum class DurationKind : std::uint8_t {
    kConstant,      // a
    kExpression,    // a
    kInterval,      // a .. b, drawn uniformly
    kDistribution,  // distribution(parameters)
    kAuto,          // places with an action: the host says, rounded up to a whole millisecond
    kAs,            // the value that the sibling token of the same firing got in `sibling`
    kOpen,          // ready when its owner says so
};

struct DurationDraft {
    DurationKind kind = DurationKind::kConstant;
    Expr a = Expr::time(
        {0});  // type time; may read data, counts, bound variables (delays), attributes (places)
    Expr b = Expr::time({0});
    DistributionKind distribution = DistributionKind::kExponential;
    std::vector<Expr> parameters;  // times (as seconds) or numbers, as base/distribution.h says
    PlaceIndex sibling;
    SourceSpan where;

    static DurationDraft constant(SimTime t) {
        DurationDraft d;
        d.a = Expr::time(t);
        return d;
    }
};

enum class Discipline : std::uint8_t { kOldest, kNewest, kLeast, kMost, kAny };

struct InitialToken {
    std::uint32_t count = 1;
    bool ready = false;             // `tokens 1 ready`: ready at 0 whatever the duration
    std::vector<Value> attributes;  // in the order of the place's declaration
};

struct PlaceDraft {
    std::string path;
    std::string caption;
    SourceSpan where;
    std::vector<AttributeDraft> attributes;
    // Left out: `auto` with an action, `open` if refined, else 0.
    std::optional<DurationDraft> duration;
    Discipline discipline = Discipline::kOldest;
    // `first`, `last`, and `least EXPR first`: the order of arrival decides, whatever tokens last.
    bool by_arrival = false;
    Expr key;                  // of least, most: a number or a time over the token's attributes
    bool keeps_order = false;  // never ready before its predecessor
    std::optional<std::uint32_t> capacity;  // `holds at most k`: tokens, ready or not
    std::vector<InitialToken> tokens;
    ActionIndex action;  // the movement that a token performs here
    bool busy = false;   // made by `for d`
};

enum class ArcKind : std::uint8_t {
    kTake,         // k*P: k ready tokens
    kTakeNow,      // now P: ready or not
    kTakeAll,      // all P: however many ready ones there are, also none
    kTakeAllNow,   // all now P: every token
    kRead,         // with k*P: ready tokens
    kReadNow,      // while k*P: ready or not
    kUnless,       // unless k*P: fewer than k tokens
    kUnlessReady,  // unless ready k*P
};

// One attribute of a pattern: binds a variable or must equal a value.
struct PatternDraft {
    std::uint32_t attribute = 0;
    std::optional<std::uint32_t>
        binds;    // variable of the transition; a variable bound before must be equal
    Expr equals;  // if nothing is bound: over data and variables bound by earlier arcs
};

struct ArcDraft {
    ArcKind kind = ArcKind::kTake;
    PlaceIndex place;
    std::int64_t weight = 1;
    std::vector<PatternDraft> pattern;
    std::optional<std::uint32_t>
        time_left;  // variable of type time: what was left of the (first) token's duration
    SourceSpan where;
};

struct OutputDraft {
    PlaceIndex place;
    std::int64_t weight = 1;
    std::vector<Expr> attributes;  // one for each attribute of the place; over bound variables,
                                   // data, counts (before)
    std::optional<Expr> lasts;  // `for left`: a duration of this arc's own, instead of the place's
    SourceSpan where;
};

struct VariableDraft {
    std::string name;
    ValueType type;
};

enum class DelayMemory : std::uint8_t { kEnabling, kAge, kResample };

struct DelayDraft {
    DurationDraft duration;
    DelayMemory memory = DelayMemory::kEnabling;
    // Of kInfiniteServers: as many clocks as the transition is enabled times
    std::uint32_t servers = 1;
    static constexpr std::uint32_t kInfiniteServers = ~std::uint32_t{0};
};

struct AssignmentDraft {
    DatumIndex datum;
    Expr value;  // over the state before the firing
    SourceSpan where;
};

struct TransitionDraft {
    std::string path;
    std::string caption;
    SourceSpan where;
    std::vector<VariableDraft> variables;  // bound by patterns and `time left`
    std::vector<ArcDraft> inputs;          // in source order
    std::vector<OutputDraft> outputs;
    std::optional<Expr> guard;  // bool
    std::int64_t priority = 1;
    std::optional<Expr> odds;        // a number above 0; default 1
    std::vector<EventIndex> events;  // fires only while one of these is offered
    bool next_event = false;  // only with an occurrence that comes while it is marked, and as long
                              // as it stays so: not with the one that made it so
    std::vector<EventIndex> raises;  // occurrences that a firing makes
    std::optional<DelayDraft> delay;
    std::optional<DurationDraft>
        holding;  // `for d`: lowered to t.begin -> t.busy -> t.end by lower()
    // With a holding time: an empty place t.busy and an empty transition t.end of the draft that
    // lower() fills, for those who speak of them; invalid: it makes its own.
    PlaceIndex busy;
    TransitionIndex end;
    std::vector<AssignmentDraft> assignments;
};

struct DatumDraft {
    std::string path;
    std::string caption;
    SourceSpan where;
    ValueType type;
    Value initial = 0;
    std::optional<Value> low, high;  // of int, real and time; leaving the range stops the run
    bool sensor = false;  // set by events of the outside or of a movement only, never assigned
};

struct EventDraft {
    std::string path;
    std::string caption;
    SourceSpan where;
    bool consumed = false;  // used up by the first transition
    bool outside = true;    // may come from outside
    // A crossing of equations or of figures: time passes in a net that has some, and provers let
    // it occur whenever they like.
    bool crossing = false;
    // Before it is offered: sets a sensor (a crossing), or makes the oldest unready token of an
    // open place ready.
    DatumIndex sets;
    bool sets_to = false;
    PlaceIndex makes_ready;
};

struct ScheduledEvent {
    SimTime at;
    EventIndex event;
    std::optional<SimTime> every;  // repeated for ever
    SourceSpan where;
};

// Markings that are an end and no deadlock: those in which the condition of one of the list holds.
struct FinalMarkingDraft {
    Formula condition;
    SourceSpan where;
};

// A place that runs a module: its token is the shadow of the module's activity.
struct RefinementDraft {
    PlaceIndex place;
    std::vector<PlaceIndex> start;   // each gets a token with the way in, or with an initial token
    std::vector<PlaceIndex> finish;  // the way out takes one token of each
    std::vector<PlaceIndex>
        inside;  // all places of the module, start, finish and nested ones included
    SourceSpan where;
};

// One end of a channel: a transition that sends on it, or receives from it.
struct ChannelEnd {
    TransitionIndex transition;
    std::uint32_t owner = 0;  // the machine: a send and a receive of one owner never meet
    // Of a send: what is sent, over the state before the firing. Of a receive: what the message
    // must be; left out, it takes any.
    std::optional<Expr> message;
    DatumIndex into;  // of a receive: gets the message
    SourceSpan where;
};

// Every send and every receive of different owners whose messages agree are one transition, named
// "a.send|b.receive", joined as in a rendezvous, and a transition takes part in as
// many as there are partners. The ends themselves are no transitions of the net.
struct ChannelDraft {
    std::string path;
    std::string caption;
    SourceSpan where;
    std::vector<ChannelEnd> sends, receives;
    bool shared = false;  // several owners may send, or receive; else it is one-to-one
};

struct NetDraft {
    std::string name;
    // In a net without time, transitions without any input are allowed: one firing per beat. So
    // nets from elsewhere mean them; scenes do not.
    bool sources_on_beats = false;
    std::vector<EnumDraft> enums;
    std::vector<PlaceDraft> places;
    std::vector<TransitionDraft> transitions;
    std::vector<DatumDraft> data;
    std::vector<EventDraft> events;
    std::vector<ScheduledEvent> schedule;
    std::vector<RefinementDraft> refinements;
    std::vector<std::vector<PlaceIndex>>
        fusions;  // each list becomes its first place; the other names stay known
    std::vector<std::vector<TransitionIndex>>
        rendezvous;  // each list becomes one transition, named "a.t|b.t"
    std::vector<ChannelDraft> channels;
    std::vector<HostAtom> host_atoms;
    std::vector<NamedState> states;
    std::vector<Rule> rules;
    std::vector<TimeQuestion> questions;
    std::vector<MeasureDraft> measures;
    std::vector<FinalMarkingDraft> finals;
};

// What an expression may read in a net.
enum class SlotKind : std::uint32_t {
    kDatum,      // a datum
    kVariable,   // a variable bound by the arcs of the transition
    kCount,      // #P (int)
    kReady,      // #ready P (int)
    kAttribute,  // attribute i of the token in question: keys of disciplines, durations of places
};
inline Slot slot(SlotKind kind, std::uint32_t index) {
    return {static_cast<std::uint32_t>(kind), index};
}

}  // namespace puppetri::net
