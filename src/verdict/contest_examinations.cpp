// SPDX-License-Identifier: MIT
// The examinations that need no file: each is a question, or a few, that other methods answer.
#include <algorithm>
#include <utility>

#include "contest_session.h"
#include "puppetri/proof/explorer.h"
#include "puppetri/proof/graph_algorithms.h"
#include "puppetri/proof/structural_liveness.h"

namespace puppetri::verdict {

namespace {

using proof::Ended;
using proof::Predicate;
using proof::Truth;

std::vector<ContestAnswer> state_space(ContestSession& session) {
    std::vector<ContestAnswer> answers(4);
    static const char* const kNames[] = {"STATES", "TRANSITIONS", "MAX_TOKEN_PER_MARKING",
                                         "MAX_TOKEN_IN_PLACE"};
    for (std::size_t i = 0; i < 4; ++i) {
        answers[i].id = kNames[i];
        answers[i].reason = "the budget ended";
    }
    const auto tell = [&](std::initializer_list<std::string> values, const char* techniques) {
        std::size_t i = 0;
        for (const std::string& value : values) {
            answers[i].value = value;
            answers[i].techniques = techniques;
            answers[i++].reason.clear();
        }
    };
    const auto by_diagrams = [&](proof::SymbolicSpace* space) {
        if (space == nullptr) {
            return false;
        }
        space->renew(session.share(0.8));
        const std::optional<proof::SymbolicFacts> facts = space->facts();
        if (facts.has_value()) {
            tell({facts->states.decimal(), facts->edges.decimal(),
                  std::to_string(facts->max_in_marking), std::to_string(facts->max_in_place)},
                 "DECISION_DIAGRAMS");
        }
        return facts.has_value();
    };
    if (by_diagrams(session.quick_symbolic())) {
        return answers;
    }
    const proof::Exploration e = proof::explore(session.plain(), {}, session.share(0.6));
    if (e.ended == Ended::kDone && e.complete) {
        tell({std::to_string(e.states), std::to_string(e.edges),
              std::to_string(e.max_tokens_per_marking), std::to_string(e.max_tokens_in_place)},
             "EXPLICIT STATE_COMPRESSION");
        return answers;
    }
    by_diagrams(session.symbolic(0.9));
    return answers;
}

// All goals reachable: kTrue; one for certain not: kFalse.
Decision all_reachable(ContestSession& session, std::span<const Predicate> goals) {
    Decision result{Truth::kTrue, "TOPOLOGICAL"};
    for (const Decision& d : decide_reachable(session, goals)) {
        if (d.truth == Truth::kFalse) {
            return d;
        }
        if (d.truth == Truth::kUnknown || result.truth == Truth::kTrue) {
            result = d;
        }
    }
    return result;
}

// Where each transition may fire: its arcs allow it, and nobody of a higher level is enabled.
std::vector<Predicate> each_may_fire(const proof::PlainNet& net) {
    std::vector<Predicate> goals;
    for (std::uint32_t t = 0; t < net.transition_count(); ++t) {
        std::vector<std::uint32_t> above;
        for (std::uint32_t u = 0; net.has_levels && u < net.transition_count(); ++u) {
            if (net.level[u] > net.level[t]) {
                above.push_back(u);
            }
        }
        const Predicate both[] = {Predicate::enabled({t}),
                                  Predicate::enabled(std::move(above)).negated()};
        goals.push_back(Predicate::all_of(both));
    }
    return goals;
}

Decision one_safe(ContestSession& session) {
    std::vector<Predicate> more;
    for (std::uint32_t p = 0; p < session.plain().place_count(); ++p) {
        more.push_back(Predicate::at_least({{{p, 1}}}, 2));
    }
    const Predicate goals[] = {Predicate::any_of(more)};
    Decision d = decide_reachable(session, goals)[0];
    d.truth = proof::opposite(d.truth);
    return d;
}

// Some place never changes.
Decision stable_marking(ContestSession& session) {
    const proof::PlainNet& net = session.plain();
    std::vector<Predicate> changes;
    for (std::uint32_t p = 0; p < net.place_count(); ++p) {
        const std::int64_t count = net.initial[p];
        const Predicate either[] = {Predicate::at_least({{{p, 1}}}, count + 1),
                                    Predicate::at_most({{{p, 1}}}, count - 1)};
        changes.push_back(Predicate::any_of(either));
    }
    Decision d = all_reachable(session, changes);
    d.truth = proof::opposite(d.truth);
    return d;
}

// Live: in every bottom component of the graph every transition fires.
Decision live_by_graph(ContestSession& session, const proof::Budget& budget) {
    const proof::PlainNet& net = session.plain();
    const proof::PlainGraph made = proof::build_graph(net, {}, nullptr, budget);
    if (made.graph.ended != Ended::kDone) {
        return {};
    }
    const proof::Graph& graph = made.graph;
    const proof::StrongComponents components = proof::strong_components(graph);
    const proof::StateBits bottoms = proof::bottom_components(graph, components);
    std::vector<std::uint32_t> number(components.count, 0);
    std::uint32_t count = 0;
    bottoms.for_each([&](std::uint32_t c) { number[c] = count++; });
    // Per bottom component, the transitions that fire in it.
    const std::uint64_t transitions = net.transition_count();
    std::vector<std::uint32_t> missing(count, net.transition_count());
    proof::StateBits fires(static_cast<std::uint32_t>(
        std::min<std::uint64_t>(count * transitions, std::uint64_t{1} << 31)));
    if (count * transitions > fires.size()) {
        return {};
    }
    for (std::uint32_t s = 0; s < graph.size(); ++s) {
        const std::uint32_t c = components.of[s];
        if (!bottoms[c]) {
            continue;
        }
        for (const proof::Edge& e : graph.edges.row(s)) {
            const auto i = static_cast<std::uint32_t>(number[c] * transitions + e.label);
            if (!fires[i]) {
                fires.add(i);
                --missing[number[c]];
            }
        }
    }
    const bool live =
        std::all_of(missing.begin(), missing.end(), [](std::uint32_t m) { return m == 0; });
    return {proof::truth_of(live), "EXPLICIT STATE_COMPRESSION"};
}

Decision live_by_diagrams(ContestSession& session, proof::SymbolicSpace* space, double fraction) {
    if (space == nullptr) {
        return {};
    }
    space->renew(session.share(fraction));
    for (std::uint32_t t = 0; t < session.plain().transition_count(); ++t) {
        const std::optional<bool> live = space->live(t);
        if (!live.has_value()) {
            return {};
        }
        if (!*live) {
            return {Truth::kFalse, "DECISION_DIAGRAMS"};
        }
    }
    return {Truth::kTrue, "DECISION_DIAGRAMS"};
}

Decision liveness(ContestSession& session) {
    const proof::PlainNet& net = session.plain();
    const proof::StructuralLiveness by_theorem =
        proof::structural_liveness(net, session.share(0.1, 1));
    if (by_theorem.live || by_theorem.not_live || net.transition_count() == 0) {
        return {proof::truth_of(!by_theorem.not_live), "TOPOLOGICAL"};
    }
    // Where nothing can fire any more, or something never could, the net is not live.
    const Predicate dead[] = {Predicate::no_successor(net)};
    const Decision quick = decide_reachable_quickly(session, dead)[0];
    if (quick.truth == Truth::kTrue) {
        return {Truth::kFalse, quick.techniques};
    }
    for (const Decision& d : decide_reachable_quickly(session, each_may_fire(net))) {
        if (d.truth == Truth::kFalse) {
            return d;
        }
    }
    Decision result = live_by_diagrams(session, session.quick_symbolic(), 0.1);
    if (result.truth == Truth::kUnknown && !session.too_many_to_visit()) {
        proof::Budget budget = session.share(0.6);
        budget.states = ContestSession::kVisited;
        result = live_by_graph(session, budget);
    }
    if (result.truth == Truth::kUnknown) {
        result = live_by_diagrams(session, session.symbolic(0.7), 1);
    }
    return result;
}

}  // namespace

std::vector<ContestAnswer> answer_examination(const net::Net& net, Examination examination,
                                              const proof::Budget& budget) {
    ContestSession session(net, budget);
    ContestAnswer answer;
    answer.id = name_of(examination);
    if (!session.fits()) {
        answer.reason = session.why_not();
        return {answer};
    }
    Decision decision;
    switch (examination) {
        case Examination::kStateSpace:
            return state_space(session);
        case Examination::kReachabilityDeadlock:
            decision = decide_dead(session);
            break;
        case Examination::kQuasiLiveness:
            decision = all_reachable(session, each_may_fire(session.plain()));
            break;
        case Examination::kLiveness:
            decision = liveness(session);
            break;
        case Examination::kOneSafe:
            decision = one_safe(session);
            break;
        case Examination::kStableMarking:
            decision = stable_marking(session);
            break;
    }
    if (decision.truth == Truth::kUnknown) {
        answer.reason = "the budget ended";
    } else {
        answer.value = decision.truth == Truth::kTrue ? "TRUE" : "FALSE";
        answer.techniques = decision.techniques;
    }
    return {answer};
}

}  // namespace puppetri::verdict
