// SPDX-License-Identifier: MIT
// From queries to questions that the methods know, and back to answers in the contest's form.
#include "puppetri/verdict/contest.h"

#include <utility>

#include "plain_session.h"
#include "puppetri/net/draft.h"

namespace puppetri::verdict {

namespace {

using net::FormulaOp;
using proof::Truth;

// Indices of drafts become those of the compiled net.
std::uint32_t moved_place(const net::Net& net, std::uint32_t p) {
    return net.place_of_draft({p}).value;
}
void to_net(const net::Net& net, Expr& e) {
    e.rename_slots([&](Slot slot) {
        if (slot.kind == static_cast<std::uint32_t>(net::SlotKind::kCount) ||
            slot.kind == static_cast<std::uint32_t>(net::SlotKind::kReady)) {
            slot.index = moved_place(net, slot.index);
        }
        return slot;
    });
}
net::Formula to_net(const net::Net& net, net::Formula f) {
    for (net::Formula::Node& n : f.nodes) {
        if (n.op == FormulaOp::kMarked || n.op == FormulaOp::kReady) {
            n.index = moved_place(net, n.index);
        } else if (n.op == FormulaOp::kFireable || n.op == FormulaOp::kFires) {
            n.index = net.transition_of_draft({n.index}).value;
        }
    }
    for (Expr& e : f.expressions) {
        to_net(net, e);
    }
    return f;
}

// A sum and a constant: bounds of places are sums of counts.
std::optional<proof::LinearSum> bound_of(const net::Net& net, const Expr& bound) {
    Expr e = bound;
    to_net(net, e);
    return proof::linear_sum_of(net, e);
}

class Answering {
 public:
    Answering(PlainSession& session, std::span<const ContestQuery> queries, AnswerSink sink)
        : session_(session), queries_(queries), sink_(sink), answers_(queries.size()) {
        for (std::size_t i = 0; i < queries.size(); ++i) {
            answers_[i].id = queries[i].id;
        }
    }

    std::vector<ContestAnswer> run() {
        if (!session_.fits()) {
            for (std::size_t i = 0; i < answers_.size(); ++i) {
                answers_[i].reason = session_.why_not();
                tell(i);
            }
            return std::move(answers_);
        }
        reachability();
        bounds();
        logic();
        return std::move(answers_);
    }

 private:
    void tell(std::size_t i) {
        if (answers_[i].value.empty() && answers_[i].reason.empty()) {
            answers_[i].reason = "the budget ended";
        }
        if (sink_.take != nullptr) {
            sink_.take(sink_.context, answers_[i]);
        }
    }
    void settle(std::size_t i, Truth truth, How how) {
        if (truth != Truth::kUnknown) {
            answers_[i].value = truth == Truth::kTrue ? "TRUE" : "FALSE";
            answers_[i].techniques = techniques_of(how);
        }
        tell(i);
    }
    void refuse(std::size_t i, const char* reason) {
        answers_[i].reason = reason;
        tell(i);
    }

    void reachability() {
        std::vector<proof::Predicate> goals;
        std::vector<std::pair<std::size_t, bool>> meaning;
        for (std::size_t i = 0; i < queries_.size(); ++i) {
            if (queries_[i].kind != QueryKind::kReachability) {
                continue;
            }
            net::Formula f = to_net(session_.net(), queries_[i].formula);
            const bool exists = f.nodes.back().op == FormulaOp::kSomeFinally;
            f.nodes.resize(f.nodes.back().a + std::size_t{1});  // the operand is its root
            std::optional<proof::Predicate> goal = proof::predicate_of(session_.net(), f);
            if (!goal.has_value()) {
                refuse(i, "not a question about counts and fireability");
                continue;
            }
            goals.push_back(exists ? std::move(*goal) : goal->negated());
            meaning.emplace_back(i, exists);
        }
        if (goals.empty()) {
            return;
        }
        const std::vector<Decision> reached = decide_reachable(session_, goals);
        for (std::size_t k = 0; k < goals.size(); ++k) {
            const auto [i, exists] = meaning[k];
            settle(i, exists ? reached[k].truth : proof::opposite(reached[k].truth),
                   reached[k].how);
        }
    }

    void bounds() {
        std::vector<proof::LinearSum> sums;
        std::vector<std::size_t> of;
        for (std::size_t i = 0; i < queries_.size(); ++i) {
            if (queries_[i].kind != QueryKind::kUpperBound) {
                continue;
            }
            std::optional<proof::LinearSum> sum = bound_of(session_.net(), queries_[i].bound);
            if (!sum.has_value()) {
                refuse(i, "not a sum of counts");
                continue;
            }
            sums.push_back(std::move(*sum));
            of.push_back(i);
        }
        if (sums.empty()) {
            return;
        }
        const std::vector<Maximum> maxima = decide_maxima(session_, sums);
        for (std::size_t k = 0; k < sums.size(); ++k) {
            if (maxima[k].value.has_value()) {
                answers_[of[k]].value = std::to_string(*maxima[k].value);
                answers_[of[k]].techniques = techniques_of(maxima[k].how);
            }
            tell(of[k]);
        }
    }

    void logic() {
        std::vector<LogicQuestion> questions;
        std::vector<std::size_t> of;
        for (std::size_t i = 0; i < queries_.size(); ++i) {
            if (queries_[i].kind != QueryKind::kCtl && queries_[i].kind != QueryKind::kLtl) {
                continue;
            }
            net::Formula f = to_net(session_.net(), queries_[i].formula);
            if (exists(i)) {  // some path: not all paths violate it
                f = net::Formula::unary(FormulaOp::kNot, std::move(f));
            }
            LogicQuestion q;
            q.formula = proof::taken_apart(f);
            for (const net::Formula& atom : q.formula.atoms) {
                if (std::optional<proof::Predicate> p = proof::predicate_of(session_.net(), atom)) {
                    q.atoms.push_back(std::move(*p));
                }
            }
            if (q.formula.logic == proof::Temporal::Logic::kNeither) {
                refuse(i, "neither CTL nor LTL");
            } else if (q.atoms.size() != q.formula.atoms.size()) {
                refuse(i, "not a question about counts and fireability");
            } else {
                questions.push_back(std::move(q));
                of.push_back(i);
            }
        }
        if (questions.empty()) {
            return;
        }
        const std::vector<Decision> decisions = decide_logic(session_, questions);
        for (std::size_t k = 0; k < of.size(); ++k) {
            const Truth truth = decisions[k].truth;
            settle(of[k], exists(of[k]) ? proof::opposite(truth) : truth, decisions[k].how);
        }
    }

    bool exists(std::size_t i) const {
        return queries_[i].kind == QueryKind::kLtl && queries_[i].exists;
    }

    PlainSession& session_;
    std::span<const ContestQuery> queries_;
    AnswerSink sink_;
    std::vector<ContestAnswer> answers_;
};

}  // namespace

const char* name_of(Examination examination) {
    switch (examination) {
        case Examination::kStateSpace:
            return "StateSpace";
        case Examination::kReachabilityDeadlock:
            return "ReachabilityDeadlock";
        case Examination::kQuasiLiveness:
            return "QuasiLiveness";
        case Examination::kLiveness:
            return "Liveness";
        case Examination::kOneSafe:
            return "OneSafe";
        case Examination::kStableMarking:
            return "StableMarking";
    }
    return "";
}

std::string contest_line(const ContestAnswer& answer) {
    if (answer.value.empty()) {
        return "CANNOT_COMPUTE";
    }
    for (const char* count :
         {"STATES", "TRANSITIONS", "MAX_TOKEN_PER_MARKING", "MAX_TOKEN_IN_PLACE"}) {
        if (answer.id == count) {
            return "STATE_SPACE " + answer.id + " " + answer.value + " TECHNIQUES " +
                   answer.techniques;
        }
    }
    return "FORMULA " + answer.id + " " + answer.value + " TECHNIQUES " + answer.techniques;
}

std::vector<ContestAnswer> answer_queries(const net::Net& net,
                                          std::span<const ContestQuery> queries,
                                          const proof::Budget& budget, AnswerSink sink) {
    PlainSession session(net, budget);
    return Answering(session, queries, sink).run();
}

}  // namespace puppetri::verdict
