// SPDX-License-Identifier: MIT
// Rules as formulas over a net: parsed and resolved with the scene, proved by others. Atoms speak
// of places, data, events and firings; what only the stage knows (the phase of a leg, the holder of
// a ball) is an opaque host atom.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "puppetri/base/diagnostic.h"
#include "puppetri/base/expr.h"
#include "puppetri/base/index.h"
#include "puppetri/base/time.h"
#include "puppetri/net/host.h"
#include "puppetri/net/indices.h"

namespace puppetri::net {

// A statement about figures and props, known to the stage only.
struct HostAtom {
    enum class Kind : std::uint8_t { kPhase, kHolder };
    Kind kind = Kind::kPhase;
    std::string subject;  // phase: actor and limb, "ana.left_leg"; holder: the prop, "ball"
    std::string value;    // phase: "swing"; holder: "ana.hands", "air", "floor", a place
    SourceSpan where;
};

enum class FormulaOp : std::uint8_t {
    kConstant,  // count != 0
    kMarked,    // place `index` has at least `count` tokens, ready or not
    kReady,     // the same, ready ones only
    kExpr,      // expressions[index], a bool over data and counts
    kEvent,     // event `index` occurs
    kFires,     // transition `index` fires
    kFireable,  // transition `index` may fire
    kHost,      // host atom `index`
    kNot,
    kAnd,
    kOr,
    kImplies,
    kIff,
    // branching time, of the current state
    kAllNext,
    kAllGlobally,
    kAllFinally,
    kAllUntil,
    kSomeNext,
    kSomeGlobally,
    kSomeFinally,
    kSomeUntil,
    // linear time, of the run from here
    kNext,
    kGlobally,
    kFinally,
    kUntil,
};

struct Formula {
    struct Node {
        FormulaOp op = FormulaOp::kConstant;
        std::uint32_t a = 0, b = 0;  // operands, indices of earlier nodes
        std::uint32_t index = 0;     // of atoms
        std::int64_t count = 1;
    };
    std::vector<Node> nodes;  // operands before operators; the root is last
    std::vector<Expr> expressions;

    static Formula constant(bool value);
    static Formula marked(PlaceIndex place, std::int64_t count = 1);
    static Formula ready(PlaceIndex place, std::int64_t count = 1);
    static Formula expression(Expr e);
    static Formula event(EventIndex e);
    static Formula fires(TransitionIndex t);
    static Formula fireable(TransitionIndex t);
    static Formula host(HostAtomIndex a);
    static Formula unary(FormulaOp op, Formula a);
    static Formula binary(FormulaOp op, Formula a, Formula b);
};

// `state has = with_ball or to_throw or ...`
struct NamedState {
    std::string path;
    std::string caption;
    SourceSpan where;
    Formula condition;
    bool is_public = false;
};

enum class RuleKind : std::uint8_t {
    kNever,       // operand 0
    kAlways,      // operand 0
    kMutex,       // at most one of all operands
    kExactlyOne,  // of all operands
    kBounded,     // place operands have at most `count` tokens
    kAlternate,   // firings or states, in turn
    kOnlyIf,      // operand 0 only if operand 1
    kUntil,       // after operand 0 no operand 1 until operand 2
    kLeadsTo,     // operand 0 leads to operand 1 (within)
    kEnds,
    kDeadlockFree,
    kPossible,  // operand 0
    kLive,
    kQuasiLive,  // `transitions`, or all
    kReversible,
    kNobodyFreezes,  // `subjects`: actors, or all
    kTakesAtMost,    // operand 0 lasts at most `within`
    kFormula,        // operand 0, branching or linear time
};

struct Rule {
    std::string path;
    std::string caption;
    SourceSpan where;
    RuleKind kind = RuleKind::kNever;
    std::vector<Formula> operands;
    std::vector<TransitionIndex> transitions;
    std::vector<std::string> subjects;
    std::optional<SimTime> within;
    std::int64_t count = 1;
    bool when_settled = false;  // checked only where time passes
};

// A question about time, whose answer is a number: `question NAME shortest time to A`.
enum class TimeQuestionKind : std::uint8_t {
    kShortest,  // from the start until the statement is true first, in the quickest of all runs
    kLongest,   // the same in the slowest
    kCycle,     // from one time that it becomes true to the next, in the long run
};

struct TimeQuestion {
    std::string path;
    std::string caption;
    SourceSpan where;
    TimeQuestionKind kind = TimeQuestionKind::kShortest;
    Formula about;  // of one moment: places, data, firings, events, figures
};

}  // namespace puppetri::net
