// SPDX-License-Identifier: MIT
// Untimed nets: what is decided on markings alone. One portfolio, for the rules of scenes and nets
// (plain_rules.h) and for the questions of the contest (contest.h); its methods share the net, the
// clock, and state spaces that are made once for all questions.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "puppetri/proof/budget.h"
#include "puppetri/proof/explorer.h"
#include "puppetri/proof/graph_algorithms.h"
#include "puppetri/proof/plain_net.h"
#include "puppetri/proof/predicate.h"
#include "puppetri/proof/symbolic.h"
#include "puppetri/proof/symmetry.h"
#include "puppetri/proof/temporal.h"
#include "puppetri/verdict/contest.h"

namespace puppetri::verdict {

// How a question was decided.
enum class How : std::uint8_t {
    kNone,
    kStructure,    // arcs, invariants, theorems
    kWalk,         // met at random
    kEquation,     // state equation
    kExploration,  // every marking, one by one
    kSymmetry,     // one marking for all that swaps of instances make of it
    kReduced,      // every marking of a reduced net
    kStubborn,     // the same with stubborn sets
    kDiagrams,     // decision diagrams
};
const char* techniques_of(How how);  // in the words of the contest
const char* method_of(How how);      // in those of verdicts

struct Decision {
    proof::Truth truth = proof::Truth::kUnknown;
    How how = How::kNone;
};

class PlainSession {
 public:
    PlainSession(const net::Net& net, const proof::Budget& budget);

    const net::Net& net() const { return net_; }
    const proof::PlainNet& plain() const { return plain_.net; }
    // The plain picture is the net itself: what is found in it is so. Otherwise nothing is
    // answered.
    bool fits() const { return sound() && plain_.net.exact(); }
    // At least every run of the net is one of the picture.
    bool sound() const { return !plain_.unsound; }
    std::string why_not() const;

    // A share of the time that is left, and all memory. Never more seconds than `most`.
    proof::Budget share(double fraction, double most = 1e9) const;
    bool out_of_time() const;
    unsigned threads() const { return budget_.threads; }

    // Upper bounds of places from semiflows; large where none is known.
    const proof::Marking& bounds();

    // Interchangeable instances, found by the names of places and transitions.
    const proof::Symmetry& symmetry();

    // The symbolic state space, if it can be made in this share of the time (a first quick look
    // takes two seconds at most). Null: not within it.
    proof::SymbolicSpace* quick_symbolic();
    proof::SymbolicSpace* symbolic(double fraction);
    // The quick look says that there are too many states to visit one by one.
    bool too_many_to_visit();
    // The graph of all markings, without atoms, if it can be made in this share of the time.
    struct Markings {
        proof::PlainGraph plain;
        proof::StrongComponents components;
        proof::StateBits bottoms;  // per component: nothing leads out of it
    };
    const Markings* markings(double fraction);

    static constexpr std::uint64_t kVisited = 30'000'000;  // states, at most, that are visited

 private:
    const net::Net& net_;
    const proof::Budget& budget_;
    proof::Plain plain_;
    proof::Meter meter_;
    std::optional<proof::Marking> bounds_;
    std::optional<proof::Symmetry> symmetry_;
    std::unique_ptr<proof::SymbolicSpace> space_;
    std::unique_ptr<Markings> markings_;
    bool listed_ = false;
    bool looked_ = false;
    double tried_seconds_ = 0;
};

// Whether markings are reachable in which the predicates hold, all in one go: structure, a walk,
// exploration, decision diagrams. In the order of the goals.
std::vector<Decision> decide_reachable(PlainSession& session,
                                       std::span<const proof::Predicate> goals);
// The same with the methods that take no more than a second or two: structure, a walk, equations.
std::vector<Decision> decide_reachable_quickly(PlainSession& session,
                                               std::span<const proof::Predicate> goals);
// Is a dead marking reachable in which `final` does not hold?
Decision decide_dead(PlainSession& session,
                     const proof::Predicate& final = proof::Predicate::constant(false));

// Transitions, from the initial marking. Nothing: not found within the budget.
using Firings = std::optional<std::vector<std::uint32_t>>;
Firings way_to(PlainSession& session, const proof::Predicate& goal);
Firings way_to_death(PlainSession& session, const proof::Predicate& final);

// Where each of the transitions may fire: its arcs allow it, and nobody of a higher level is
// enabled.
std::vector<proof::Predicate> each_may_fire(const proof::PlainNet& net,
                                            std::span<const std::uint32_t> transitions);

// Whether something can, or will, happen from every marking.
struct Outlook {
    Decision decision;
    Firings out;                                   // of kFalse: leads to where it cannot
    std::uint32_t transition = ~std::uint32_t{0};  // of live, quasi-live: which one
    bool unlucky = false;  // of ends, kTrue: unless the wrong choices are made for ever
};
// Can each of the transitions fire? Those that can for certain are not `transition`.
Outlook decide_quasi_live(PlainSession& session, std::span<const std::uint32_t> transitions);
// Can each always fire again?
Outlook decide_live(PlainSession& session, std::span<const std::uint32_t> transitions,
                    bool with_way);
// Can the initial marking always be reached again?
Outlook decide_reversible(PlainSession& session);
// Does every run get to a dead marking (in which `final` holds)?
Outlook decide_ends(PlainSession& session, const proof::Predicate& final);

// The largest value of each sum. Nothing: not known.
struct Maximum {
    std::optional<std::int64_t> value;
    How how = How::kNone;
};
std::vector<Maximum> decide_maxima(PlainSession& session, std::span<const proof::LinearSum> sums);
// Do the formulas hold in the initial marking? CTL, and LTL on all paths.
struct LogicQuestion {
    proof::Temporal formula;
    std::vector<proof::Predicate> atoms;  // of the formula, in its order
};
std::vector<Decision> decide_logic(PlainSession& session, std::span<const LogicQuestion> questions);
// Of linear time, one that does not hold: a run that shows it, from decision diagrams.
std::optional<proof::SymbolicLasso> run_against(PlainSession& session,
                                                const LogicQuestion& question);
// EF a, AG a, and G a on all paths, over a state formula: a question about single markings.
struct AsReachability {
    proof::Predicate goal;
    bool value_if_reached = false;
};
std::optional<AsReachability> as_reachability(const LogicQuestion& question);

}  // namespace puppetri::verdict
