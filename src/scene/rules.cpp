// SPDX-License-Identifier: MIT
// Rules, questions and final markings, resolved to formulas of the net.
#include "elaboration.h"

namespace puppetri::scene {

using net::Formula;
using net::FormulaOp;

void Elaboration::complete_states() {
    for (std::uint32_t i = 0; i < states_.size(); ++i) {
        const StateElement& state = states_[i];
        Formula condition = state_formula(i);
        draft().states.push_back({.path = state.path,
                                  .caption = state.node->caption.text,
                                  .where = at(state.node->span),
                                  .condition = std::move(condition),
                                  .is_public = state.node->is_public});
    }
}

// Rules over places, transitions and actors take names, not statements.
void Elaboration::name_elements(const lang::Rule& node, const Scope& scope, net::Rule& out) {
    for (const lang::Expr& operand : node.operands) {
        const Term term = evaluate(operand, scope);
        if (is_nothing(term)) {
            continue;
        }
        if (node.kind == lang::RuleKind::kBounded) {
            if (const auto* p = std::get_if<PlaceTerm>(&term)) {
                out.operands.push_back(Formula::marked(p->place));
            } else {
                wrong(operand.span, "a place", term);
            }
        } else if (node.kind == lang::RuleKind::kNobodyFreezes) {
            if (const auto* actor = std::get_if<ActorTerm>(&term)) {
                out.operands.push_back(moves_of(actor->actor));
            } else {
                wrong(operand.span, "an actor", term);
            }
        } else {
            if (const auto* t = std::get_if<TransitionTerm>(&term)) {
                out.transitions.push_back(t->transition);
            } else {
                wrong(operand.span, "a transition", term);
            }
        }
    }
    if (node.kind == lang::RuleKind::kNobodyFreezes && node.operands.empty()) {
        for (std::uint32_t i = 0; i < scene.play.cast.actors.size(); ++i) {
            out.operands.push_back(moves_of({i}));
        }
    }
}

// True at each firing that begins a movement of this actor.
Formula Elaboration::moves_of(motion::ActorIndex actor) {
    std::optional<Formula> result;
    for (std::uint32_t i = 0; i < draft().transitions.size(); ++i) {
        bool begins = false;
        for (const net::OutputDraft& output : draft().transitions[i].outputs) {
            const net::ActionIndex action = places_[output.place.value].action;
            begins = begins || (action.valid() &&
                                scene.play.actions[action.value].call.subject.actor == actor);
        }
        if (begins) {
            Formula fires = Formula::fires({i});
            result = result ? Formula::binary(FormulaOp::kOr, std::move(*result), std::move(fires))
                            : std::move(fires);
        }
    }
    return result ? std::move(*result) : Formula::constant(false);
}

void Elaboration::complete_rule(const Element<lang::Rule>& rule) {
    struct Form {
        lang::RuleKind from;
        net::RuleKind to;
    };
    constexpr Form kForms[] = {
        {lang::RuleKind::kNever, net::RuleKind::kNever},
        {lang::RuleKind::kAlways, net::RuleKind::kAlways},
        {lang::RuleKind::kPossible, net::RuleKind::kPossible},
        {lang::RuleKind::kMutex, net::RuleKind::kMutex},
        {lang::RuleKind::kExactlyOne, net::RuleKind::kExactlyOne},
        {lang::RuleKind::kAlternate, net::RuleKind::kAlternate},
        {lang::RuleKind::kBounded, net::RuleKind::kBounded},
        {lang::RuleKind::kOnlyIf, net::RuleKind::kOnlyIf},
        {lang::RuleKind::kAfterNoUntil, net::RuleKind::kUntil},
        {lang::RuleKind::kLeadsTo, net::RuleKind::kLeadsTo},
        {lang::RuleKind::kTakesAtMost, net::RuleKind::kTakesAtMost},
        {lang::RuleKind::kDeadlockFree, net::RuleKind::kDeadlockFree},
        {lang::RuleKind::kReversible, net::RuleKind::kReversible},
        {lang::RuleKind::kEnds, net::RuleKind::kEnds},
        {lang::RuleKind::kLive, net::RuleKind::kLive},
        {lang::RuleKind::kQuasiLive, net::RuleKind::kQuasiLive},
        {lang::RuleKind::kNobodyFreezes, net::RuleKind::kNobodyFreezes},
        {lang::RuleKind::kCtl, net::RuleKind::kFormula},
        {lang::RuleKind::kLtl, net::RuleKind::kFormula},
    };
    const lang::Rule& node = *rule.node;
    net::Rule out{.path = rule.path, .caption = node.caption.text, .where = at(node.span)};
    for (const Form& form : kForms) {
        if (form.from == node.kind) {
            out.kind = form.to;
        }
    }
    out.when_settled = node.when_settled;
    if (node.kind == lang::RuleKind::kBounded && !node.bound) {
        out.count = -1;  // some limit, whatever it is
    }
    switch (node.kind) {
        case lang::RuleKind::kBounded:
        case lang::RuleKind::kLive:
        case lang::RuleKind::kQuasiLive:
        case lang::RuleKind::kNobodyFreezes:
            name_elements(node, rule.scope, out);
            break;
        case lang::RuleKind::kCtl:
        case lang::RuleKind::kLtl:
            for (const lang::Expr& operand : node.operands) {
                out.operands.push_back(
                    temporal_formula(operand, rule.scope, node.kind == lang::RuleKind::kLtl));
            }
            break;
        default:
            for (const lang::Expr& operand : node.operands) {
                out.operands.push_back(formula_of(operand, rule.scope));
            }
            break;
    }
    if (node.bound) {
        if (node.kind == lang::RuleKind::kBounded) {
            const auto k = constant_integer(node.bound, rule.scope, "a bound");
            out.count = k.value_or(1);
            if (k && *k < 0) {
                error("out-of-range", node.bound.span, "a bound is 0 or more", "write 1 or more");
            }
        } else if (const auto within =
                       constant_time(node.bound, rule.scope, "the time of a rule")) {
            out.within = *within;
            if (within->ticks < 0) {
                error("negative-time", node.bound.span, "the time of a rule is 0 or more",
                      "write a later one");
            }
        }
    }
    draft().rules.push_back(std::move(out));
}

void Elaboration::complete_rules() {
    std::set<std::string> names;
    for (const Element<lang::Rule>& rule : rules_) {
        About about(*this, "rule " + rule.path, rule.node->span);
        if (!names.insert(rule.path).second) {
            error("name-twice", rule.node->name.span, "there is already a rule " + rule.path,
                  "choose another name");
        }
        complete_rule(rule);
    }
    for (const Element<lang::Question>& question : questions_) {
        About about(*this, "question " + question.path, question.node->span);
        if (!names.insert(question.path).second) {
            error("name-twice", question.node->name.span,
                  "there is already a rule or question " + question.path, "choose another name");
        }
        complete_question(question);
    }
}

void Elaboration::complete_question(const Element<lang::Question>& question) {
    const lang::Question& node = *question.node;
    const auto kind = [&] {
        switch (node.kind) {
            case lang::QuestionKind::kShortestTime:
                return net::TimeQuestionKind::kShortest;
            case lang::QuestionKind::kLongestTime:
                return net::TimeQuestionKind::kLongest;
            default:
                return net::TimeQuestionKind::kCycle;
        }
    };
    draft().questions.push_back({.path = question.path,
                                 .caption = node.caption.text,
                                 .where = at(node.span),
                                 .kind = kind(),
                                 .about = formula_of(node.about, question.scope)});
}

void Elaboration::complete_ends() {
    for (const Element<lang::End>& end : ends_) {
        // The end of a net that a place runs is its way out, no end of the scene.
        bool inside = false;
        for (std::uint32_t k = end.scope.instance; k != kNoInstance; k = instances_[k].up) {
            inside = inside || instances_[k].refines.valid();
        }
        About about(*this, "end", end.node->span);
        std::optional<Formula> any;
        for (const lang::Expr& e : end.node->formulas) {
            Formula f = formula_of(e, end.scope);
            any =
                any ? Formula::binary(FormulaOp::kOr, std::move(*any), std::move(f)) : std::move(f);
        }
        if (any && !inside) {
            draft().finals.push_back({std::move(*any), at(end.node->span)});
        }
    }
    // Machines with final states rest when all of them are in one.
    std::map<std::uint32_t, Formula> resting;  // by instance
    const lang::Place* first = nullptr;
    for (std::uint32_t i = 0; i < places_.size(); ++i) {
        const std::uint32_t own = places_[i].scope.instance;
        bool inside = false;
        for (std::uint32_t k = own; k != kNoInstance; k = instances_[k].up) {
            inside = inside || instances_[k].refines.valid();
        }
        if (!places_[i].node->final || inside) {
            continue;
        }
        first = first == nullptr ? places_[i].node : first;
        const auto [at, made] = resting.emplace(own, Formula::marked({i}));
        if (!made) {
            at->second = Formula::binary(FormulaOp::kOr, at->second, Formula::marked({i}));
        }
    }
    std::optional<Formula> all;
    for (auto& [instance, rests] : resting) {
        all = all ? Formula::binary(FormulaOp::kAnd, std::move(*all), std::move(rests))
                  : std::move(rests);
    }
    if (all) {
        draft().finals.push_back({std::move(*all), at(first->span)});
    }
}

}  // namespace puppetri::scene
