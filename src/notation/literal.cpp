// SPDX-License-Identifier: MIT
#include "literal.h"

#include <string>

namespace puppetri::notation {

using lang::Expr;
using lang::ExprKind;
using lang::Op;

std::optional<Rational> literal_number(const Expr& e) {
    if (e.kind == ExprKind::kNumber && e.unit.empty()) {
        return e.number;
    }
    if (e.kind == ExprKind::kUnary && (e.op == Op::kNegate || e.op == Op::kPlus)) {
        const auto a = literal_number(e.args[0].value);
        return a && e.op == Op::kNegate ? negate(*a) : a;
    }
    if (e.kind != ExprKind::kBinary) {
        return std::nullopt;
    }
    auto value = literal_number(e.args[0].value);
    for (std::size_t i = 1; value && i < e.args.size(); ++i) {
        const auto b = literal_number(e.args[i].value);
        if (!b) {
            return std::nullopt;
        }
        switch (e.op) {
            case Op::kAdd:
                value = add(*value, *b);
                break;
            case Op::kSubtract:
                value = subtract(*value, *b);
                break;
            case Op::kMultiply:
                value = multiply(*value, *b);
                break;
            case Op::kDivide:
                value = divide(*value, *b);
                break;
            default:
                return std::nullopt;
        }
    }
    return value;
}

std::optional<std::int64_t> literal_whole(const Expr& e, std::int64_t low, std::int64_t high,
                                          std::string_view wanted, Teller& teller) {
    const auto value = literal_number(e);
    if (!value || !value->whole() || value->numerator < low || value->numerator > high) {
        teller.error("out-of-range", e.span,
                     std::string(wanted) + " is a whole number from " + std::to_string(low) +
                         " to " + std::to_string(high) + ", written out",
                     "write such a number; parameters are not known here yet");
        return std::nullopt;
    }
    return value->numerator;
}

}  // namespace puppetri::notation
