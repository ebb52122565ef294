// SPDX-License-Identifier: MIT
// What the methods of the contest share: the net, the clock, the answers given so far, and state
// spaces that are made once for all questions.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "puppetri/proof/budget.h"
#include "puppetri/proof/plain_net.h"
#include "puppetri/proof/predicate.h"
#include "puppetri/proof/symbolic.h"
#include "puppetri/proof/temporal.h"
#include "puppetri/verdict/contest.h"

namespace puppetri::verdict {

// How a question was decided.
struct Decision {
    proof::Truth truth = proof::Truth::kUnknown;
    const char* techniques = "";
};

class ContestSession {
 public:
    ContestSession(const net::Net& net, const proof::Budget& budget);

    const net::Net& net() const { return net_; }
    const proof::PlainNet& plain() const { return plain_.net; }
    // The plain picture is the net itself: what is found in it is so. Otherwise nothing is
    // answered.
    bool fits() const { return !plain_.unsound && plain_.net.exact(); }
    std::string why_not() const;

    // A share of the time that is left, and all memory. Never more seconds than `most`.
    proof::Budget share(double fraction, double most = 1e9) const;
    bool out_of_time() const;
    unsigned threads() const { return budget_.threads; }

    // Upper bounds of places from semiflows; large where none is known.
    const proof::Marking& bounds();

    // The symbolic state space, if it can be made in this share of the time (a first quick look
    // takes two seconds at most). Null: not within it.
    proof::SymbolicSpace* quick_symbolic();
    proof::SymbolicSpace* symbolic(double fraction);
    // The quick look says that there are too many states to visit one by one.
    bool too_many_to_visit();

    static constexpr std::uint64_t kVisited = 30'000'000;  // states, at most, that are visited

 private:
    const net::Net& net_;
    const proof::Budget& budget_;
    proof::Plain plain_;
    proof::Meter meter_;
    std::optional<proof::Marking> bounds_;
    std::unique_ptr<proof::SymbolicSpace> space_;
    bool looked_ = false;
    double tried_seconds_ = 0;
};

// Whether markings are reachable in which the predicates hold, all in one go: structure, a walk,
// exploration, decision diagrams. In the order of the goals.
std::vector<Decision> decide_reachable(ContestSession& session,
                                       std::span<const proof::Predicate> goals);
// The same with the methods that take no more than a second or two: structure, a walk, equations.
std::vector<Decision> decide_reachable_quickly(ContestSession& session,
                                               std::span<const proof::Predicate> goals);
// Is a dead marking reachable?
Decision decide_dead(ContestSession& session);
// The largest value of each sum. Nothing: not known.
struct Maximum {
    std::optional<std::int64_t> value;
    const char* techniques = "";
};
std::vector<Maximum> decide_maxima(ContestSession& session, std::span<const proof::LinearSum> sums);
// Do the formulas hold in the initial marking? CTL, and LTL on all paths.
struct LogicQuestion {
    proof::Temporal formula;
    std::vector<proof::Predicate> atoms;  // of the formula, in its order
};
std::vector<Decision> decide_logic(ContestSession& session,
                                   std::span<const LogicQuestion> questions);

}  // namespace puppetri::verdict
