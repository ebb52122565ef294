// SPDX-License-Identifier: MIT
// The examinations that need no file: each is a question, or a few, that other methods answer.
#include <numeric>
#include <utility>

#include "plain_session.h"
#include "puppetri/proof/explorer.h"

namespace puppetri::verdict {

namespace {

using proof::Ended;
using proof::Predicate;
using proof::Truth;

std::vector<ContestAnswer> state_space(PlainSession& session) {
    std::vector<ContestAnswer> answers(4);
    static const char* const kNames[] = {"STATES", "TRANSITIONS", "MAX_TOKEN_PER_MARKING",
                                         "MAX_TOKEN_IN_PLACE"};
    for (std::size_t i = 0; i < 4; ++i) {
        answers[i].id = kNames[i];
        answers[i].reason = "the budget ended";
    }
    const auto tell = [&](std::initializer_list<std::string> values, How how) {
        std::size_t i = 0;
        for (const std::string& value : values) {
            answers[i].value = value;
            answers[i].techniques = techniques_of(how);
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
                 How::kDiagrams);
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
             How::kExploration);
        return answers;
    }
    by_diagrams(session.symbolic(0.9));
    return answers;
}

Decision one_safe(PlainSession& session) {
    std::vector<Predicate> more;
    for (std::uint32_t p = 0; p < session.plain().place_count(); ++p) {
        more.push_back(Predicate::at_least({{{p, 1}}}, 2));
    }
    const Predicate goals[] = {Predicate::any_of(more)};
    Decision d = decide_reachable(session, goals)[0];
    d.truth = proof::opposite(d.truth);
    return d;
}

// All goals reachable: kTrue; one for certain not: kFalse.
Decision all_reachable(PlainSession& session, std::span<const Predicate> goals) {
    Decision result{Truth::kTrue, How::kStructure};
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

// Some place never changes.
Decision stable_marking(PlainSession& session) {
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

}  // namespace

std::vector<ContestAnswer> answer_examination(const net::Net& net, Examination examination,
                                              const proof::Budget& budget) {
    PlainSession session(net, budget);
    ContestAnswer answer;
    answer.id = name_of(examination);
    if (!session.fits()) {
        answer.reason = session.why_not();
        return {answer};
    }
    std::vector<std::uint32_t> transitions(session.plain().transition_count());
    std::iota(transitions.begin(), transitions.end(), 0u);
    Decision decision;
    switch (examination) {
        case Examination::kStateSpace:
            return state_space(session);
        case Examination::kReachabilityDeadlock:
            decision = decide_dead(session);
            break;
        case Examination::kQuasiLiveness:
            decision = decide_quasi_live(session, transitions).decision;
            break;
        case Examination::kLiveness:
            decision = decide_live(session, transitions, false).decision;
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
        answer.techniques = techniques_of(decision.how);
    }
    return {answer};
}

}  // namespace puppetri::verdict
