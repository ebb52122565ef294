// SPDX-License-Identifier: MIT
// Building formulas: operands are appended before their operator.
#include "puppetri/net/formula.h"

#include <utility>

namespace puppetri::net {

namespace {

Formula atom(FormulaOp op, std::uint32_t index, std::int64_t count = 1) {
    Formula f;
    f.nodes.push_back({op, 0, 0, index, count});
    return f;
}

}  // namespace

Formula Formula::constant(bool value) { return atom(FormulaOp::kConstant, 0, value ? 1 : 0); }
Formula Formula::marked(PlaceIndex place, std::int64_t count) {
    return atom(FormulaOp::kMarked, place.value, count);
}
Formula Formula::ready(PlaceIndex place, std::int64_t count) {
    return atom(FormulaOp::kReady, place.value, count);
}
Formula Formula::event(EventIndex e) { return atom(FormulaOp::kEvent, e.value); }
Formula Formula::fires(TransitionIndex t) { return atom(FormulaOp::kFires, t.value); }
Formula Formula::fireable(TransitionIndex t) { return atom(FormulaOp::kFireable, t.value); }
Formula Formula::host(HostAtomIndex a) { return atom(FormulaOp::kHost, a.value); }

Formula Formula::expression(Expr e) {
    Formula f = atom(FormulaOp::kExpr, 0);
    f.expressions.push_back(std::move(e));
    return f;
}

Formula Formula::unary(FormulaOp op, Formula a) {
    Node n;
    n.op = op;
    n.a = static_cast<std::uint32_t>(a.nodes.size()) - 1;
    a.nodes.push_back(n);
    return a;
}

Formula Formula::binary(FormulaOp op, Formula a, Formula b) {
    const auto offset = static_cast<std::uint32_t>(a.nodes.size());
    const auto expressions = static_cast<std::uint32_t>(a.expressions.size());
    for (Node n : b.nodes) {
        n.a += offset;
        n.b += offset;
        if (n.op == FormulaOp::kExpr) {
            n.index += expressions;
        }
        a.nodes.push_back(n);
    }
    for (Expr& e : b.expressions) {
        a.expressions.push_back(std::move(e));
    }
    Node n;
    n.op = op;
    n.a = offset - 1;
    n.b = static_cast<std::uint32_t>(a.nodes.size()) - 1;
    a.nodes.push_back(n);
    return a;
}

}  // namespace puppetri::net
