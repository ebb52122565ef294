// SPDX-License-Identifier: MIT
// Questions about single markings: which can be reached, which are dead, how large a sum gets.
#include <algorithm>
#include <utility>

#include "plain_session.h"
#include "puppetri/proof/explorer.h"
#include "puppetri/proof/random_walk.h"
#include "puppetri/proof/reductions.h"
#include "puppetri/proof/state_equation.h"
#include "puppetri/proof/structural_liveness.h"

namespace puppetri::verdict {

namespace {

using proof::Ended;
using proof::Predicate;
using proof::Truth;

// Goals that are not decided yet.
class OpenGoals {
 public:
    explicit OpenGoals(std::span<const Predicate> goals)
        : goals_(goals.begin(), goals.end()), decisions_(goals.size()) {
        for (std::uint32_t i = 0; i < goals.size(); ++i) {
            open_.push_back(i);
        }
    }
    bool empty() const { return open_.empty(); }
    std::vector<Predicate> list() const {
        std::vector<Predicate> list;
        for (const std::uint32_t i : open_) {
            list.push_back(goals_[i]);
        }
        return list;
    }
    Predicate& operator[](std::uint32_t i) { return goals_[open_[i]]; }
    std::uint32_t count() const { return static_cast<std::uint32_t>(open_.size()); }
    // decide(i) gives what is known now of the i-th open goal.
    template <class Decide>
    void decide(How how, Decide&& decide) {
        std::vector<std::uint32_t> left;
        for (std::uint32_t i = 0; i < open_.size(); ++i) {
            const Truth truth = decide(i);
            if (truth == Truth::kUnknown) {
                left.push_back(open_[i]);
            } else {
                decisions_[open_[i]] = {truth, how};
            }
        }
        open_ = std::move(left);
    }
    std::vector<Decision> take() { return std::move(decisions_); }

 private:
    std::vector<Predicate> goals_;
    std::vector<Decision> decisions_;
    std::vector<std::uint32_t> open_;
};

// Instances that none of the predicates tells apart.
proof::Symmetry respecting(PlainSession& session, std::span<const Predicate> predicates) {
    proof::Symmetry symmetry = proof::keeping(session.symmetry(), session.plain().initial);
    for (const Predicate& p : predicates) {
        if (symmetry.none()) {
            break;
        }
        symmetry = proof::respecting(symmetry, proof::told_in_tokens(p, session.plain()));
    }
    return symmetry;
}

// A smaller net with the same markings as far as the predicates see them.
struct Seen {
    proof::Reduction reduction;
    std::vector<Predicate> goals;  // of the smaller net
};
Seen reduced_for(PlainSession& session, std::span<const Predicate> goals) {
    const proof::PlainNet& net = session.plain();
    proof::ReductionGoal goal;
    goal.preserves = proof::Preserves::kReachability;
    goal.keep.assign(net.place_count(), 0);
    for (const Predicate& p : goals) {
        for (const std::uint32_t place : proof::places_of(p, net)) {
            goal.keep[place] = 1;
        }
    }
    Seen seen{.reduction = proof::reduce(net, goal, session.share(0.1, 1))};
    for (const Predicate& p : goals) {
        seen.goals.push_back(proof::told_in_tokens(p, net, seen.reduction.now));
    }
    return seen;
}

// Which of the predicates are met: up to symmetry where there is some, else on the reduced net.
struct Explored {
    std::vector<Truth> reached;
    How how = How::kExploration;
    Firings way;  // to the first one
};
Explored explored(PlainSession& session, std::span<const Predicate> goals,
                  const proof::Budget& budget, bool with_way) {
    Explored out;
    proof::ExploreOptions options;
    options.goals = goals;
    options.stop_when_found = true;
    options.witnesses = with_way;
    const proof::Symmetry symmetry = respecting(session, goals);
    Seen seen;
    if (!symmetry.none()) {
        options.symmetry = &symmetry;
        out.how = How::kSymmetry;
    } else {
        seen = reduced_for(session, goals);
        if (seen.reduction.rules_applied > 0) {
            options.goals = seen.goals;
            out.how = How::kReduced;
        }
    }
    const bool reduced = out.how == How::kReduced;
    const proof::Exploration e =
        proof::explore(reduced ? seen.reduction.net : session.plain(), options, budget);
    if (out.how == How::kSymmetry && !e.symmetric) {
        out.how = How::kExploration;
    }
    const bool all_seen = e.ended == Ended::kDone && e.complete;
    for (const proof::Finding& f : e.goals) {
        out.reached.push_back(f.found ? Truth::kTrue : all_seen ? Truth::kFalse : Truth::kUnknown);
    }
    if (with_way && e.goals[0].found) {
        out.way = reduced ? seen.reduction.original(session.plain(), e.goals[0].firings, false)
                          : e.goals[0].firings;
    }
    return out;
}

void explore_for(PlainSession& session, OpenGoals& open, const proof::Budget& budget) {
    const Explored e = explored(session, open.list(), budget, false);
    open.decide(e.how, [&](std::uint32_t i) { return e.reached[i]; });
}

void ask_diagrams(proof::SymbolicSpace* space, OpenGoals& open, const PlainSession& session) {
    if (space == nullptr) {
        return;
    }
    space->renew(session.share(0.6));
    open.decide(How::kDiagrams, [&](std::uint32_t i) {
        const std::optional<bool> none = space->empty(space->satisfying(open[i]));
        return none.has_value() ? proof::truth_of(!*none) : Truth::kUnknown;
    });
}

// An enabled transition in every marking, by theorem.
bool never_dead_by_structure(PlainSession& session) {
    return proof::structural_liveness(session.plain(), session.share(0.1, 0.2)).deadlock_free;
}

// Smaller, with the same answer. Where a final marking is no death, its places would have to be
// kept: then the net is left as it is.
proof::Reduction reduced_for_death(PlainSession& session, const Predicate& final) {
    proof::ReductionGoal goal;
    goal.preserves = proof::Preserves::kDeadlock;
    proof::Budget budget = session.share(0.2, 2);
    if (!final.is_constant(false)) {
        budget.seconds = 0;
        goal.keep.assign(session.plain().place_count(), 1);
    }
    return proof::reduce(session.plain(), goal, budget);
}

// Instances that death does not tell apart, in the reduced net.
proof::Symmetry symmetry_of(PlainSession& session, const proof::Reduction& reduced,
                            const Predicate& final) {
    std::vector<std::string_view> places, transitions;
    for (const std::uint32_t p : reduced.place_of) {
        places.push_back(session.net().place(net::PlaceIndex{p}).path);
    }
    for (std::uint32_t t = 0; t < reduced.net.transition_count(); ++t) {
        const auto row = reduced.sequences.row(t);
        transitions.push_back(row.empty()
                                  ? std::string_view()
                                  : session.net().transition(net::TransitionIndex{row[0]}).path);
    }
    proof::Symmetry symmetry = proof::interchangeable_instances(reduced.net, places, transitions);
    return final.is_constant(false)
               ? symmetry
               : proof::respecting(symmetry, proof::told_in_tokens(final, session.plain()));
}

void decide_without_states(PlainSession& session, OpenGoals& open) {
    for (std::uint32_t i = 0; i < open.count(); ++i) {
        open[i] = proof::simplified(open[i], session.plain(), session.bounds());
    }
    open.decide(How::kStructure, [&](std::uint32_t i) {
        return open[i].is_constant(true)    ? Truth::kTrue
               : open[i].is_constant(false) ? Truth::kFalse
                                            : Truth::kUnknown;
    });
    if (!open.empty()) {
        const std::vector<Predicate> list = open.list();
        proof::WalkOptions options;
        options.goals = list;
        const proof::WalkOutcome walk =
            proof::walk_at_random(session.plain(), options, session.share(0.1, 1));
        open.decide(How::kWalk, [&](std::uint32_t i) {
            return walk.met[i] != 0 ? Truth::kTrue : Truth::kUnknown;
        });
    }
    const proof::Budget each = session.share(0.05 / std::max(1u, open.count()), 0.3);
    open.decide(How::kEquation, [&](std::uint32_t i) {
        return proof::solve_state_equation(session.plain(), open[i], each).kind ==
                       proof::StateEquationAnswer::kImpossible
                   ? Truth::kFalse
                   : Truth::kUnknown;
    });
}

}  // namespace

std::vector<Decision> decide_reachable_quickly(PlainSession& session,
                                               std::span<const Predicate> goals) {
    OpenGoals open(goals);
    decide_without_states(session, open);
    return open.take();
}

std::vector<Decision> decide_reachable(PlainSession& session, std::span<const Predicate> goals) {
    OpenGoals open(goals);
    decide_without_states(session, open);
    if (!open.empty()) {
        proof::Budget few = session.share(0.3);
        few.states = 200'000;
        explore_for(session, open, few);
    }
    if (!open.empty() && session.too_many_to_visit()) {
        ask_diagrams(session.quick_symbolic(), open, session);
    }
    if (!open.empty()) {
        explore_for(session, open, session.share(0.5));
    }
    if (!open.empty()) {
        ask_diagrams(session.symbolic(0.7), open, session);
    }
    if (!open.empty() && !session.out_of_time()) {
        explore_for(session, open, session.share(1));
    }
    return open.take();
}

Decision decide_dead(PlainSession& session, const Predicate& final) {
    if (never_dead_by_structure(session)) {
        return {Truth::kFalse, How::kStructure};
    }
    const bool everywhere = final.is_constant(false);
    if (everywhere) {
        proof::WalkOptions walk;
        walk.steps = 20'000;
        walk.find_dead = true;
        if (proof::walk_at_random(session.plain(), walk, session.share(0.1, 0.2)).met_dead) {
            return {Truth::kTrue, How::kWalk};
        }
    }
    const proof::Reduction reduced = reduced_for_death(session, final);
    const proof::Symmetry symmetry = symmetry_of(session, reduced, final);
    const auto explored = [&](const proof::Budget& budget, bool stubborn) {
        proof::ExploreOptions options;
        options.find_dead = true;
        options.final = everywhere ? nullptr : &final;
        options.stop_when_found = true;
        options.reduce = stubborn;
        options.symmetry = &symmetry;
        const proof::Exploration e = proof::explore(reduced.net, options, budget);
        return e.dead.found                            ? Truth::kTrue
               : e.ended == Ended::kDone && e.complete ? Truth::kFalse
                                                       : Truth::kUnknown;
    };
    // A few million states are visited sooner than stubborn sets are computed.
    proof::Budget few = session.share(0.3);
    few.states = 3'000'000;
    Truth truth = explored(few, false);
    if (truth != Truth::kUnknown) {
        return {truth, How::kReduced};
    }
    truth = explored(session.share(0.4), true);
    if (truth != Truth::kUnknown) {
        return {truth, How::kStubborn};
    }
    if (proof::SymbolicSpace* space = session.symbolic(0.5)) {
        space->renew(session.share(0.8));
        const std::optional<bool> none =
            space->empty(space->without(space->stuck(), space->satisfying(final)));
        if (none.has_value()) {
            return {proof::truth_of(!*none), How::kDiagrams};
        }
    }
    if (!session.out_of_time()) {
        truth = explored(session.share(1), true);
    }
    return {truth, How::kStubborn};
}

namespace {

Firings some_way_to(PlainSession& session, const Predicate& goal) {
    const auto drawn = [&](proof::SymbolicSpace* space) -> Firings {
        if (space == nullptr) {
            return std::nullopt;
        }
        space->renew(session.share(0.5));
        return space->path_to(space->satisfying(goal));
    };
    proof::Budget few = session.share(0.3);
    few.states = 300'000;
    Explored e = explored(session, {&goal, 1}, few, true);
    if (e.way.has_value()) {
        return std::move(e.way);
    }
    Firings way = drawn(session.quick_symbolic());
    if (way.has_value()) {
        return way;
    }
    if (!session.too_many_to_visit()) {
        e = explored(session, {&goal, 1}, session.share(0.6), true);
        if (e.way.has_value()) {
            return std::move(e.way);
        }
    }
    return drawn(session.symbolic(0.9));
}

}  // namespace

// Reductions fire first what nobody sees: it may be met before.
Firings way_to(PlainSession& session, const Predicate& goal) {
    Firings way = some_way_to(session, goal);
    if (!way.has_value()) {
        return way;
    }
    proof::Marking marking = session.plain().initial;
    for (std::size_t i = 0; i < way->size(); ++i) {
        if (goal.holds(session.plain(), marking)) {
            way->resize(i);
            break;
        }
        session.plain().fire(marking, (*way)[i]);
    }
    return way;
}

Firings way_to_death(PlainSession& session, const Predicate& final) {
    const proof::Reduction reduced = reduced_for_death(session, final);
    const proof::Symmetry symmetry = symmetry_of(session, reduced, final);
    proof::ExploreOptions options;
    options.symmetry = &symmetry;
    options.find_dead = true;
    options.final = final.is_constant(false) ? nullptr : &final;
    options.witnesses = true;
    const proof::Exploration e = proof::seek(reduced.net, options, session.share(0.5));
    if (e.dead.found) {
        return reduced.original(session.plain(), e.dead.firings, true);
    }
    if (proof::SymbolicSpace* space = session.symbolic(0.5)) {
        space->renew(session.share(0.8));
        return space->path_to(space->without(space->stuck(), space->satisfying(final)));
    }
    return std::nullopt;
}

std::vector<Maximum> decide_maxima(PlainSession& session, std::span<const proof::LinearSum> sums) {
    std::vector<Maximum> result(sums.size());
    std::vector<std::optional<std::int64_t>> most(sums.size());
    proof::WalkOptions options;
    options.sums = sums;
    options.steps = 50'000;
    const proof::WalkOutcome walk =
        proof::walk_at_random(session.plain(), options, session.share(0.1, 1));
    std::vector<std::int64_t> least = walk.greatest;
    const auto settle = [&](std::size_t i, How how) {
        if (!result[i].value.has_value() && most[i].has_value() && *most[i] <= least[i]) {
            result[i] = {least[i], how};
        }
    };
    for (std::size_t i = 0; i < sums.size(); ++i) {
        most[i] = proof::upper_bound(session.plain(), sums[i], session.share(0.02, 0.3));
        settle(i, How::kEquation);
    }
    const auto open = [&] {
        return std::any_of(result.begin(), result.end(),
                           [](const Maximum& m) { return !m.value.has_value(); });
    };
    const auto ask = [&](proof::SymbolicSpace* space) {
        if (space == nullptr) {
            return;
        }
        space->renew(session.share(0.6));
        for (std::size_t i = 0; i < sums.size(); ++i) {
            if (result[i].value.has_value()) {
                continue;
            }
            const std::optional<std::int64_t> value = space->max_of(sums[i], space->all());
            if (value.has_value()) {
                result[i] = {value, How::kDiagrams};
            }
        }
    };
    if (open()) {
        ask(session.quick_symbolic());
    }
    // Exploration gives the greatest count of each place; of other sums, whether more than was seen
    // can be reached, one round after another.
    for (int round = 0; round < 64 && open() && !session.out_of_time(); ++round) {
        std::vector<Predicate> goals;
        std::vector<std::size_t> goal_of;
        for (std::size_t i = 0; i < sums.size(); ++i) {
            const bool one_place = sums[i].terms.size() == 1 && sums[i].terms[0].factor == 1;
            if (!result[i].value.has_value() && !one_place) {
                goals.push_back(Predicate::at_least(sums[i], least[i] + 1));
                goal_of.push_back(i);
            }
        }
        proof::ExploreOptions search;
        search.goals = goals;
        const proof::Exploration e = proof::explore(session.plain(), search, session.share(0.5));
        if (e.ended != Ended::kDone || !e.complete) {
            break;
        }
        for (std::size_t i = 0; i < sums.size(); ++i) {
            if (!result[i].value.has_value() && sums[i].terms.size() == 1 &&
                sums[i].terms[0].factor == 1) {
                result[i] = {std::int64_t{e.bounds[sums[i].terms[0].place]}, How::kExploration};
            }
        }
        for (std::size_t k = 0; k < goals.size(); ++k) {
            const std::size_t i = goal_of[k];
            if (!e.goals[k].found) {
                result[i] = {least[i], How::kExploration};
                continue;
            }
            std::int64_t value = 0;
            for (const proof::LinearSum::Term& term : sums[i].terms) {
                value += term.factor * std::int64_t{e.goals[k].marking[term.place]};
            }
            least[i] = std::max(least[i] + 1, value);
            settle(i, How::kExploration);
        }
    }
    if (open() && !session.out_of_time()) {
        ask(session.symbolic(0.8));
    }
    return result;
}

}  // namespace puppetri::verdict
