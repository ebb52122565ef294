// SPDX-License-Identifier: MIT
// Is this marking declared final?
#include "puppetri/net/engine.h"

namespace puppetri::net {

bool Engine::in_final_marking() const {
    for (const NetTables::FinalMarking& m : tables_->finals) {
        std::vector<bool> value;
        for (const Formula::Node& n : m.condition.nodes) {
            bool v = false;
            switch (n.op) {
                case FormulaOp::kConstant:
                    v = n.count != 0;
                    break;
                case FormulaOp::kMarked:
                    v = state_.counts[n.index].total >= n.count;
                    break;
                case FormulaOp::kReady:
                    v = state_.counts[n.index].ready >= n.count;
                    break;
                case FormulaOp::kExpr: {
                    const Evaluated e = tables_->code.evaluate(m.programs[n.index], *this);
                    v = e.fault == EvalFault::kNone && e.value != 0;
                    break;
                }
                case FormulaOp::kNot:
                    v = !value[n.a];
                    break;
                case FormulaOp::kAnd:
                    v = value[n.a] && value[n.b];
                    break;
                case FormulaOp::kOr:
                    v = value[n.a] || value[n.b];
                    break;
                case FormulaOp::kImplies:
                    v = !value[n.a] || value[n.b];
                    break;
                case FormulaOp::kIff:
                    v = value[n.a] == value[n.b];
                    break;
                default:
                    break;
            }
            value.push_back(v);
        }
        if (!value.empty() && value.back()) {
            return true;
        }
    }
    return false;
}

}  // namespace puppetri::net
