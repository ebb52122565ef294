// SPDX-License-Identifier: MIT
// Taking formulas apart: largest parts without temporal operators become atoms.
#include "puppetri/proof/temporal.h"

#include <algorithm>
#include <map>
#include <utility>

#include "puppetri/base/hash.h"

namespace puppetri::proof {

namespace {

using net::Formula;
using net::FormulaOp;
using Op = Temporal::Op;

enum class Side : std::uint8_t { kState = 0, kBranching = 1, kLinear = 2 };  // bits

Side side_of(FormulaOp op) {
    switch (op) {
        case FormulaOp::kAllNext:
        case FormulaOp::kAllGlobally:
        case FormulaOp::kAllFinally:
        case FormulaOp::kAllUntil:
        case FormulaOp::kSomeNext:
        case FormulaOp::kSomeGlobally:
        case FormulaOp::kSomeFinally:
        case FormulaOp::kSomeUntil:
            return Side::kBranching;
        case FormulaOp::kNext:
        case FormulaOp::kGlobally:
        case FormulaOp::kFinally:
        case FormulaOp::kUntil:
            return Side::kLinear;
        default:
            return Side::kState;
    }
}

int operands_of(FormulaOp op) {
    switch (op) {
        case FormulaOp::kConstant:
        case FormulaOp::kMarked:
        case FormulaOp::kReady:
        case FormulaOp::kExpr:
        case FormulaOp::kEvent:
        case FormulaOp::kFires:
        case FormulaOp::kFireable:
        case FormulaOp::kHost:
            return 0;
        case FormulaOp::kNot:
        case FormulaOp::kAllNext:
        case FormulaOp::kAllGlobally:
        case FormulaOp::kAllFinally:
        case FormulaOp::kSomeNext:
        case FormulaOp::kSomeGlobally:
        case FormulaOp::kSomeFinally:
        case FormulaOp::kNext:
        case FormulaOp::kGlobally:
        case FormulaOp::kFinally:
            return 1;
        case FormulaOp::kAnd:
        case FormulaOp::kOr:
        case FormulaOp::kImplies:
        case FormulaOp::kIff:
        case FormulaOp::kAllUntil:
        case FormulaOp::kSomeUntil:
        case FormulaOp::kUntil:
            return 2;
    }
    return 0;
}

// The part of a formula below `root`, with nothing else in it; equal parts give equal copies.
// Cost  O(part log part).
Formula part(const Formula& whole, std::uint32_t root) {
    std::vector<std::uint32_t> needed, waiting = {root};
    while (!waiting.empty()) {
        const Formula::Node& n = whole.nodes[waiting.back()];
        needed.push_back(waiting.back());
        waiting.pop_back();
        const int operands = operands_of(n.op);
        if (operands >= 1) {
            waiting.push_back(n.a);
        }
        if (operands == 2) {
            waiting.push_back(n.b);
        }
        if (needed.size() > whole.nodes.size()) {  // shared operands: each once
            std::sort(needed.begin(), needed.end());
            needed.erase(std::unique(needed.begin(), needed.end()), needed.end());
        }
    }
    std::sort(needed.begin(), needed.end());
    needed.erase(std::unique(needed.begin(), needed.end()), needed.end());
    const auto moved = [&](std::uint32_t i) {
        return static_cast<std::uint32_t>(std::lower_bound(needed.begin(), needed.end(), i) -
                                          needed.begin());
    };
    Formula f;
    for (const std::uint32_t i : needed) {
        Formula::Node n = whole.nodes[i];
        const int operands = operands_of(n.op);
        n.a = operands >= 1 ? moved(n.a) : 0;
        n.b = operands == 2 ? moved(n.b) : 0;
        if (n.op == FormulaOp::kExpr) {
            f.expressions.push_back(whole.expressions[n.index]);
            n.index = static_cast<std::uint32_t>(f.expressions.size()) - 1;
        }
        f.nodes.push_back(n);
    }
    return f;
}

std::uint64_t hash_of(const Formula& f) {
    Hash64 hash;
    for (const Formula::Node& n : f.nodes) {
        hash.add_u64(static_cast<std::uint64_t>(n.op)).add_u64(n.a).add_u64(n.b);
        hash.add_u64(n.index).add_i64(n.count);
    }
    for (const Expr& e : f.expressions) {
        for (const Expr::Node& n : e.nodes()) {
            hash.add_u64(static_cast<std::uint64_t>(n.op)).add_u64(n.a).add_u64(n.b);
            hash.add_u64(n.slot.index).add_i64(n.literal);
        }
    }
    return hash.value();
}

bool equal(const Formula& a, const Formula& b) {
    return a.expressions == b.expressions &&
           std::equal(a.nodes.begin(), a.nodes.end(), b.nodes.begin(), b.nodes.end(),
                      [](const Formula::Node& x, const Formula::Node& y) {
                          return x.op == y.op && x.a == y.a && x.b == y.b && x.index == y.index &&
                                 x.count == y.count;
                      });
}

class Builder {
 public:
    explicit Builder(const Formula& formula) : formula_(formula) {
        made_.nodes.push_back({Op::kFalse, 0, 0, 0});
        made_.nodes.push_back({Op::kTrue, 0, 0, 0});
    }

    Temporal run() {
        const auto size = static_cast<std::uint32_t>(formula_.nodes.size());
        // Which operators lie in each part, and which parts are atoms.
        std::vector<std::uint8_t> sides(size, 0), inner(size, 0);
        for (std::uint32_t i = 0; i < size; ++i) {
            const Formula::Node& n = formula_.nodes[i];
            const int operands = operands_of(n.op);
            sides[i] = static_cast<std::uint8_t>(static_cast<std::uint8_t>(side_of(n.op)) |
                                                 (operands >= 1 ? sides[n.a] : 0) |
                                                 (operands == 2 ? sides[n.b] : 0));
        }
        // A state formula is an atom if the root is one or an operand of a temporal part is one.
        std::vector<std::uint8_t> asked(size, 0);
        asked[size - 1] = 1;
        for (std::uint32_t i = size; i-- > 0;) {
            const Formula::Node& n = formula_.nodes[i];
            if (asked[i] != 0 && sides[i] != 0) {
                const int operands = operands_of(n.op);
                if (operands >= 1) {
                    asked[n.a] = 1;
                }
                if (operands == 2) {
                    asked[n.b] = 1;
                }
            }
        }
        std::vector<std::uint32_t> node(size, kFalse);
        for (std::uint32_t i = 0; i < size; ++i) {
            if (asked[i] != 0) {
                node[i] = sides[i] == 0 ? atom(i) : temporal(formula_.nodes[i], node);
            }
        }
        finish(node[size - 1]);
        made_.logic = sides[size - 1] == 0   ? Temporal::Logic::kState
                      : sides[size - 1] == 1 ? Temporal::Logic::kCtl
                      : sides[size - 1] == 2 ? Temporal::Logic::kLtl
                                             : Temporal::Logic::kNeither;
        return std::move(made_);
    }

 private:
    static constexpr std::uint32_t kFalse = 0, kTrue = 1;

    std::uint32_t add(Op op, std::uint32_t a = 0, std::uint32_t b = 0, std::uint32_t index = 0) {
        // Equal nodes are one; the latest ones suffice to find those of one formula.
        const std::size_t size = made_.nodes.size();
        for (std::size_t i = size; i-- > 0 && size - i <= kLatest;) {
            const Temporal::Node& n = made_.nodes[i];
            if (n.op == op && n.a == a && n.b == b && n.index == index) {
                return static_cast<std::uint32_t>(i);
            }
        }
        made_.nodes.push_back({op, a, b, index});
        return static_cast<std::uint32_t>(size);
    }
    std::uint32_t negation(std::uint32_t a) {
        if (a <= kTrue) {
            return a == kFalse ? kTrue : kFalse;
        }
        return made_.nodes[a].op == Op::kNot ? made_.nodes[a].a : add(Op::kNot, a);
    }
    std::uint32_t both(std::uint32_t a, std::uint32_t b) {
        if (a == kFalse || b == kFalse) {
            return kFalse;
        }
        return a == kTrue || a == b ? b : b == kTrue ? a : add(Op::kAnd, a, b);
    }
    std::uint32_t either(std::uint32_t a, std::uint32_t b) {
        if (a == kTrue || b == kTrue) {
            return kTrue;
        }
        return a == kFalse || a == b ? b : b == kFalse ? a : add(Op::kOr, a, b);
    }
    std::uint32_t until(Op op, std::uint32_t a, std::uint32_t b) {
        return b <= kTrue || a == kFalse ? b : add(op, a, b);
    }
    std::uint32_t release(std::uint32_t a, std::uint32_t b) {
        return b <= kTrue || a == kTrue ? b : add(Op::kRelease, a, b);
    }
    // EG: every path is maximal, so EG true is true, EG false false.
    std::uint32_t some_globally(std::uint32_t a) {
        return a <= kTrue ? a : add(Op::kSomeGlobally, a);
    }
    std::uint32_t some_next(std::uint32_t a) {
        made_.has_next = true;
        return a == kFalse ? kFalse : add(Op::kSomeNext, a);  // EX true: not dead
    }

    std::uint32_t atom(std::uint32_t i) {
        bool negated = false;
        while (formula_.nodes[i].op == FormulaOp::kNot) {
            negated = !negated;
            i = formula_.nodes[i].a;
        }
        if (formula_.nodes[i].op == FormulaOp::kConstant) {
            return (formula_.nodes[i].count != 0) != negated ? kTrue : kFalse;
        }
        Formula f = part(formula_, i);
        auto index = static_cast<std::uint32_t>(made_.atoms.size());
        const std::uint64_t hash = hash_of(f);
        const auto [first, last] = atoms_by_hash_.equal_range(hash);
        for (auto it = first; it != last; ++it) {
            if (equal(f, made_.atoms[it->second])) {
                index = it->second;
            }
        }
        if (index == made_.atoms.size()) {
            atoms_by_hash_.emplace(hash, index);
            made_.atoms.push_back(std::move(f));
        }
        const std::uint32_t node = add(Op::kAtom, 0, 0, index);
        return negated ? negation(node) : node;
    }

    std::uint32_t temporal(const Formula::Node& n, const std::vector<std::uint32_t>& node) {
        const int operands = operands_of(n.op);
        const std::uint32_t a = operands >= 1 ? node[n.a] : 0, b = operands == 2 ? node[n.b] : 0;
        switch (n.op) {
            case FormulaOp::kNot:
                return negation(a);
            case FormulaOp::kAnd:
                return both(a, b);
            case FormulaOp::kOr:
                return either(a, b);
            case FormulaOp::kImplies:
                return either(negation(a), b);
            case FormulaOp::kIff:
                return either(both(a, b), both(negation(a), negation(b)));
            case FormulaOp::kSomeNext:
                return some_next(a);
            case FormulaOp::kAllNext:
                return negation(some_next(negation(a)));
            case FormulaOp::kSomeFinally:
                return until(Op::kSomeUntil, kTrue, a);
            case FormulaOp::kAllGlobally:
                return negation(until(Op::kSomeUntil, kTrue, negation(a)));
            case FormulaOp::kSomeGlobally:
                return some_globally(a);
            case FormulaOp::kAllFinally:
                return negation(some_globally(negation(a)));
            case FormulaOp::kSomeUntil:
                return until(Op::kSomeUntil, a, b);
            case FormulaOp::kAllUntil: {
                // A(a U b) = not (E(not b U (not a and not b)) or EG not b)
                const std::uint32_t not_b = negation(b);
                return negation(either(until(Op::kSomeUntil, not_b, both(negation(a), not_b)),
                                       some_globally(not_b)));
            }
            case FormulaOp::kNext:
                made_.has_next = true;
                return a <= kTrue ? a : add(Op::kNext, a);
            case FormulaOp::kFinally:
                return until(Op::kUntil, kTrue, a);
            case FormulaOp::kGlobally:
                return release(kFalse, a);
            case FormulaOp::kUntil:
                return until(Op::kUntil, a, b);
            default:
                return kFalse;  // atoms are made elsewhere
        }
    }

    // Only what the root needs, the root last.
    void finish(std::uint32_t root) {
        std::vector<std::uint8_t> needed(root + std::size_t{1}, 0);
        needed[root] = 1;
        const auto operands = [](Op op) {
            switch (op) {
                case Op::kFalse:
                case Op::kTrue:
                case Op::kAtom:
                    return 0;
                case Op::kNot:
                case Op::kSomeNext:
                case Op::kSomeGlobally:
                case Op::kNext:
                    return 1;
                default:
                    return 2;
            }
        };
        for (std::uint32_t i = root + 1; i-- > 0;) {
            const Temporal::Node& n = made_.nodes[i];
            if (needed[i] != 0 && operands(n.op) >= 1) {
                needed[n.a] = 1;
            }
            if (needed[i] != 0 && operands(n.op) == 2) {
                needed[n.b] = 1;
            }
        }
        std::vector<Temporal::Node> nodes;
        std::vector<Formula> atoms;
        std::vector<std::uint32_t> moved(root + std::size_t{1}, 0),
            moved_atom(made_.atoms.size(), ~0u);
        bool has_next = false;
        for (std::uint32_t i = 0; i <= root; ++i) {
            if (needed[i] == 0) {
                continue;
            }
            Temporal::Node n = made_.nodes[i];
            n.a = operands(n.op) >= 1 ? moved[n.a] : 0;
            n.b = operands(n.op) == 2 ? moved[n.b] : 0;
            has_next = has_next || n.op == Op::kNext || n.op == Op::kSomeNext;
            if (n.op == Op::kAtom) {
                if (moved_atom[n.index] == ~0u) {
                    moved_atom[n.index] = static_cast<std::uint32_t>(atoms.size());
                    atoms.push_back(std::move(made_.atoms[n.index]));
                }
                n.index = moved_atom[n.index];
            }
            moved[i] = static_cast<std::uint32_t>(nodes.size());
            nodes.push_back(n);
        }
        made_.nodes = std::move(nodes);
        made_.atoms = std::move(atoms);
        made_.has_next = has_next;
    }

    static constexpr std::size_t kLatest = 256;
    const Formula& formula_;
    Temporal made_;
    std::multimap<std::uint64_t, std::uint32_t> atoms_by_hash_;
};

}  // namespace

Temporal taken_apart(const Formula& formula) { return Builder(formula).run(); }

}  // namespace puppetri::proof
