// SPDX-License-Identifier: MIT
// Questions of branching and linear time: on the graph of markings where it can be made, else on
// decision diagrams.
#include <algorithm>
#include <atomic>
#include <utility>

#include "parallel.h"
#include "plain_session.h"
#include "puppetri/base/require.h"
#include "puppetri/proof/buechi.h"
#include "puppetri/proof/ctl.h"
#include "puppetri/proof/explorer.h"
#include "puppetri/proof/ltl.h"

namespace puppetri::verdict {

namespace {

using proof::Predicate;
using proof::StateSet;
using proof::Temporal;
using proof::Truth;
using Op = Temporal::Op;

bool is_linear(const Temporal& t) { return t.logic == Temporal::Logic::kLtl; }

// CTL on sets of markings.
std::optional<bool> branching_by_diagrams(proof::SymbolicSpace& space, const LogicQuestion& q) {
    std::vector<StateSet> sets;
    for (const Temporal::Node& n : q.formula.nodes) {
        switch (n.op) {
            case Op::kFalse:
                sets.push_back(space.none());
                break;
            case Op::kTrue:
                sets.push_back(space.all());
                break;
            case Op::kAtom:
                sets.push_back(space.satisfying(q.atoms[n.index]));
                break;
            case Op::kNot:
                sets.push_back(space.complement(sets[n.a]));
                break;
            case Op::kAnd:
                sets.push_back(space.both(sets[n.a], sets[n.b]));
                break;
            case Op::kOr:
                sets.push_back(space.either(sets[n.a], sets[n.b]));
                break;
            case Op::kSomeNext:
                sets.push_back(space.ex(sets[n.a]));
                break;
            case Op::kSomeGlobally:
                sets.push_back(space.eg(sets[n.a]));
                break;
            case Op::kSomeUntil:
                sets.push_back(space.eu(sets[n.a], sets[n.b]));
                break;
            case Op::kNext:
            case Op::kUntil:
            case Op::kRelease:
                return std::nullopt;
        }
        if (!sets.back().known()) {
            return std::nullopt;
        }
    }
    return space.holds_initially(sets.back());
}

// What violates a formula of linear time.
std::optional<proof::SymbolicAutomaton> violations(proof::SymbolicSpace& space,
                                                   const LogicQuestion& q) {
    const std::optional<proof::Buechi> wrong = proof::automaton_of(q.formula, true);
    if (!wrong.has_value()) {
        return std::nullopt;
    }
    proof::SymbolicAutomaton automaton;
    automaton.states = wrong->size();
    automaton.acceptance_sets = wrong->acceptance_sets;
    automaton.initial = wrong->initial;
    std::vector<StateSet> holds, fails;
    for (const Predicate& atom : q.atoms) {
        holds.push_back(space.satisfying(atom));
        fails.push_back(space.complement(holds.back()));
    }
    for (std::uint32_t from = 0; from < wrong->size(); ++from) {
        for (const proof::Buechi::Edge& e : wrong->edges.row(from)) {
            StateSet guard = space.all();
            for (std::uint32_t i = 0; i < q.atoms.size(); ++i) {
                if ((e.positive >> i & 1) != 0) {
                    guard = space.both(guard, holds[i]);
                }
                if ((e.negative >> i & 1) != 0) {
                    guard = space.both(guard, fails[i]);
                }
            }
            automaton.edges.push_back({from, e.target, std::move(guard), e.accepts});
        }
    }
    return automaton;
}

std::optional<bool> linear_by_diagrams(proof::SymbolicSpace& space, const LogicQuestion& q) {
    const std::optional<proof::SymbolicAutomaton> wrong = violations(space, q);
    const std::optional<bool> violated = wrong ? space.accepts(*wrong) : std::nullopt;
    return violated.has_value() ? std::optional(!*violated) : std::nullopt;
}

class Logic {
 public:
    Logic(PlainSession& session, std::span<const LogicQuestion> questions)
        : session_(session), questions_(questions), decisions_(questions.size()) {}

    std::vector<Decision> run() {
        by_reachability(decide_reachable_quickly);
        // A part of the graph shows many a counterexample, and small graphs are done with it.
        by_graph(0.2, kGlance);
        if (!open().empty()) {
            by_diagrams(session_.quick_symbolic(), 0.02, 1);
        }
        if (!open().empty() && !session_.too_many_to_visit()) {
            by_graph(0.3, kSome);
        }
        // A machine that was busy may have kept the quick look from an answer.
        if (!open().empty() && !session_.out_of_time()) {
            by_diagrams(session_.symbolic(0.2), 0.1, 1e9);
        }
        if (!open().empty() && !session_.too_many_to_visit()) {
            by_graph(0.6, PlainSession::kVisited);
        }
        if (!open().empty() && !session_.out_of_time()) {
            // Two rounds, so that one hard question does not eat the time of all.
            proof::SymbolicSpace* space = session_.symbolic(0.4);
            by_diagrams(space, 0.1, 1e9);
            by_diagrams(space, 0.5, 1e9);
        }
        by_reachability(decide_reachable);
        return std::move(decisions_);
    }

 private:
    std::vector<std::uint32_t> open() const {
        std::vector<std::uint32_t> list;
        for (std::uint32_t i = 0; i < decisions_.size(); ++i) {
            if (decisions_[i].truth == Truth::kUnknown) {
                list.push_back(i);
            }
        }
        return list;
    }

    void by_reachability(std::vector<Decision> (*decide)(PlainSession&,
                                                         std::span<const Predicate>)) {
        std::vector<Predicate> goals;
        std::vector<std::pair<std::uint32_t, bool>> meaning;
        for (const std::uint32_t i : open()) {
            if (std::optional<AsReachability> r = as_reachability(questions_[i])) {
                goals.push_back(std::move(r->goal));
                meaning.emplace_back(i, r->value_if_reached);
            }
        }
        if (goals.empty()) {
            return;
        }
        const std::vector<Decision> reached = decide(session_, goals);
        for (std::size_t k = 0; k < goals.size(); ++k) {
            const auto [i, value_if_reached] = meaning[k];
            decisions_[i] = reached[k];
            if (!value_if_reached) {
                decisions_[i].truth = proof::opposite(reached[k].truth);
            }
        }
    }

    static constexpr std::uint64_t kGlance = 100'000, kSome = 3'000'000;  // states

    void by_graph(double fraction, std::uint64_t states) {
        const std::vector<std::uint32_t> open_now = open();
        if (open_now.empty()) {
            return;
        }
        std::vector<Predicate> atoms;
        std::vector<std::vector<std::uint32_t>> atoms_of(questions_.size());
        for (const std::uint32_t i : open_now) {
            for (const Predicate& atom : questions_[i].atoms) {
                atoms_of[i].push_back(static_cast<std::uint32_t>(atoms.size()));
                atoms.push_back(proof::simplified(atom, session_.plain(), session_.bounds()));
            }
        }
        proof::Budget budget = session_.share(fraction);
        budget.states = states;
        budget.bytes = budget.bytes / 5 * 3;  // the rest for predecessors and labels
        const proof::PlainGraph made = proof::build_graph(session_.plain(), atoms, nullptr, budget);
        const proof::Graph& graph = made.graph;
        if (graph.ended != proof::Ended::kDone && states > kGlance) {
            return;  // a part shows what a glance has shown already, at a greater cost
        }
        const net::Rows<std::uint32_t> backwards =
            std::any_of(open_now.begin(), open_now.end(),
                        [&](std::uint32_t i) { return !is_linear(questions_[i].formula); })
                ? proof::predecessors(graph)
                : net::Rows<std::uint32_t>();
        std::atomic<std::uint32_t> next{0};
        in_parallel(session_.threads(), [&](unsigned thread) {
            proof::CtlChecker checker(graph, backwards);
            for (;;) {
                const std::uint32_t k = next.fetch_add(1);
                if (k >= open_now.size()) {
                    return;
                }
                const std::uint32_t i = open_now[k];
                proof::Budget rest = session_.share(fraction);
                if (thread != 0) {
                    rest.progress = nullptr;  // one tells for all
                }
                const Temporal& formula = questions_[i].formula;
                const Truth truth =
                    is_linear(formula)
                        ? proof::check_ltl(graph, formula, atoms_of[i], rest, false).holds
                        : checker.holds(formula, atoms_of[i], rest);
                decisions_[i] = {truth, How::kExploration};
            }
        });
    }

    // Each question gets a share of the time that is left, and at most so many seconds.
    void by_diagrams(proof::SymbolicSpace* space, double fraction, double most) {
        if (space == nullptr) {
            return;
        }
        for (const std::uint32_t i : open()) {
            space->renew(session_.share(fraction, most));
            const LogicQuestion& q = questions_[i];
            const std::optional<bool> holds = is_linear(q.formula)
                                                  ? linear_by_diagrams(*space, q)
                                                  : branching_by_diagrams(*space, q);
            if (holds.has_value()) {
                decisions_[i] = {proof::truth_of(*holds), How::kDiagrams};
            }
        }
    }

    PlainSession& session_;
    std::span<const LogicQuestion> questions_;
    std::vector<Decision> decisions_;
};

}  // namespace

std::optional<AsReachability> as_reachability(const LogicQuestion& q) {
    const auto& nodes = q.formula.nodes;
    bool value = true;
    auto at = static_cast<std::uint32_t>(nodes.size()) - 1;
    while (nodes[at].op == Op::kNot) {
        value = !value;
        at = nodes[at].a;
    }
    // The operand: an atom or its negation.
    const auto literal = [&](std::uint32_t i) -> std::optional<Predicate> {
        if (nodes[i].op == Op::kAtom) {
            return q.atoms[nodes[i].index];
        }
        if (nodes[i].op == Op::kNot && nodes[nodes[i].a].op == Op::kAtom) {
            return q.atoms[nodes[nodes[i].a].index].negated();
        }
        return std::nullopt;
    };
    if (nodes[at].op == Op::kSomeUntil && nodes[nodes[at].a].op == Op::kTrue) {
        if (std::optional<Predicate> goal = literal(nodes[at].b)) {
            return AsReachability{std::move(*goal), value};
        }
    }
    if (value && nodes[at].op == Op::kRelease && nodes[nodes[at].a].op == Op::kFalse) {
        if (std::optional<Predicate> kept = literal(nodes[at].b)) {
            return AsReachability{kept->negated(), false};
        }
    }
    return std::nullopt;
}

std::optional<proof::SymbolicLasso> run_against(PlainSession& session,
                                                const LogicQuestion& question) {
    proof::SymbolicSpace* space = session.symbolic(0.5);
    if (space == nullptr) {
        return std::nullopt;
    }
    space->renew(session.share(0.8));
    const std::optional<proof::SymbolicAutomaton> wrong = violations(*space, question);
    return wrong ? space->lasso(*wrong) : std::nullopt;
}

std::vector<Decision> decide_logic(PlainSession& session,
                                   std::span<const LogicQuestion> questions) {
    return Logic(session, questions).run();
}

}  // namespace puppetri::verdict
