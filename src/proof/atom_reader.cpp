// SPDX-License-Identifier: MIT
#include "atom_reader.h"

#include <utility>

namespace puppetri::proof {

using namespace net;

AtomReader::AtomReader(const Net&, std::span<const Formula> atoms,
                       std::vector<std::string>& trouble) {
    for (const Formula& f : atoms) {
        Program p;
        p.nodes = f.nodes;
        for (const Formula::Node& n : f.nodes) {
            if (n.op > FormulaOp::kIff) {
                trouble.push_back("an atom looks into the future: it is no state formula");
                break;
            }
        }
        for (const Expr& e : f.expressions) {
            const Result<ProgramIndex, ExprError> program = code_.add(e);
            if (program) {
                p.expressions.push_back(*program);
            } else {
                trouble.push_back("an atom: " + program.error().message);
                p.expressions.emplace_back();
            }
        }
        formulas_.push_back(std::move(p));
    }
}

Value AtomReader::read(std::uint32_t kind, std::uint32_t index) const {
    switch (static_cast<SlotKind>(kind)) {
        case SlotKind::kDatum:
            return state_->data[index];
        case SlotKind::kCount:
            return state_->counts[index].total;
        case SlotKind::kReady:
            return state_->counts[index].ready;
        default:
            return 0;
    }
}

AtomReader::Known AtomReader::value(const Program& p, const Engine& engine) {
    const auto known = [](bool b) { return Known{b, b}; };
    const auto negated = [](Known k) { return Known{!k.must, !k.may}; };
    const auto either = [](Known a, Known b) { return Known{a.may || b.may, a.must || b.must}; };
    values_.clear();
    for (const Formula::Node& n : p.nodes) {
        Known v;
        switch (n.op) {
            case FormulaOp::kConstant:
                v = known(n.count != 0);
                break;
            case FormulaOp::kMarked:
                v = known(state_->counts[n.index].total >= n.count);
                break;
            case FormulaOp::kReady:
                v = known(state_->counts[n.index].ready >= n.count);
                break;
            case FormulaOp::kExpr: {
                // What cannot be computed does not hold.
                const Evaluated e = code_.evaluate(p.expressions[n.index], *this);
                v = known(e.fault == EvalFault::kNone && e.value != 0);
                break;
            }
            case FormulaOp::kEvent:
                v = known(state_->offered == n.index);
                break;
            case FormulaOp::kFireable:
                v = known(engine.fireable({n.index}));
                break;
            case FormulaOp::kNot:
                v = negated(values_[n.a]);
                break;
            case FormulaOp::kAnd:
                v = negated(either(negated(values_[n.a]), negated(values_[n.b])));
                break;
            case FormulaOp::kOr:
                v = either(values_[n.a], values_[n.b]);
                break;
            case FormulaOp::kImplies:
                v = either(negated(values_[n.a]), values_[n.b]);
                break;
            case FormulaOp::kIff: {
                const Known a = values_[n.a];
                const Known b = values_[n.b];
                v.must = (a.must && b.must) || (!a.may && !b.may);
                v.may = (a.may && b.may) || (!a.must && !b.must);
                break;
            }
            default:
                v = {true, false};
                break;
        }
        values_.push_back(v);
    }
    return values_.empty() ? Known{} : values_.back();
}

void AtomReader::read(const Engine& engine, std::vector<std::uint64_t>& may,
                      std::vector<std::uint64_t>& must) {
    state_ = &engine.state();
    const std::size_t row = may.size();
    may.resize(row + words());
    must.resize(row + words());
    for (std::uint32_t i = 0; i < count(); ++i) {
        const Known v = value(formulas_[i], engine);
        may[row + i / 64] |= std::uint64_t{v.may ? 1u : 0u} << (i & 63);
        must[row + i / 64] |= std::uint64_t{v.must ? 1u : 0u} << (i & 63);
    }
}

bool AtomReader::mentions_event(std::uint32_t e) const {
    for (const Program& p : formulas_) {
        for (const Formula::Node& n : p.nodes) {
            if (n.op == FormulaOp::kEvent && n.index == e) {
                return true;
            }
        }
    }
    return false;
}

}  // namespace puppetri::proof
