// SPDX-License-Identifier: MIT
// Building expressions: every operator checks the types of its operands at once, so that a finished
// expression is typed.
#include "puppetri/base/expr.h"

#include <utility>

#include "puppetri/base/bit_cast.h"
#include "puppetri/base/require.h"

namespace puppetri {

namespace {

bool is_number(ValueType t) { return t.kind == ValueKind::kInt || t.kind == ValueKind::kReal; }
bool is(ValueType t, ValueKind kind) { return t.kind == kind; }

const char* symbol(ExprOp op) {
    switch (op) {
        case ExprOp::kLiteral:
            return "literal";
        case ExprOp::kSlot:
            return "slot";
        case ExprOp::kNegate:
            return "-";
        case ExprOp::kNot:
            return "not";
        case ExprOp::kAbs:
            return "abs";
        case ExprOp::kFloor:
            return "floor";
        case ExprOp::kCeil:
            return "ceil";
        case ExprOp::kRound:
            return "round";
        case ExprOp::kToReal:
            return "real";
        case ExprOp::kToTime:
            return "time";
        case ExprOp::kSqrt:
            return "sqrt";
        case ExprOp::kSin:
            return "sin";
        case ExprOp::kCos:
            return "cos";
        case ExprOp::kTan:
            return "tan";
        case ExprOp::kAsin:
            return "asin";
        case ExprOp::kAcos:
            return "acos";
        case ExprOp::kExp:
            return "exp";
        case ExprOp::kLog:
            return "log";
        case ExprOp::kAdd:
            return "+";
        case ExprOp::kSubtract:
            return "-";
        case ExprOp::kMultiply:
            return "*";
        case ExprOp::kDivide:
            return "/";
        case ExprOp::kFloorDivide:
            return "div";
        case ExprOp::kModulo:
            return "mod";
        case ExprOp::kMin:
            return "min";
        case ExprOp::kMax:
            return "max";
        case ExprOp::kPow:
            return "^";
        case ExprOp::kAtan2:
            return "atan2";
        case ExprOp::kLess:
            return "<";
        case ExprOp::kLessEqual:
            return "<=";
        case ExprOp::kGreater:
            return ">";
        case ExprOp::kGreaterEqual:
            return ">=";
        case ExprOp::kEqual:
            return "=";
        case ExprOp::kNotEqual:
            return "!=";
        case ExprOp::kAnd:
            return "and";
        case ExprOp::kOr:
            return "or";
        case ExprOp::kImplies:
            return "implies";
        case ExprOp::kIf:
            return "if";
    }
    return "?";
}

Unexpected<ExprError> misfit(ExprOp op, ValueType a) {
    return Unexpected(
        ExprError{std::string("`") + symbol(op) + "` does not apply to " + name_of(a.kind)});
}

Unexpected<ExprError> misfit(ExprOp op, ValueType a, ValueType b) {
    return Unexpected(ExprError{std::string("`") + symbol(op) + "` does not apply to " +
                                name_of(a.kind) + " and " + name_of(b.kind)});
}

}  // namespace

const char* name_of(ValueKind kind) {
    switch (kind) {
        case ValueKind::kBool:
            return "bool";
        case ValueKind::kInt:
            return "int";
        case ValueKind::kReal:
            return "real";
        case ValueKind::kTime:
            return "time";
        case ValueKind::kEnum:
            return "enum";
        case ValueKind::kActor:
            return "actor";
        case ValueKind::kProp:
            return "prop";
    }
    return "?";
}

const char* name_of(EvalFault fault) {
    switch (fault) {
        case EvalFault::kNone:
            return "no fault";
        case EvalFault::kDivisionByZero:
            return "division by zero";
        case EvalFault::kOverflow:
            return "overflow";
        case EvalFault::kNotANumber:
            return "not a number";
    }
    return "?";
}

Value value_of_real(double x) { return puppetri::bit_cast<Value>(x); }
double real_of_value(Value v) { return puppetri::bit_cast<double>(v); }

Expr::Expr() : nodes_(1) {}

Expr Expr::literal(ValueType type, Value value) {
    Expr e;
    e.nodes_[0].type = type;
    e.nodes_[0].literal = value;
    return e;
}
Expr Expr::boolean(bool b) { return literal({ValueKind::kBool, 0}, b ? 1 : 0); }
Expr Expr::integer(std::int64_t i) { return literal({ValueKind::kInt, 0}, i); }
Expr Expr::real(double x) { return literal({ValueKind::kReal, 0}, value_of_real(x)); }
Expr Expr::time(SimTime t) { return literal({ValueKind::kTime, 0}, t.ticks); }
Expr Expr::enumerator(std::uint32_t enumeration, std::int64_t ordinal) {
    return literal({ValueKind::kEnum, enumeration}, ordinal);
}
Expr Expr::actor(std::uint32_t index) { return literal({ValueKind::kActor, 0}, index); }
Expr Expr::prop(std::uint32_t index) { return literal({ValueKind::kProp, 0}, index); }

Expr Expr::slot(Slot slot, ValueType type) {
    Expr e;
    e.nodes_[0].op = ExprOp::kSlot;
    e.nodes_[0].type = type;
    e.nodes_[0].slot = slot;
    return e;
}

Value Expr::literal_value() const {
    PUP_REQUIRE(is_literal());
    return nodes_[0].literal;
}

Result<Expr, ExprError> Expr::unary(ExprOp op, Expr a) {
    const ValueType t = a.type();
    Node node;
    node.op = op;
    node.type = t;
    switch (op) {
        case ExprOp::kNegate:
        case ExprOp::kAbs:
            if (!is_number(t) && !is(t, ValueKind::kTime)) {
                return misfit(op, t);
            }
            break;
        case ExprOp::kNot:
            if (!is(t, ValueKind::kBool)) {
                return misfit(op, t);
            }
            break;
        case ExprOp::kFloor:
        case ExprOp::kCeil:
        case ExprOp::kRound:
            if (is(t, ValueKind::kInt)) {
                return a;
            }
            if (!is(t, ValueKind::kReal)) {
                return misfit(op, t);
            }
            node.type.kind = ValueKind::kInt;
            break;
        case ExprOp::kToReal:
            if (is(t, ValueKind::kReal)) {
                return a;
            }
            if (!is(t, ValueKind::kInt) && !is(t, ValueKind::kTime)) {
                return misfit(op, t);
            }
            node.type.kind = ValueKind::kReal;
            break;
        case ExprOp::kToTime:
        case ExprOp::kSqrt:
        case ExprOp::kSin:
        case ExprOp::kCos:
        case ExprOp::kTan:
        case ExprOp::kAsin:
        case ExprOp::kAcos:
        case ExprOp::kExp:
        case ExprOp::kLog:
            if (is(t, ValueKind::kInt)) {
                PUP_TRY(Expr widened, unary(ExprOp::kToReal, std::move(a)));
                return unary(op, std::move(widened));
            }
            if (!is(t, ValueKind::kReal)) {
                return misfit(op, t);
            }
            node.type.kind = op == ExprOp::kToTime ? ValueKind::kTime : ValueKind::kReal;
            break;
        default:
            return misfit(op, t);
    }
    node.a = static_cast<std::uint32_t>(a.nodes_.size()) - 1;
    a.nodes_.push_back(node);
    return a;
}

Result<Expr, ExprError> Expr::binary(ExprOp op, Expr a, Expr b) {
    // Ints become reals beside reals, except as the factor or divisor of a time.
    if (is_number(a.type()) && is_number(b.type()) && a.type() != b.type()) {
        Expr& narrow = is(a.type(), ValueKind::kInt) ? a : b;
        PUP_TRY(narrow, unary(ExprOp::kToReal, std::move(narrow)));
    }
    const ValueType ta = a.type();
    const ValueType tb = b.type();
    const bool same = ta == tb;
    const bool time_a = is(ta, ValueKind::kTime);
    const bool time_b = is(tb, ValueKind::kTime);
    const bool ordered = same && (is_number(ta) || time_a || is(ta, ValueKind::kEnum));
    const bool measured = same && (is_number(ta) || time_a);
    Node node;
    node.op = op;
    node.type = ta;
    bool fits = false;
    switch (op) {
        case ExprOp::kAdd:
        case ExprOp::kSubtract:
        case ExprOp::kMin:
        case ExprOp::kMax:
            fits = measured;
            break;
        case ExprOp::kMultiply:
            fits =
                (same && is_number(ta)) || (time_a && is_number(tb)) || (is_number(ta) && time_b);
            if (fits && time_b) {
                return binary(op, std::move(b), std::move(a));  // a time comes first
            }
            break;
        case ExprOp::kDivide:
            fits = measured || (time_a && is_number(tb));
            if (same) {
                node.type.kind = ValueKind::kReal;
            }
            break;
        case ExprOp::kFloorDivide:
            fits = same && (is(ta, ValueKind::kInt) || time_a);
            node.type.kind = ValueKind::kInt;
            break;
        case ExprOp::kModulo:
            fits = same && (is(ta, ValueKind::kInt) || time_a);
            break;
        case ExprOp::kPow:
        case ExprOp::kAtan2:
            if (same && is(ta, ValueKind::kInt)) {
                PUP_TRY(Expr wide_a, unary(ExprOp::kToReal, std::move(a)));
                PUP_TRY(Expr wide_b, unary(ExprOp::kToReal, std::move(b)));
                return binary(op, std::move(wide_a), std::move(wide_b));
            }
            fits = same && is(ta, ValueKind::kReal);
            break;
        case ExprOp::kLess:
        case ExprOp::kLessEqual:
        case ExprOp::kGreater:
        case ExprOp::kGreaterEqual:
            fits = ordered;
            node.type = {ValueKind::kBool, 0};
            break;
        case ExprOp::kEqual:
        case ExprOp::kNotEqual:
            fits = same;
            node.type = {ValueKind::kBool, 0};
            break;
        case ExprOp::kAnd:
        case ExprOp::kOr:
        case ExprOp::kImplies:
            fits = same && is(ta, ValueKind::kBool);
            break;
        default:
            break;
    }
    if (!fits) {
        return misfit(op, ta, tb);
    }
    const auto offset = static_cast<std::uint32_t>(a.nodes_.size());
    for (Node n : b.nodes_) {
        n.a += offset;
        n.b += offset;
        n.c += offset;
        a.nodes_.push_back(n);
    }
    node.a = offset - 1;
    node.b = static_cast<std::uint32_t>(a.nodes_.size()) - 1;
    a.nodes_.push_back(node);
    return a;
}

Result<Expr, ExprError> Expr::conditional(Expr condition, Expr then, Expr otherwise) {
    if (!is(condition.type(), ValueKind::kBool)) {
        return misfit(ExprOp::kIf, condition.type());
    }
    if (is_number(then.type()) && is_number(otherwise.type()) && then.type() != otherwise.type()) {
        Expr& narrow = is(then.type(), ValueKind::kInt) ? then : otherwise;
        PUP_TRY(narrow, unary(ExprOp::kToReal, std::move(narrow)));
    }
    if (then.type() != otherwise.type()) {
        return misfit(ExprOp::kIf, then.type(), otherwise.type());
    }
    Node node;
    node.op = ExprOp::kIf;
    node.type = then.type();
    std::uint32_t* const ends[] = {&node.b, &node.c};
    const Expr* const branches[] = {&then, &otherwise};
    node.a = static_cast<std::uint32_t>(condition.nodes_.size()) - 1;
    for (int i = 0; i < 2; ++i) {
        const auto offset = static_cast<std::uint32_t>(condition.nodes_.size());
        for (Node n : branches[i]->nodes_) {
            n.a += offset;
            n.b += offset;
            n.c += offset;
            condition.nodes_.push_back(n);
        }
        *ends[i] = static_cast<std::uint32_t>(condition.nodes_.size()) - 1;
    }
    condition.nodes_.push_back(node);
    return condition;
}

}  // namespace puppetri
