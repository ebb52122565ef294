// SPDX-License-Identifier: MIT
// The syntax tree of the scene language (docs/language.md): what a .pup file says, statement by
// statement, with nothing looked up and nothing computed. Plain values; every node carries the
// stretch of text it came from. Statements are kept by kind, each kind in source order (names never
// depend on the order of declarations, docs/semantics.md); what matters in source order (arcs,
// assignments, events at one time) is one list.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "puppetri/base/diagnostic.h"
#include "puppetri/lang/expression.h"

namespace puppetri::lang {

// `"what people read"`; empty when not written.
struct Caption {
    std::string text;
    Span span;
};

// ---------------------------------------------------------------------------------------------------------------------
// Nets

enum class DurationKind : std::uint8_t { kDefault, kValue, kAuto, kOpen, kAs };

// takes ...
struct Duration {
    DurationKind kind = DurationKind::kDefault;
    Expr value;  // kValue: an expression, a kRange (drawn uniformly), or a kCall of a distribution
    Path as;     // kAs
    Span span;
};

// One group of `tokens 2 (kind = vip) ready, 1`.
struct InitialTokens {
    Expr count;
    std::vector<Binding> attributes;
    bool ready = false;
    Span span;
};

enum class Discipline : std::uint8_t { kDefault, kOldest, kNewest, kLeast, kMost, kAny };
enum class Role : std::uint8_t {
    kInner,
    kStart,
    kFinish
};  // the ways in and out of a net that a place `runs`

// [public] [start | finish] place NAME "caption" clauses, and in a machine: state NAME "caption"
// clauses
struct Place {
    Name name;
    Caption caption;
    bool is_public = false;
    Role role = Role::kInner;
    // Of a state of a machine. `starts`: has the token, or is the way in where a place runs the
    // machine. `final`: the machine may rest there, or it is the way out.
    bool starts = false, final = false;
    Expr does;  // `does CALL`: a movement
    Expr runs;  // `runs NET(args)`: the net that refines this place
    Duration takes;
    std::vector<InitialTokens> tokens;
    Expr capacity;  // holds at most k
    bool keeps_order = false;
    Discipline discipline = Discipline::kDefault;
    bool by_arrival = false;            // first, last; `least EXPR first`
    Expr discipline_key;                // least, most
    Path of_type;                       // of Customer
    std::vector<Parameter> attributes;  // of Customer(kind: Kind, due: time): declared here
    Path same_as;                       // `is other.flight`: this very place, under another name
    Span span;
};

enum class ArcKind : std::uint8_t {
    kTake,         // k*P
    kTakeNow,      // now k*P: ready or not
    kTakeAll,      // all P
    kTakeAllNow,   // all now P: ready or not
    kGive,         // k*P after ->
    kWith,         // with k*P: reads ready tokens
    kWhile,        // while k*P: reads tokens ready or not
    kUnless,       // unless k*P: fewer than k, ready or not
    kUnlessReady,  // unless ready k*P
};

struct Arc {
    ArcKind kind = ArcKind::kTake;
    Expr weight;  // kNone: 1
    Path place;
    std::vector<Binding> pattern;  // queue(kind = vip, due = d); on kGive: the attributes of the
                                   // new token. In a `now` arc `left = r` binds the time left; on
                                   // kGive it gives the new token that duration.
    Span span;
};

enum class Memory : std::uint8_t { kDefault, kEnabling, kAge, kResample };

// NAME "caption": INPUTS -> OUTPUTS clauses
struct Transition {
    Name name;
    Caption caption;
    bool is_public = false;
    std::vector<Arc> inputs;   // before the arrow, in source order
    std::vector<Arc> outputs;  // after it
    std::vector<Arc> tests;    // with, while, unless, in source order
    Expr priority;
    Expr guard;                // when
    std::vector<Path> events;  // on A or B
    bool next_event = false;   // on next A or B
    Expr delay;                // after: an expression, a kRange or a kCall of a distribution
    Memory memory = Memory::kDefault;
    Expr servers;                      // a number, or the kPath `infinite`
    Expr holding;                      // for d
    bool holding_left = false;         // for left: what the token taken `now` had still to wait
    std::vector<Binding> assignments;  // set x := ..., y := ...
    Expr odds;
    std::vector<Path> raises;
    std::vector<Path> together_with;  // a rendezvous with other transitions
    // send c!m: the channel and the message; receive c?r: a variable that gets it, or what it must
    // be. Without message: a signal, and whatever comes.
    Path send, receive;
    Expr message, received;
    Expr poll;  // poll every d: is looked at then only
    Span span;
};

// [public] state NAME "caption" = formula over places, data, phases
struct State {
    Name name;
    Caption caption;
    bool is_public = false;
    Expr formula;
    Span span;
};

// [public] data NAME "caption": TYPE = initial value
struct Data {
    Name name;
    Caption caption;
    bool is_public = false;
    Expr type;     // kRange: bounded integer; kPath: bool, real, time, int, an enumeration
    Expr initial;  // kNone: the first value, zero, no
    Span span;
};

// [public] channel NAME "caption" [of TYPE]
struct Channel {
    Name name;
    Caption caption;
    bool is_public = false;
    Expr type;  // as of data; kNone: of signals
    Span span;
};

// enum NAME { a, b, c }
struct Enumeration {
    Name name;
    std::vector<Name> values;
    Span span;
};

// token NAME(kind: Kind, due: time)
struct TokenType {
    Name name;
    std::vector<Parameter> attributes;
    Span span;
};

// [public] [consumed] event NAME "caption" at 2 s, 3.5 s | every 2 s [from 1 s] [until 30 s]
struct Event {
    Name name;
    Caption caption;
    bool is_public = false;
    bool is_consumed = false;
    std::vector<Expr> at;
    Expr every, from, until;
    Span span;
};

// events from "file"
struct EventFile {
    std::string path;
    Span span;
};

// use NET(args) as NAME, use "FILE" as NAME { PARAMETER: VALUE, ... }
struct Use {
    Name name;  // `as NAME`, else the net's own name
    Path net;
    std::string path;  // of a file in another notation, whose net has the file's name; it is
                       // imported as well
    std::vector<Argument> args;
    Span span;
};

// end { formula }: markings in which the net may rest for ever. Several lines: any of them.
struct End {
    std::vector<Expr> formulas;
    Span span;
};

enum class RuleKind : std::uint8_t {
    kNever,
    kAlways,
    kPossible,  // one operand
    kMutex,
    kExactlyOne,    // two or more
    kAlternate,     // two or more firings, in turn
    kBounded,       // operands: places, none for all of them; bound: `by: k`
    kOnlyIf,        // A only if B
    kAfterNoUntil,  // after A no B until C
    kLeadsTo,       // A leads to B [within T]
    kTakesAtMost,   // A takes at most T
    kDeadlockFree,
    kReversible,
    kEnds,  // no operand
    kLive,
    kQuasiLive,      // transitions, none for all of them
    kNobodyFreezes,  // actors, none for all of them
    kCtl,
    kLtl,  // one formula with calls AG EF AX ... or G F X, and until
};

// rule NAME "caption" ... [when settled]
struct Rule {
    Name name;
    Caption caption;
    RuleKind kind = RuleKind::kNever;
    std::vector<Expr> operands;  // in the order of the form
    Expr bound;                  // the time of within / at most, the k of bounded
    bool when_settled = false;   // looked at only where time passes
    Span span;
};

enum class QuestionKind : std::uint8_t { kShortestTime, kLongestTime, kCycleTime };

// question NAME "caption" shortest time to A | longest time to A | cycle time of A
struct Question {
    Name name;
    Caption caption;
    QuestionKind kind = QuestionKind::kShortestTime;
    Expr about;
    Span span;
};

// A firing of a transition, and in (...) to which passage it belongs.
struct Moment {
    Path transition;
    Expr key;
    Span span;
};

enum class Seen : std::uint8_t {
    kExpr,    // EXPR, or EXPR at TRANSITION or ...
    kStay,    // time in PLACE
    kPassage  // time from TRANSITION or ... to TRANSITION or ...
};

// measure NAME "caption" STATISTIC of WHAT [> TIME]
struct Measure {
    Name name;
    Caption caption;
    Name statistic;  // mean, most, least, total, final, share, percentile, count, rate
    Expr percent;    // of percentile
    Seen seen = Seen::kExpr;
    Expr value;                    // kExpr; of count and rate transitions joined by `or`
    Path place;                    // kStay
    std::vector<Moment> from, to;  // kPassage; `from` of kExpr: at
    Expr above;                    // of share of times
    Span span;
};

// ---------------------------------------------------------------------------------------------------------------------
// Blocks: every other kind, parsed alike and given meaning by whoever knows the kind

// keeps ana and rui in view: one name, then values side by side: `ana and rui`, `in`, `view`.
struct Property {
    Path name;
    std::vector<Expr> values;
    std::vector<Property> children;  // nested { ... }
    bool has_children = false;       // also when they are empty
    Span span;
};

// camera main { ... }, material wood(shine = 0.2) { ... }
struct Block {
    Name kind;
    Name name;  // text empty when not written
    std::vector<Parameter> parameters;
    std::vector<Property> properties;
    Span span;
};

// ana: mannequin { height 1.75 m, at (-1.5, 0, 0) m }
struct CastMember {
    Name name;
    Name kind;
    std::vector<Property> properties;
    Span span;
};

// ---------------------------------------------------------------------------------------------------------------------
// Files

struct For;
struct Net;

// The statements of a file, of a net, or of a `for`. What may not stand there has been refused by
// the parser: nets, cast and blocks of other kinds stand in files only. Places and transitions of a
// file are the scene's own net.
struct Body {
    std::vector<Place> places;
    std::vector<Transition> transitions;
    std::vector<State> states;
    std::vector<Data> data;
    std::vector<Channel> channels;
    std::vector<Enumeration> enumerations;
    std::vector<TokenType> token_types;
    std::vector<Event> events;
    std::vector<EventFile> event_files;
    std::vector<Use> uses;
    std::vector<Rule> rules;
    std::vector<Question> questions;
    std::vector<Measure> measures;
    std::vector<End> ends;
    std::vector<For> loops;
    std::vector<Net> nets;
    std::vector<CastMember> cast;
    std::vector<Block> blocks;
};

// for p in (a, b) { ... }, for i in 1 .. n { ... }. A rule (or question) named `fair` in it is
// named `fair.a`.
struct For {
    Name variable;
    Expr domain;
    Body body;
    Span span;
};

// net NAME(parameters) { ... }, machine NAME(parameters) { ... }
struct Net {
    Name name;
    Caption caption;
    bool is_machine = false;  // its places are states (notation/machine.h)
    std::vector<Parameter> parameters;
    Body body;
    Span span;
};

// import walk, run from "gaits.pup"
struct Import {
    std::vector<Name> names;
    std::string path;
    Span path_span;
    Span span;
};

enum class HorizonKind : std::uint8_t { kNone, kTime, kFrame, kFirings };

// The header lines; kNone where not written.
struct Header {
    Expr language;
    Caption title;    // scene "title"
    Span scene_span;  // the scene line; begin == end when there is none: the file is a library of
                      // nets
    Expr frames_per_second;
    HorizonKind horizon_kind = HorizonKind::kNone;
    Expr horizon;  // until frame 960 | until 40 s | until 500 firings
    Expr seed;
    Expr pace;       // one firing per beat of an untimed net
    Expr time_unit;  // of numbers without unit where a time is wanted
};

struct File {
    std::string filename;
    std::string text;                        // as read, without a leading byte order mark
    std::vector<std::uint32_t> line_starts;  // byte offsets, the first is 0
    Header header;
    std::vector<Import> imports;
    Body body;

    // Line, column and length for people, all in code points; a span over several lines ends with
    // its first. Cost: log n.
    SourceSpan where(Span span) const;
    // The line's text without its end, for format_diagnostic; `?` for bytes that are no UTF-8.
    // Empty for lines that are not there.
    std::string line_text(std::uint32_t line) const;
};

}  // namespace puppetri::lang
