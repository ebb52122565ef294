// SPDX-License-Identifier: MIT
// Statements about the net: named states, operands of rules, final markings. A place is true while
// it has a token, a transition when it fires, an event when it occurs.
#include "elaboration.h"

namespace puppetri::scene {

using net::Formula;
using net::FormulaOp;

std::optional<Formula> Elaboration::as_formula(const Term& term, lang::Span where) {
    if (is_nothing(term)) {
        return std::nullopt;
    }
    if (const auto* f = std::get_if<Formula>(&term)) {
        return *f;
    }
    if (const auto* b = std::get_if<bool>(&term)) {
        return Formula::constant(*b);
    }
    if (const auto* p = std::get_if<PlaceTerm>(&term)) {
        return Formula::marked(p->place);
    }
    if (const auto* t = std::get_if<TransitionTerm>(&term)) {
        return Formula::fires(t->transition);
    }
    if (const auto* e = std::get_if<EventTerm>(&term)) {
        return Formula::event(e->event);
    }
    if (std::holds_alternative<Expr>(term) || std::holds_alternative<DatumTerm>(term)) {
        auto e = as_expr_of(term, {ValueKind::kBool}, where);
        return e ? std::optional(Formula::expression(std::move(*e))) : std::nullopt;
    }
    wrong(where, "something that is true or false", term,
          "write a place, a state, a transition, an event, a phase of a limb, or a comparison");
    return std::nullopt;
}

Formula Elaboration::formula_of(const lang::Expr& e, const Scope& scope) {
    auto f = as_formula(evaluate(e, scope), e.span);
    return f ? std::move(*f) : Formula::constant(false);
}

std::optional<Expr> Elaboration::expr_of_formula(const Formula& formula, lang::Span where) {
    std::vector<std::optional<Expr>> values(formula.nodes.size());
    for (std::size_t i = 0; i < formula.nodes.size(); ++i) {
        const Formula::Node& n = formula.nodes[i];
        const auto at_least = [&](net::SlotKind kind) {
            return apply(
                ExprOp::kGreaterEqual,
                {Expr::slot(net::slot(kind, n.index), {ValueKind::kInt}), Expr::integer(n.count)},
                where);
        };
        switch (n.op) {
            case FormulaOp::kConstant:
                values[i] = Expr::boolean(n.count != 0);
                break;
            case FormulaOp::kMarked:
                values[i] = at_least(net::SlotKind::kCount);
                break;
            case FormulaOp::kReady:
                values[i] = at_least(net::SlotKind::kReady);
                break;
            case FormulaOp::kExpr:
                values[i] = formula.expressions[n.index];
                break;
            case FormulaOp::kNot:
                values[i] = apply(ExprOp::kNot, {*values[n.a]}, where);
                break;
            case FormulaOp::kAnd:
                values[i] = apply(ExprOp::kAnd, {*values[n.a], *values[n.b]}, where);
                break;
            case FormulaOp::kOr:
                values[i] = apply(ExprOp::kOr, {*values[n.a], *values[n.b]}, where);
                break;
            case FormulaOp::kImplies:
                values[i] = apply(ExprOp::kImplies, {*values[n.a], *values[n.b]}, where);
                break;
            default:
                error("not-a-value", where,
                      "a guard or a value cannot ask for firings, events or figures",
                      "use places, counts and data here");
                return std::nullopt;
        }
        if (!values[i]) {
            return std::nullopt;
        }
    }
    return values.empty() ? std::nullopt : values.back();
}

Formula Elaboration::state_formula(std::uint32_t index) {
    StateElement& state = states_[index];
    if (state.known == StateElement::Known::kYes) {
        return state.formula;
    }
    About about(*this, "state " + state.path, state.node->span);
    if (state.known == StateElement::Known::kNow) {
        error("state-cycle", state.node->span, "this state is defined by itself",
              "define it by places");
        return Formula::constant(false);
    }
    state.known = StateElement::Known::kNow;
    Scope scope = state.scope;
    scope.sees_all = true;
    state.formula = formula_of(state.node->formula, scope);
    state.known = StateElement::Known::kYes;
    return state.formula;
}

Formula Elaboration::temporal_formula(const lang::Expr& e, const Scope& scope, bool linear) {
    using lang::Op;
    const auto part = [&](std::size_t i) {
        return temporal_formula(e.args[i].value, scope, linear);
    };
    const auto until = [&](FormulaOp op, Formula a, Formula b) {
        return Formula::binary(op, std::move(a), std::move(b));
    };
    if (e.kind == lang::ExprKind::kUnary && e.op == Op::kNot) {
        return Formula::unary(FormulaOp::kNot, part(0));
    }
    if (e.kind == lang::ExprKind::kBinary) {
        if (e.op == Op::kAnd || e.op == Op::kOr || e.op == Op::kImplies) {
            const FormulaOp op = e.op == Op::kAnd  ? FormulaOp::kAnd
                                 : e.op == Op::kOr ? FormulaOp::kOr
                                                   : FormulaOp::kImplies;
            Formula result = part(0);
            for (std::size_t i = 1; i < e.args.size(); ++i) {
                result = Formula::binary(op, std::move(result), part(i));
            }
            return result;
        }
        if (e.op == Op::kUntil || e.op == Op::kWeakUntil || e.op == Op::kRelease) {
            if (!linear) {
                error("wrong-type", e.span, "until needs a quantifier in a ctl rule",
                      "write A(x until y) or E(x until y)");
                return Formula::constant(false);
            }
            if (e.op == Op::kUntil) {
                return until(FormulaOp::kUntil, part(0), part(1));
            }
            if (e.op == Op::kWeakUntil) {  // a W b: a U b, or a for ever
                return Formula::binary(FormulaOp::kOr, until(FormulaOp::kUntil, part(0), part(1)),
                                       Formula::unary(FormulaOp::kGlobally, part(0)));
            }
            // a R b: not (not a U not b)
            return Formula::unary(FormulaOp::kNot,
                                  until(FormulaOp::kUntil, Formula::unary(FormulaOp::kNot, part(0)),
                                        Formula::unary(FormulaOp::kNot, part(1))));
        }
    }
    if (e.kind == lang::ExprKind::kCall && e.path.steps.size() == 1 && e.args.size() == 1) {
        struct Quantifier {
            const char* name;
            FormulaOp op;
            bool linear;
        };
        constexpr Quantifier kQuantifiers[] = {
            {"AX", FormulaOp::kAllNext, false},      {"AG", FormulaOp::kAllGlobally, false},
            {"AF", FormulaOp::kAllFinally, false},   {"EX", FormulaOp::kSomeNext, false},
            {"EG", FormulaOp::kSomeGlobally, false}, {"EF", FormulaOp::kSomeFinally, false},
            {"X", FormulaOp::kNext, true},           {"G", FormulaOp::kGlobally, true},
            {"F", FormulaOp::kFinally, true},
        };
        const std::string& name = e.path.steps[0].text;
        for (const Quantifier& q : kQuantifiers) {
            if (name == q.name && linear == q.linear) {
                return Formula::unary(q.op, part(0));
            }
        }
        const lang::Expr& inner = e.args[0].value;
        if (!linear && (name == "A" || name == "E") && inner.kind == lang::ExprKind::kBinary &&
            inner.op == Op::kUntil) {
            return until(name == "A" ? FormulaOp::kAllUntil : FormulaOp::kSomeUntil,
                         temporal_formula(inner.args[0].value, scope, linear),
                         temporal_formula(inner.args[1].value, scope, linear));
        }
    }
    return formula_of(e, scope);
}

}  // namespace puppetri::scene
