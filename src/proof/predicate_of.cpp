// SPDX-License-Identifier: MIT
// From formulas of scenes and queries to predicates over plain markings, as far as they are that.
#include <algorithm>
#include <utility>

#include "predicate_builder.h"
#include "puppetri/net/draft.h"
#include "puppetri/net/tables.h"
#include "puppetri/proof/predicate.h"

namespace puppetri::proof {

namespace {

using net::FormulaOp;

// Sums of factors times counts stay below 2^62 with counts of 32 bits.
constexpr std::int64_t kMaxFactors = std::int64_t{1} << 29;
constexpr std::int64_t kMaxConstant = std::int64_t{1} << 60;
// Nested `iff` double a formula each time: what grows beyond this is not converted.
constexpr std::uint64_t kMaxTree = 1 << 20;

struct Affine {
    LinearSum sum;
    std::int64_t constant = 0;
};

bool in_range(const Affine& a) {
    std::int64_t factors = 0;
    for (const LinearSum::Term& term : a.sum.terms) {
        if (term.factor > kMaxFactors || term.factor < -kMaxFactors) {
            return false;
        }
        factors += term.factor < 0 ? -term.factor : term.factor;
        if (factors > kMaxFactors) {
            return false;
        }
    }
    return a.constant <= kMaxConstant && a.constant >= -kMaxConstant;
}

// a + factor * b
std::optional<Affine> added(Affine a, const Affine& b, std::int64_t factor) {
    a.constant += factor * b.constant;
    for (LinearSum::Term term : b.sum.terms) {
        term.factor *= factor;
        a.sum.terms.push_back(term);
    }
    normalize(a.sum);
    return in_range(a) ? std::optional(std::move(a)) : std::nullopt;
}

std::optional<Affine> scaled(const Affine& a, std::int64_t factor) {
    if (factor > kMaxFactors || factor < -kMaxFactors || a.constant > kMaxFactors ||
        a.constant < -kMaxFactors) {
        return std::nullopt;
    }
    return added({}, a, factor);
}

bool all_ready_at_once(const net::NetTables& tables, std::uint32_t place) {
    return tables.place[place].kind == net::PlaceKind::kCount;
}

// What a slot of an expression counts.
bool counts(const net::NetTables& tables, const Slot& slot) {
    return slot.kind == static_cast<std::uint32_t>(net::SlotKind::kCount) ||
           (slot.kind == static_cast<std::uint32_t>(net::SlotKind::kReady) &&
            all_ready_at_once(tables, slot.index));
}

// The int nodes of an expression as affine sums: nothing where they are not linear.
std::vector<std::optional<Affine>> affine_of(const net::NetTables& tables, const Expr& e) {
    const std::span<const Expr::Node> nodes = e.nodes();
    std::vector<std::optional<Affine>> values(nodes.size());
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const Expr::Node& n = nodes[i];
        if (n.type.kind != ValueKind::kInt) {
            continue;
        }
        std::optional<Affine>& value = values[i];
        const auto both = [&] { return values[n.a].has_value() && values[n.b].has_value(); };
        switch (n.op) {
            case ExprOp::kLiteral:
                value = Affine{{}, n.literal};
                break;
            case ExprOp::kSlot:
                if (counts(tables, n.slot)) {
                    value = Affine{{{{n.slot.index, 1}}}, 0};
                }
                break;
            case ExprOp::kNegate:
                if (values[n.a].has_value()) {
                    value = added({}, *values[n.a], -1);
                }
                break;
            case ExprOp::kAdd:
            case ExprOp::kSubtract:
                if (both()) {
                    value = added(*values[n.a], *values[n.b], n.op == ExprOp::kAdd ? 1 : -1);
                }
                break;
            case ExprOp::kMultiply:
                if (both() && values[n.a]->sum.terms.empty()) {
                    value = scaled(*values[n.b], values[n.a]->constant);
                } else if (both() && values[n.b]->sum.terms.empty()) {
                    value = scaled(*values[n.a], values[n.b]->constant);
                }
                break;
            default:
                break;
        }
        if (value.has_value() && !in_range(*value)) {
            value.reset();
        }
    }
    return values;
}

class Converter {
 public:
    Converter(const net::Net& net, const net::Formula& formula)
        : tables_(net.tables()), formula_(formula) {}

    std::optional<Predicate> run() {
        // Which polarity of which node the root asks for: parents come after their operands.
        const auto size = static_cast<std::uint32_t>(formula_.nodes.size());
        std::vector<std::uint8_t> wanted(size, 0);
        wanted[size - 1] = kPositive;
        for (std::uint32_t i = size; i-- > 0;) {
            want(formula_.nodes[i], wanted[i], wanted);
        }
        std::vector<Both> made(size);
        for (std::uint32_t i = 0; i < size; ++i) {
            if ((wanted[i] & kPositive) != 0 && !convert(i, false, made)) {
                return std::nullopt;
            }
            if ((wanted[i] & kNegative) != 0 && !convert(i, true, made)) {
                return std::nullopt;
            }
        }
        return builder_.finish(made[size - 1].node[0]);
    }

 private:
    static constexpr std::uint8_t kPositive = 1, kNegative = 2;
    struct Both {
        std::uint32_t node[2] = {0, 0};  // by polarity: as it is, negated
        std::uint64_t tree[2] = {1, 1};  // size when written out as a tree
    };

    static std::uint8_t turned(std::uint8_t polarities) {
        return static_cast<std::uint8_t>(((polarities & 1) << 1) | (polarities >> 1));
    }

    static void want(const net::Formula::Node& n, std::uint8_t polarities,
                     std::vector<std::uint8_t>& wanted) {
        const auto ask = [&](std::uint32_t operand, std::uint8_t p) {
            wanted[operand] = static_cast<std::uint8_t>(wanted[operand] | p);
        };
        switch (n.op) {
            case FormulaOp::kNot:
                ask(n.a, turned(polarities));
                break;
            case FormulaOp::kAnd:
            case FormulaOp::kOr:
                ask(n.a, polarities);
                ask(n.b, polarities);
                break;
            case FormulaOp::kImplies:
                ask(n.a, turned(polarities));
                ask(n.b, polarities);
                break;
            case FormulaOp::kIff:
                if (polarities != 0) {
                    ask(n.a, kPositive | kNegative);
                    ask(n.b, kPositive | kNegative);
                }
                break;
            default:
                break;
        }
    }

    // Node `i`, negated or not, its operands being made.
    bool convert(std::uint32_t i, bool negated, std::vector<Both>& made) {
        const net::Formula::Node& n = formula_.nodes[i];
        Both& mine = made[i];
        const auto join = [&](bool all, std::uint32_t a, bool not_a, std::uint32_t b, bool not_b) {
            const std::uint32_t parts[2] = {made[a].node[not_a], made[b].node[not_b]};
            mine.tree[negated] += made[a].tree[not_a] + made[b].tree[not_b];
            return all ? builder_.all_of(parts) : builder_.any_of(parts);
        };
        std::optional<std::uint32_t> node;
        switch (n.op) {
            case FormulaOp::kNot:
                node = made[n.a].node[!negated];
                mine.tree[negated] = made[n.a].tree[!negated];
                break;
            case FormulaOp::kAnd:
                node = join(!negated, n.a, negated, n.b, negated);
                break;
            case FormulaOp::kOr:
                node = join(negated, n.a, negated, n.b, negated);
                break;
            case FormulaOp::kImplies:
                node = join(negated, n.a, !negated, n.b, negated);
                break;
            case FormulaOp::kIff: {
                const std::uint32_t parts[2] = {join(true, n.a, false, n.b, negated),
                                                join(true, n.a, true, n.b, !negated)};
                node = builder_.any_of(parts);
                break;
            }
            default:
                node = atom(n, negated);
                break;
        }
        if (!node.has_value() || mine.tree[negated] > kMaxTree) {
            return false;
        }
        mine.node[negated] = *node;
        return true;
    }

    std::optional<std::uint32_t> atom(const net::Formula::Node& n, bool negated) {
        switch (n.op) {
            case FormulaOp::kConstant:
                return builder_.constant((n.count != 0) != negated);
            case FormulaOp::kReady:
                if (!all_ready_at_once(tables_, n.index)) {
                    return std::nullopt;
                }
                [[fallthrough]];
            case FormulaOp::kMarked: {
                if (n.count > kMaxConstant || n.count < -kMaxConstant) {
                    return std::nullopt;
                }
                LinearSum sum{{{n.index, 1}}};
                return negated ? builder_.at_most(std::move(sum), n.count - 1)
                               : builder_.at_least(std::move(sum), n.count);
            }
            case FormulaOp::kFireable:
                if (!arcs_are_all(n.index)) {
                    return std::nullopt;
                }
                return negated ? builder_.none_enabled({n.index}) : builder_.enabled({n.index});
            case FormulaOp::kExpr:
                return expression(formula_.expressions[n.index], negated);
            default:
                return std::nullopt;
        }
    }

    // May fire exactly when its arcs are satisfied by the counts.
    bool arcs_are_all(std::uint32_t t) {
        if (plain_.empty()) {
            const auto transitions = static_cast<std::uint32_t>(tables_.transition.size()) - 1;
            plain_.assign(transitions, tables_.level_priority.size() <= 1 ? 1 : 0);
            for (std::uint32_t i = 0; i < transitions; ++i) {
                const net::TransitionRow& row = tables_.transition[i];
                if ((row.flags & net::kGated) != 0 || row.special != net::kNoIndex) {
                    plain_[i] = 0;
                }
            }
            const auto places = static_cast<std::uint32_t>(tables_.place.size()) - 1;
            for (std::uint32_t p = 0; p < places; ++p) {
                if (!all_ready_at_once(tables_, p)) {
                    for (const net::Watcher& w : tables_.ready_watchers(p)) {
                        plain_[w.transition()] = 0;
                    }
                    for (const net::Watcher& w : tables_.total_watchers(p)) {
                        plain_[w.transition()] = 0;
                    }
                }
            }
        }
        return plain_[t] != 0;
    }

    std::optional<std::uint32_t> expression(const Expr& e, bool negated) {
        const std::span<const Expr::Node> nodes = e.nodes();
        const std::vector<std::optional<Affine>> values = affine_of(tables_, e);
        // Both polarities of every bool node; nothing where it is not linear.
        using Pair = std::optional<std::pair<std::uint32_t, std::uint32_t>>;
        std::vector<Pair> made(nodes.size());
        std::vector<std::uint64_t> tree(nodes.size(), 1);
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            const Expr::Node& n = nodes[i];
            if (n.type.kind != ValueKind::kBool) {
                continue;
            }
            const bool ints =
                n.a < i && n.b < i && values[n.a].has_value() && values[n.b].has_value();
            const bool bools = n.a < i && n.b < i && made[n.a].has_value() && made[n.b].has_value();
            const auto any = [&](std::uint32_t a, std::uint32_t b) {
                const std::uint32_t parts[2] = {a, b};
                return builder_.any_of(parts);
            };
            const auto all = [&](std::uint32_t a, std::uint32_t b) {
                const std::uint32_t parts[2] = {a, b};
                return builder_.all_of(parts);
            };
            if (n.op == ExprOp::kLiteral) {
                made[i] = {builder_.constant(n.literal != 0), builder_.constant(n.literal == 0)};
            } else if (n.op == ExprOp::kNot && made[n.a].has_value()) {
                made[i] = {made[n.a]->second, made[n.a]->first};
                tree[i] = tree[n.a];
            } else if (ints) {
                made[i] = comparison(n.op, *values[n.a], *values[n.b]);
            } else if (bools) {
                const auto [a, not_a] = *made[n.a];
                const auto [b, not_b] = *made[n.b];
                tree[i] += tree[n.a] + tree[n.b];
                if (n.op == ExprOp::kAnd) {
                    made[i] = {all(a, b), any(not_a, not_b)};
                } else if (n.op == ExprOp::kOr) {
                    made[i] = {any(a, b), all(not_a, not_b)};
                } else if (n.op == ExprOp::kImplies) {
                    made[i] = {any(not_a, b), all(a, not_b)};
                } else if (n.op == ExprOp::kEqual || n.op == ExprOp::kNotEqual) {
                    tree[i] *= 2;
                    const std::uint32_t same = any(all(a, b), all(not_a, not_b));
                    const std::uint32_t differ = any(all(a, not_b), all(not_a, b));
                    made[i] =
                        n.op == ExprOp::kEqual ? std::pair(same, differ) : std::pair(differ, same);
                }
            }
            if (tree[i] > kMaxTree) {
                return std::nullopt;
            }
        }
        if (!made.back().has_value()) {
            return std::nullopt;
        }
        return negated ? made.back()->second : made.back()->first;
    }

    // a op b, and its opposite: a - b against 0.
    std::optional<std::pair<std::uint32_t, std::uint32_t>> comparison(ExprOp op, const Affine& a,
                                                                      const Affine& b) {
        const std::optional<Affine> d = added(a, b, -1);
        if (!d.has_value()) {
            return std::nullopt;
        }
        const std::int64_t zero = -d->constant;
        const auto most = [&](std::int64_t limit) { return builder_.at_most(d->sum, limit); };
        const auto least = [&](std::int64_t limit) { return builder_.at_least(d->sum, limit); };
        switch (op) {
            case ExprOp::kLess:
                return std::pair(most(zero - 1), least(zero));
            case ExprOp::kLessEqual:
                return std::pair(most(zero), least(zero + 1));
            case ExprOp::kGreater:
                return std::pair(least(zero + 1), most(zero));
            case ExprOp::kGreaterEqual:
                return std::pair(least(zero), most(zero - 1));
            case ExprOp::kEqual:
            case ExprOp::kNotEqual: {
                const std::uint32_t in[2] = {most(zero), least(zero)};
                const std::uint32_t out[2] = {most(zero - 1), least(zero + 1)};
                const std::uint32_t same = builder_.all_of(in), differ = builder_.any_of(out);
                return op == ExprOp::kEqual ? std::pair(same, differ) : std::pair(differ, same);
            }
            default:
                return std::nullopt;
        }
    }

    const net::NetTables& tables_;
    const net::Formula& formula_;
    PredicateBuilder builder_;
    std::vector<std::uint8_t> plain_;
};

}  // namespace

std::optional<Predicate> predicate_of(const net::Net& net, const net::Formula& formula) {
    return Converter(net, formula).run();
}

std::optional<Predicate> final_markings(const net::Net& net) {
    std::vector<Predicate> any;
    for (const net::NetTables::FinalMarking& f : net.tables().finals) {
        std::optional<Predicate> p = predicate_of(net, f.condition);
        if (!p) {
            return std::nullopt;
        }
        any.push_back(std::move(*p));
    }
    return Predicate::any_of(any);
}

std::optional<LinearSum> linear_sum_of(const net::Net& net, const Expr& expression) {
    const std::optional<Affine> value = affine_of(net.tables(), expression).back();
    if (!value.has_value() || value->constant != 0) {
        return std::nullopt;
    }
    return value->sum;
}

}  // namespace puppetri::proof
