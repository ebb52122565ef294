// SPDX-License-Identifier: MIT
// Expressions: constants are folded exactly; what depends on data, counts or variables becomes an
// expression of the kernel; what speaks of places, firings and figures becomes a formula.
#include "elaboration.h"
#include "puppetri/lang/units.h"
#include "puppetri/math/rotation.h"

namespace puppetri::scene {
namespace {

using lang::ExprKind;
using lang::Op;

const char* name_for_people(ValueKind kind) {
    switch (kind) {
        case ValueKind::kBool:
            return "something that is true or false";
        case ValueKind::kInt:
            return "a whole number";
        case ValueKind::kReal:
            return "a number";
        case ValueKind::kTime:
            return "a time";
        case ValueKind::kEnum:
            return "a value of its enumeration";
        case ValueKind::kActor:
            return "an actor";
        case ValueKind::kProp:
            return "a prop";
    }
    return "a value";
}

bool is_word(std::string_view name) {
    for (const char* word : {"left", "right", "air", "floor"}) {
        if (name == word) {
            return true;
        }
    }
    return false;
}

// Kinds of term that only the running net can answer.
bool is_formula_like(const Term& t) {
    return std::holds_alternative<net::Formula>(t) || std::holds_alternative<PlaceTerm>(t) ||
           std::holds_alternative<TransitionTerm>(t) || std::holds_alternative<EventTerm>(t);
}

}  // namespace

ExprOp kernel_op(Op op) {
    switch (op) {
        case Op::kAdd:
            return ExprOp::kAdd;
        case Op::kSubtract:
            return ExprOp::kSubtract;
        case Op::kMultiply:
            return ExprOp::kMultiply;
        case Op::kDivide:
            return ExprOp::kDivide;
        case Op::kDiv:
            return ExprOp::kFloorDivide;
        case Op::kMod:
            return ExprOp::kModulo;
        case Op::kPower:
            return ExprOp::kPow;
        case Op::kEqual:
            return ExprOp::kEqual;
        case Op::kNotEqual:
            return ExprOp::kNotEqual;
        case Op::kLess:
            return ExprOp::kLess;
        case Op::kLessEqual:
            return ExprOp::kLessEqual;
        case Op::kGreater:
            return ExprOp::kGreater;
        case Op::kGreaterEqual:
            return ExprOp::kGreaterEqual;
        case Op::kAnd:
            return ExprOp::kAnd;
        case Op::kOr:
            return ExprOp::kOr;
        default:
            return ExprOp::kImplies;
    }
}

Term Elaboration::evaluate(const lang::Expr& e, const Scope& scope) {
    switch (e.kind) {
        case ExprKind::kNone:
        case ExprKind::kSymbol:
            return Nothing{};
        case ExprKind::kNumber:
            return number_of(e, e.number, e.unit, e.span);
        case ExprKind::kBool:
            return e.number.numerator != 0;
        case ExprKind::kString:
            return Text{e.text};
        case ExprKind::kPath:
            return evaluate_path(e, scope);
        case ExprKind::kCall:
            return evaluate_call(e, scope);
        case ExprKind::kTuple:
            return evaluate_tuple(e, scope);
        case ExprKind::kUnary:
            return evaluate_unary(e, scope);
        case ExprKind::kBinary:
            return evaluate_binary(e, scope);
        case ExprKind::kConditional: {
            const Term condition = evaluate(e.args[0].value, scope);
            if (const bool* known = std::get_if<bool>(&condition)) {
                return evaluate(e.args[*known ? 1 : 2].value, scope);
            }
            const auto c = as_expr_of(condition, {ValueKind::kBool}, e.args[0].value.span);
            const auto yes = as_expr(evaluate(e.args[1].value, scope), e.args[1].value.span);
            const auto no = as_expr(evaluate(e.args[2].value, scope), e.args[2].value.span);
            if (!c || !yes || !no) {
                return Nothing{};
            }
            auto result = apply(ExprOp::kIf, {*c, *yes, *no}, e.span);
            return result ? Term{std::move(*result)} : Term{Nothing{}};
        }
        case ExprKind::kCount:
        case ExprKind::kCountReady: {
            const Term place = resolve(e.path, scope);
            if (const auto* p = std::get_if<PlaceTerm>(&place)) {
                const net::SlotKind kind =
                    e.kind == ExprKind::kCount ? net::SlotKind::kCount : net::SlotKind::kReady;
                return Expr::slot(net::slot(kind, p->place.value), {ValueKind::kInt});
            }
            wrong(e.path.span, "a place", place);
            return Nothing{};
        }
        case ExprKind::kRange:
        case ExprKind::kList:
            error("wrong-type", e.span, "a range or a list cannot stand here", "write one value");
            return Nothing{};
    }
    return Nothing{};
}

Term Elaboration::evaluate_path(const lang::Expr& e, const Scope& scope) {
    if (e.path.steps.size() == 1 && e.path.steps[0].index.empty()) {
        if (auto found = resolve_first(e.path.steps[0], scope)) {
            return std::move(*found);
        }
        const std::string& name = e.path.steps[0].text;
        if (is_argument_movement(name, e.span.file)) {
            return movement_value(e, e.path, scope);
        }
        if (is_word(name)) {
            return Word{name};
        }
        if (name == "pi") {
            return Number{.exact = {1, 1}, .pi_power = 1, .value = kPi};
        }
    }
    return resolve(e.path, scope);
}

Term Elaboration::evaluate_unary(const lang::Expr& e, const Scope& scope) {
    const lang::Expr& operand = e.args[0].value;
    Term term = evaluate(operand, scope);
    if (is_nothing(term)) {
        return Nothing{};
    }
    if (e.op == Op::kNot) {
        if (const bool* b = std::get_if<bool>(&term)) {
            return !*b;
        }
        if (is_formula_like(term)) {
            auto f = as_formula(term, operand.span);
            return f ? Term{net::Formula::unary(net::FormulaOp::kNot, std::move(*f))}
                     : Term{Nothing{}};
        }
    } else if (const Number* n = std::get_if<Number>(&term)) {
        return e.op == Op::kNegate ? negate(*n) : *n;
    }
    auto x = as_expr(term, operand.span);
    if (!x) {
        return Nothing{};
    }
    if (e.op == Op::kPlus) {
        return std::move(*x);
    }
    auto result = apply(e.op == Op::kNot ? ExprOp::kNot : ExprOp::kNegate, {std::move(*x)}, e.span);
    return result ? Term{std::move(*result)} : Term{Nothing{}};
}

Term Elaboration::evaluate_binary(const lang::Expr& e, const Scope& scope) {
    if (e.op == Op::kAnd || e.op == Op::kOr || e.op == Op::kImplies) {
        return evaluate_logic(e, scope);
    }
    if (e.op == Op::kUntil || e.op == Op::kWeakUntil || e.op == Op::kRelease) {
        error("wrong-type", e.span, "until and release stand in ltl and ctl rules only",
              "write `rule NAME ltl ...`");
        return Nothing{};
    }
    if ((e.op == Op::kEqual || e.op == Op::kNotEqual) && e.args.size() == 2) {
        // A value of an enumeration is known beside data of it, wherever that was declared.
        for (const std::size_t i : {0, 1}) {
            if (is_unknown_name(e.args[i].value, scope)) {
                const Term data = evaluate(e.args[1 - i].value, scope);
                if (const auto value = value_beside(e.args[i].value, data)) {
                    return fold(e, e.op, data, *value);
                }
            }
        }
    }
    Term result = evaluate(e.args[0].value, scope);
    for (std::size_t i = 1; i < e.args.size(); ++i) {
        result = fold(e, e.op, result, evaluate(e.args[i].value, scope));
    }
    return result;
}

bool Elaboration::is_unknown_name(const lang::Expr& e, const Scope& scope) {
    return e.kind == ExprKind::kPath && e.path.steps.size() == 1 && e.path.steps[0].index.empty() &&
           !is_word(e.path.steps[0].text) && !resolve_first(e.path.steps[0], scope);
}

std::optional<Term> Elaboration::value_beside(const lang::Expr& name, const Term& data) {
    ValueType type;
    if (const auto* datum = std::get_if<DatumTerm>(&data)) {
        type = draft().data[datum->datum.value].type;
    } else if (const auto* x = std::get_if<Expr>(&data)) {
        type = x->type();
    }
    if (type.kind != ValueKind::kEnum) {
        return std::nullopt;
    }
    const std::vector<std::string>& values = draft().enums[type.enumeration].values;
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (values[i] == name.path.steps[0].text) {
            return Term{EnumTerm{type.enumeration, static_cast<std::int64_t>(i)}};
        }
    }
    return std::nullopt;
}

Term Elaboration::fold(const lang::Expr& e, Op op, const Term& a, const Term& b) {
    if (is_nothing(a) || is_nothing(b)) {
        return Nothing{};
    }
    if (std::holds_alternative<QuantityTerm>(a) || std::holds_alternative<QuantityTerm>(b)) {
        return sensor_comparison(e, op, a, b);
    }
    const Number* x = std::get_if<Number>(&a);
    const Number* y = std::get_if<Number>(&b);
    if (x != nullptr && y != nullptr) {
        return fold_numbers(e, op, *x, *y);
    }
    const bool dynamic = std::holds_alternative<Expr>(a) || std::holds_alternative<Expr>(b) ||
                         std::holds_alternative<DatumTerm>(a) ||
                         std::holds_alternative<DatumTerm>(b);
    if ((op == Op::kEqual || op == Op::kNotEqual) && !dynamic) {
        Term equal = compare_things(e, a, b);
        if (op == Op::kEqual || is_nothing(equal)) {
            return equal;
        }
        if (const bool* known = std::get_if<bool>(&equal)) {
            return !*known;
        }
        return net::Formula::unary(net::FormulaOp::kNot, std::get<net::Formula>(std::move(equal)));
    }
    // A plain zero or number beside a time of data is most likely a forgotten unit: the kernel says
    // so.
    const auto beside = [&](const Term& other, const Term& own, const lang::Expr& written) {
        const auto* datum = std::get_if<DatumTerm>(&other);
        return datum == nullptr ? std::nullopt
                                : enum_value(written, own, draft().data[datum->datum.value].type);
    };
    auto left = beside(b, a, e.args[0].value);
    auto right = beside(a, b, e.args.back().value);
    left = left ? left : as_expr(a, e.args[0].value.span);
    right = right ? right : as_expr(b, e.args.back().value.span);
    if (!left || !right) {
        return Nothing{};
    }
    auto result = apply(kernel_op(op), {std::move(*left), std::move(*right)}, e.span);
    return result ? Term{std::move(*result)} : Term{Nothing{}};
}

Term Elaboration::compare_things(const lang::Expr& e, const Term& a, const Term& b) {
    // `ball.holder = ana.hands`, `ball.holder = air`.
    const auto* of = std::get_if<HolderOfTerm>(&a);
    const Term& other = of != nullptr ? b : a;
    if (of == nullptr) {
        of = std::get_if<HolderOfTerm>(&b);
    }
    if (of != nullptr) {
        std::string holder;
        if (const auto* h = std::get_if<HolderTerm>(&other)) {
            holder = h->text;
        } else if (const auto* w = std::get_if<Word>(&other)) {
            holder = w->text;
        } else if (const auto* actor = std::get_if<ActorTerm>(&other)) {
            holder = scene.play.cast.actors[actor->actor.value].name + ".hands";
        } else {
            wrong(e.span, "a holder such as `ana.hands`, `air` or `floor`", other);
            return Nothing{};
        }
        const std::string& prop = scene.play.cast.props[of->prop.value].name;
        return net::Formula::host(host_atom(net::HostAtom::Kind::kHolder, prop, holder, e.span));
    }
    if (a.index() == b.index()) {
        if (const auto* x = std::get_if<ActorTerm>(&a)) {
            return x->actor == std::get<ActorTerm>(b).actor;
        }
        if (const auto* x = std::get_if<PropTerm>(&a)) {
            return x->prop == std::get<PropTerm>(b).prop;
        }
        if (const auto* x = std::get_if<SetTerm>(&a)) {
            return x->set == std::get<SetTerm>(b).set;
        }
        if (const auto* x = std::get_if<InstanceTerm>(&a)) {
            return x->instance == std::get<InstanceTerm>(b).instance;
        }
        if (const auto* x = std::get_if<EnumTerm>(&a)) {
            const auto& y = std::get<EnumTerm>(b);
            return x->enumeration == y.enumeration && x->ordinal == y.ordinal;
        }
        if (const auto* x = std::get_if<bool>(&a)) {
            return *x == std::get<bool>(b);
        }
        if (const auto* x = std::get_if<Word>(&a)) {
            return x->text == std::get<Word>(b).text;
        }
    }
    error("wrong-type", e.span, "cannot compare " + describe(a) + " and " + describe(b),
          "compare things of one kind");
    return Nothing{};
}

Term Elaboration::evaluate_logic(const lang::Expr& e, const Scope& scope) {
    std::vector<Term> terms;
    bool formula = false, constant = true, nothing = false;
    for (const lang::Argument& a : e.args) {
        terms.push_back(evaluate(a.value, scope));
        formula = formula || is_formula_like(terms.back());
        constant = constant && std::holds_alternative<bool>(terms.back());
        nothing = nothing || is_nothing(terms.back());
    }
    if (nothing) {
        return Nothing{};
    }
    if (constant) {
        bool result = std::get<bool>(terms[0]);
        for (std::size_t i = 1; i < terms.size(); ++i) {
            const bool b = std::get<bool>(terms[i]);
            result = e.op == Op::kAnd ? result && b : e.op == Op::kOr ? result || b : !result || b;
        }
        return result;
    }
    if (formula) {
        const net::FormulaOp op = e.op == Op::kAnd  ? net::FormulaOp::kAnd
                                  : e.op == Op::kOr ? net::FormulaOp::kOr
                                                    : net::FormulaOp::kImplies;
        std::optional<net::Formula> result;
        for (std::size_t i = 0; i < terms.size(); ++i) {
            auto f = as_formula(terms[i], e.args[i].value.span);
            if (!f) {
                return Nothing{};
            }
            result = result ? net::Formula::binary(op, std::move(*result), std::move(*f))
                            : std::move(*f);
        }
        return std::move(*result);
    }
    std::optional<Expr> result;
    for (std::size_t i = 0; i < terms.size(); ++i) {
        auto x = as_expr_of(terms[i], {ValueKind::kBool}, e.args[i].value.span);
        if (!x) {
            return Nothing{};
        }
        result = result ? apply(kernel_op(e.op), {std::move(*result), std::move(*x)}, e.span)
                        : std::move(x);
        if (!result) {
            return Nothing{};
        }
    }
    return std::move(*result);
}

Term Elaboration::evaluate_tuple(const lang::Expr& e, const Scope& scope) {
    PointTerm point;
    if (e.args.size() != 3) {
        error("wrong-type", e.span, "a point has three coordinates", "write (x, y, z) m");
        return Nothing{};
    }
    for (std::size_t i = 0; i < 3; ++i) {
        const Term term = evaluate(e.args[i].value, scope);
        const Number* n = std::get_if<Number>(&term);
        if (n == nullptr) {
            wrong(e.args[i].value.span, "a number", term);
            return Nothing{};
        }
        Number value = *n;
        if (!e.unit.empty()) {
            const Term unit = number_of(e, Rational{1}, e.unit, e.unit_span);
            if (const Number* u = std::get_if<Number>(&unit); u != nullptr && value.plain()) {
                value = multiply(value, *u);
            }
        }
        if (i > 0 && value.dimension != point.dimension) {
            error("wrong-unit", e.args[i].value.span, "the coordinates of a point need one unit",
                  "write (x, y, z) m");
            return Nothing{};
        }
        point.dimension = value.dimension;
        point.at[i] = value.value;
    }
    return point;
}

std::optional<Expr> Elaboration::apply(ExprOp op, std::vector<Expr> operands, lang::Span where) {
    auto result = operands.size() == 1 ? Expr::unary(op, std::move(operands[0]))
                  : operands.size() == 2
                      ? Expr::binary(op, std::move(operands[0]), std::move(operands[1]))
                      : Expr::conditional(std::move(operands[0]), std::move(operands[1]),
                                          std::move(operands[2]));
    if (!result) {
        error("wrong-type", where, result.error().message,
              "make both sides values of one kind; times need a unit");
        return std::nullopt;
    }
    return std::move(*result);
}

std::optional<Expr> Elaboration::as_expr(const Term& term, lang::Span where) {
    if (is_nothing(term)) {
        return std::nullopt;
    }
    if (const auto* e = std::get_if<Expr>(&term)) {
        return *e;
    }
    if (const auto* b = std::get_if<bool>(&term)) {
        return Expr::boolean(*b);
    }
    if (const auto* n = std::get_if<Number>(&term)) {
        if (n->dimension == lang::dimension::kTime) {
            const auto t = ticks(*n, where);
            return t ? std::optional(Expr::time(*t)) : std::nullopt;
        }
        if (n->plain() || n->dimension == lang::dimension::kAngle) {
            return n->is_integer() ? Expr::integer(n->exact.numerator) : Expr::real(n->value);
        }
        error("wrong-unit", where,
              "data have no unit but time, and this is " + lang::to_text(n->dimension),
              "divide it by a unit: `x / 1 m`");
        return std::nullopt;
    }
    if (const auto* d = std::get_if<DatumTerm>(&term)) {
        return Expr::slot(net::slot(net::SlotKind::kDatum, d->datum.value),
                          draft().data[d->datum.value].type);
    }
    if (const auto* v = std::get_if<EnumTerm>(&term)) {
        return Expr::enumerator(v->enumeration, v->ordinal);
    }
    if (const auto* a = std::get_if<ActorTerm>(&term)) {
        return Expr::actor(a->actor.value);
    }
    if (const auto* p = std::get_if<PropTerm>(&term)) {
        return Expr::prop(p->prop.value);
    }
    if (const auto* p = std::get_if<PlaceTerm>(&term)) {
        // A place as a statement: it has a token.
        return apply(
            ExprOp::kGreaterEqual,
            {Expr::slot(net::slot(net::SlotKind::kCount, p->place.value), {ValueKind::kInt}),
             Expr::integer(1)},
            where);
    }
    if (const auto* f = std::get_if<net::Formula>(&term)) {
        return expr_of_formula(*f, where);
    }
    wrong(where, "a value", term);
    return std::nullopt;
}

std::optional<Expr> Elaboration::as_expr_of(const Term& term, ValueType type, lang::Span where) {
    Term fitted = term;
    if (Number* n = std::get_if<Number>(&fitted); n != nullptr && type.kind == ValueKind::kTime) {
        *n = in_time_unit(*n, where);
    }
    const Number* number = std::get_if<Number>(&fitted);
    if (number != nullptr && type.kind == ValueKind::kTime &&
        number->dimension != lang::dimension::kTime) {
        wrong(where, "a time", fitted, "write it with a unit such as s");
        return std::nullopt;
    }
    auto e = as_expr(fitted, where);
    if (!e || e->type() == type) {
        return e;
    }
    if (type.kind == ValueKind::kReal && number != nullptr) {
        return Expr::real(number->value);
    }
    if (type.kind == ValueKind::kReal && e->type().kind == ValueKind::kInt) {
        return apply(ExprOp::kToReal, {std::move(*e)}, where);
    }
    wrong(where, name_for_people(type.kind), term);
    return std::nullopt;
}

std::optional<Expr> Elaboration::expr_of(const lang::Expr& e, const Scope& scope, ValueType type) {
    Term value = evaluate(e, scope);
    if (auto named = enum_value(e, value, type)) {
        return named;
    }
    return as_expr_of(value, type, e.span);
}

std::optional<Expr> Elaboration::enum_value(const lang::Expr& e, const Term& otherwise,
                                            ValueType type) {
    const bool thing =
        is_formula_like(otherwise) || std::holds_alternative<InstanceTerm>(otherwise);
    if (type.kind != ValueKind::kEnum || !thing || e.kind != ExprKind::kPath ||
        e.path.steps.size() != 1) {
        return std::nullopt;
    }
    const std::vector<std::string>& values = draft().enums[type.enumeration].values;
    const auto found = std::find(values.begin(), values.end(), e.path.steps[0].text);
    if (found == values.end()) {
        return std::nullopt;
    }
    return Expr::enumerator(type.enumeration, found - values.begin());
}

}  // namespace puppetri::scene
