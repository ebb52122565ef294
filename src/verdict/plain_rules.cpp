// SPDX-License-Identifier: MIT
#include "plain_rules.h"

#include <algorithm>
#include <utility>

#include "bad_markings.h"
#include "puppetri/proof/coverability.h"

namespace puppetri::verdict {

using net::Formula;
using net::FormulaOp;
using net::RuleKind;
using proof::Predicate;

using Target = Finding::Target;

namespace {

PlainFinding unknown(std::string reason = {}) {
    PlainFinding f;
    f.reason = std::move(reason);
    return f;
}

PlainFinding proved(How how, Force force = Force::kPlain) {
    PlainFinding f;
    f.answer = Answer::kProved;
    f.force = force;
    f.how = how;
    return f;
}

PlainFinding refuted(How how, std::string reason, Firings run, Target target) {
    PlainFinding f;
    f.answer = Answer::kRefuted;
    f.how = how;
    f.reason = std::move(reason);
    f.run = std::move(run);
    f.target = target;
    return f;
}

}  // namespace

PlainRules::PlainRules(const net::Net& net, const HostLowering* host, const proof::Budget& budget)
    : net_(net), host_(host), budget_(budget), session_(net, budget_) {}

std::string PlainRules::name(std::uint32_t transition) const {
    return std::string(net_.transition(net::TransitionIndex{transition}).path);
}

std::vector<std::uint32_t> PlainRules::transitions_of(const net::Rule& rule) const {
    std::vector<std::uint32_t> list;
    for (const net::TransitionIndex t : rule.transitions) {
        list.push_back(t.value);
    }
    for (std::uint32_t t = 0; rule.transitions.empty() && t < net_.transition_count(); ++t) {
        list.push_back(t);
    }
    return list;
}

PlainFinding PlainRules::decide(const net::Rule& rule) {
    switch (rule.kind) {
        case RuleKind::kNever:
        case RuleKind::kAlways:
        case RuleKind::kMutex:
        case RuleKind::kExactlyOne:
        case RuleKind::kOnlyIf:
            return every_state(rule);
        case RuleKind::kBounded:
            return rule.count != kNoCount ? every_state(rule) : bounded();
        case RuleKind::kPossible:
            return possible(rule);
        case RuleKind::kDeadlockFree:
            return deadlock_free();
        case RuleKind::kQuasiLive:
            return quasi_live(rule);
        case RuleKind::kLive:
        case RuleKind::kReversible:
            return stays_possible(rule);
        case RuleKind::kEnds:
            return ends();
        case RuleKind::kFormula:
            return formula(rule);
        default:
            return unknown();
    }
}

PlainFinding PlainRules::every_state(const net::Rule& rule) {
    const bool only_proof = !exact() || rule.when_settled || about_figures(rule);
    std::optional<std::vector<Predicate>> cases = bad_markings(net_, rule, host_, true);
    const bool exactly = cases.has_value() && !only_proof;
    if (!cases) {
        cases = bad_markings(net_, rule, host_, false);
    }
    if (!cases) {
        return unknown();
    }
    // Whether what it begins with ever happens is asked in the same go.
    std::vector<Predicate> goals = {Predicate::any_of(*cases)};
    const bool conditional = rule.kind == RuleKind::kOnlyIf, mutex = rule.kind == RuleKind::kMutex;
    for (std::size_t i = 0; exactly && i < rule.operands.size() && (mutex || i == 0); ++i) {
        Formula f = rule.operands[i];
        if (conditional && f.nodes.size() == 1 && f.nodes[0].op == FormulaOp::kFires) {
            f.nodes[0].op = FormulaOp::kFireable;
        }
        if (conditional || mutex) {
            if (auto p = proof::predicate_of(net_, f)) {
                goals.push_back(std::move(*p));
            }
        }
    }
    const std::vector<Decision> reached = decide_reachable(session_, goals);
    if (reached[0].truth == proof::Truth::kFalse) {
        PlainFinding f = proved(reached[0].how);
        std::size_t silent = 0;
        for (std::size_t i = 1; i < reached.size(); ++i) {
            silent += reached[i].truth == proof::Truth::kFalse ? 1 : 0;
        }
        if (conditional && silent == 1) {
            f.notes.push_back("vacuous: what the rule begins with never happens");
        } else if (mutex && exactly && silent + 1 >= rule.operands.size()) {
            f.notes.push_back("vacuous: at most one of them ever happens");
        }
        return f;
    }
    if (reached[0].truth == proof::Truth::kUnknown || !exactly) {
        return unknown();
    }
    Firings way = way_to(session_, goals[0]);
    if (way && conditional && rule.operands[0].nodes.size() == 1 &&
        rule.operands[0].nodes[0].op == FormulaOp::kFires) {
        way->push_back(rule.operands[0].nodes[0].index);
    }
    return refuted(reached[0].how, how_broken(rule.kind), std::move(way), Target::kBroken);
}

PlainFinding PlainRules::possible(const net::Rule& rule) {
    const std::optional<Predicate> goal =
        proof::predicate_of(net_, lowered(rule.operands[0], host_).may);
    if (!goal) {
        return unknown();
    }
    const Decision reached = decide_reachable(session_, {&*goal, 1})[0];
    if (reached.truth == proof::Truth::kFalse) {
        return refuted(reached.how, "no run of the net gets there, whatever its timing",
                       std::nullopt, Target::kBroken);
    }
    if (reached.truth == proof::Truth::kUnknown || !exact() || rule.when_settled ||
        about_figures(rule)) {
        return unknown();
    }
    PlainFinding f = proved(reached.how);
    f.run = way_to(session_, *goal);
    return f;
}

PlainFinding PlainRules::bounded() {
    const proof::BoundednessAnswer answer =
        proof::boundedness(session_.plain(), session_.share(0.2));
    if (answer.kind == proof::BoundednessAnswer::kBounded) {
        return proved(How::kStructure);
    }
    if (answer.kind == proof::BoundednessAnswer::kUnbounded && exact()) {
        // The pump may be repeated for ever, since nothing that it changes forbids it.
        std::vector<std::uint32_t> run = answer.prefix;
        run.insert(run.end(), answer.pump.begin(), answer.pump.end());
        std::string cycle;
        for (const std::uint32_t t : answer.pump) {
            if (cycle.size() < 200) {
                cycle += (cycle.empty() ? "" : ", ") + name(t);
            }
        }
        PlainFinding f =
            refuted(How::kStructure,
                    "place " + std::string(net_.place(net::PlaceIndex{answer.place}).path) +
                        " grows without end: after " + std::to_string(answer.prefix.size()) +
                        " firings, " + cycle + " can be repeated for ever and adds to it",
                    std::move(run), Target::kHopeless);
        return f;
    }
    if (session_.quick_symbolic() != nullptr) {  // it holds every marking
        return proved(How::kDiagrams);
    }
    return unknown();
}

PlainFinding PlainRules::deadlock_free() {
    const std::optional<Predicate> final = proof::final_markings(net_);
    if (!exact() || !final) {
        return unknown();
    }
    const Decision dead = decide_dead(session_, *final);
    if (dead.truth == proof::Truth::kFalse) {
        return proved(dead.how);
    }
    if (dead.truth == proof::Truth::kUnknown) {
        return unknown();
    }
    return refuted(dead.how, "everything may come to rest where no end is declared",
                   way_to_death(session_, *final), Target::kRest);
}

PlainFinding PlainRules::quasi_live(const net::Rule& rule) {
    const Outlook o = decide_quasi_live(session_, transitions_of(rule));
    if (o.decision.truth == proof::Truth::kFalse) {
        return refuted(o.decision.how, name(o.transition) + " never fires, whatever the timing",
                       std::nullopt, Target::kFires);
    }
    return o.decision.truth == proof::Truth::kTrue && exact() ? proved(o.decision.how) : unknown();
}

PlainFinding PlainRules::stays_possible(const net::Rule& rule) {
    if (!exact()) {
        return unknown();
    }
    const bool live = rule.kind == RuleKind::kLive;
    Outlook o =
        live ? decide_live(session_, transitions_of(rule), true) : decide_reversible(session_);
    if (o.decision.truth == proof::Truth::kUnknown) {
        return unknown();
    }
    if (o.decision.truth == proof::Truth::kTrue) {
        return proved(o.decision.how);
    }
    const std::string what = live ? "firing " + name(o.transition) : "the start";
    return refuted(o.decision.how, what + " can become impossible for ever", std::move(o.out),
                   Target::kHopeless);
}

PlainFinding PlainRules::ends() {
    const std::optional<Predicate> final = proof::final_markings(net_);
    if (!exact() || !final) {
        return unknown();
    }
    Outlook o = decide_ends(session_, *final);
    if (o.decision.truth == proof::Truth::kUnknown) {
        return unknown();
    }
    if (o.decision.truth == proof::Truth::kFalse) {
        return refuted(o.decision.how, "the end gets out of reach", std::move(o.out),
                       Target::kHopeless);
    }
    PlainFinding f =
        proved(o.decision.how, o.unlucky ? Force::kProbabilityOne : Force::kEveryChoice);
    if (o.unlucky) {
        f.notes.push_back(
            "REFUTED only ever-unlucky ties (probability 0) go round for ever without an end");
    }
    return f;
}

PlainFinding PlainRules::formula(const net::Rule& rule) {
    LogicQuestion q;
    q.formula = proof::taken_apart(rule.operands[0]);
    for (const Formula& atom : q.formula.atoms) {
        std::optional<Predicate> p = proof::predicate_of(net_, atom);
        if (!p) {
            return unknown();
        }
        q.atoms.push_back(std::move(*p));
    }
    if (!exact() || q.formula.logic == proof::Temporal::Logic::kNeither) {
        return unknown();
    }
    const bool linear = q.formula.logic == proof::Temporal::Logic::kLtl;
    // Where a net is dead the portfolio has no next step, as the contest means it; here it stands.
    if (!linear && q.formula.has_next && decide_dead(session_).truth != proof::Truth::kFalse) {
        return unknown();
    }
    const Decision d = decide_logic(session_, {&q, 1})[0];
    if (d.truth == proof::Truth::kUnknown) {
        return unknown();
    }
    if (d.truth == proof::Truth::kTrue) {
        return proved(d.how, linear ? Force::kEveryChoice : Force::kPlain);
    }
    PlainFinding f = refuted(
        d.how,
        linear ? "a run does not satisfy the formula" : "the formula does not hold at the start",
        std::nullopt, Target::kHopeless);
    f.branches = !linear;
    const std::optional<AsReachability> simple = as_reachability(q);
    if (simple && !simple->value_if_reached) {
        f.run = way_to(session_, simple->goal);
    } else if (linear) {
        if (std::optional<proof::SymbolicLasso> lasso = run_against(session_, q)) {
            f.lasso_from =
                lasso->loop.empty() ? kFar : static_cast<std::uint32_t>(lasso->stem.size());
            f.run = std::move(lasso->stem);
            f.run->insert(f.run->end(), lasso->loop.begin(), lasso->loop.end());
        }
    }
    return f;
}

}  // namespace puppetri::verdict
