// SPDX-License-Identifier: MIT
// Predicates: building them in a normal form, negating, evaluating.
#include "puppetri/proof/predicate.h"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <utility>

#include "predicate_builder.h"

namespace puppetri::proof {

namespace {

using Op = Predicate::Op;

// Long chains are not copied again at each of their links, and equal sums are looked for among the
// latest only: building stays linear.
constexpr std::uint32_t kFlattened = 64;
constexpr std::size_t kLatest = 64;

Op negation_of(Op op) {
    switch (op) {
        case Op::kFalse:
            return Op::kTrue;
        case Op::kTrue:
            return Op::kFalse;
        case Op::kAtMost:
            return Op::kAtLeast;
        case Op::kAtLeast:
            return Op::kAtMost;
        case Op::kEnabled:
            return Op::kNoneEnabled;
        case Op::kNoneEnabled:
            return Op::kEnabled;
        case Op::kAnd:
            return Op::kOr;
        case Op::kOr:
            return Op::kAnd;
    }
    return op;
}

std::int64_t floor_divided(std::int64_t a, std::int64_t b) {
    return a / b - (a % b != 0 && (a < 0) != (b < 0) ? 1 : 0);
}

std::int64_t value_of(const LinearSum& sum, std::span<const std::uint32_t> marking) {
    std::int64_t value = 0;
    for (const LinearSum::Term& term : sum.terms) {
        value += term.factor * std::int64_t{marking[term.place]};
    }
    return value;
}

bool any_enabled(const PlainNet& net, std::span<const std::uint32_t> transitions,
                 std::span<const std::uint32_t> marking) {
    return std::any_of(transitions.begin(), transitions.end(),
                       [&](std::uint32_t t) { return net.enabled(marking, t); });
}

template <class Make>
Predicate single(Make&& make) {
    PredicateBuilder builder;
    const std::uint32_t root = make(builder);
    return builder.finish(root);
}

Predicate joined(std::span<const Predicate> parts, bool all) {
    PredicateBuilder builder;
    std::vector<std::uint32_t> roots;
    for (const Predicate& part : parts) {
        roots.push_back(builder.copy(part));
    }
    return builder.finish(all ? builder.all_of(roots) : builder.any_of(roots));
}

}  // namespace

void normalize(LinearSum& sum) {
    std::sort(sum.terms.begin(), sum.terms.end(),
              [](const auto& a, const auto& b) { return a.place < b.place; });
    std::size_t kept = 0;
    for (std::size_t i = 0; i < sum.terms.size();) {
        LinearSum::Term term = sum.terms[i];
        for (++i; i < sum.terms.size() && sum.terms[i].place == term.place; ++i) {
            term.factor += sum.terms[i].factor;
        }
        if (term.factor != 0) {
            sum.terms[kept++] = term;
        }
    }
    sum.terms.resize(kept);
}

PredicateBuilder::PredicateBuilder() {
    add(Op::kFalse, {});
    add(Op::kTrue, {});
}

std::uint32_t PredicateBuilder::add(Op op, std::span<const std::uint32_t> list) {
    Predicate::Node node;
    node.op = op;
    node.first = static_cast<std::uint32_t>(made_.list.size());
    node.count = static_cast<std::uint32_t>(list.size());
    made_.list.insert(made_.list.end(), list.begin(), list.end());
    made_.nodes.push_back(node);
    return static_cast<std::uint32_t>(made_.nodes.size()) - 1;
}

std::uint32_t PredicateBuilder::at_most(LinearSum sum, std::int64_t limit) {
    return compare(Op::kAtMost, std::move(sum), limit);
}
std::uint32_t PredicateBuilder::at_least(LinearSum sum, std::int64_t limit) {
    return compare(Op::kAtLeast, std::move(sum), limit);
}

std::uint32_t PredicateBuilder::compare(Op op, LinearSum sum, std::int64_t limit) {
    normalize(sum);
    if (!sum.terms.empty() && sum.terms.front().factor < 0) {
        for (LinearSum::Term& term : sum.terms) {
            term.factor = -term.factor;
        }
        limit = -limit;
        op = negation_of(op);
    }
    std::int64_t divisor = 0;
    bool negative = false;
    for (const LinearSum::Term& term : sum.terms) {
        divisor = std::gcd(divisor, term.factor);
        negative = negative || term.factor < 0;
    }
    if (divisor > 1) {
        for (LinearSum::Term& term : sum.terms) {
            term.factor /= divisor;
        }
        limit = op == Op::kAtMost ? floor_divided(limit, divisor)
                                  : floor_divided(limit + divisor - 1, divisor);
    }
    if (sum.terms.empty()) {
        return constant(op == Op::kAtMost ? limit >= 0 : limit <= 0);
    }
    if (!negative && (op == Op::kAtMost ? limit < 0 : limit <= 0)) {
        return constant(op == Op::kAtLeast);
    }
    const auto found = std::find(
        made_.sums.end() - static_cast<std::ptrdiff_t>(std::min(made_.sums.size(), kLatest)),
        made_.sums.end(), sum);
    Predicate::Node node;
    node.op = op;
    node.index = static_cast<std::uint32_t>(found - made_.sums.begin());
    node.limit = limit;
    if (found == made_.sums.end()) {
        made_.sums.push_back(std::move(sum));
    }
    made_.nodes.push_back(node);
    return static_cast<std::uint32_t>(made_.nodes.size()) - 1;
}

std::uint32_t PredicateBuilder::enabled(std::vector<std::uint32_t> transitions) {
    std::sort(transitions.begin(), transitions.end());
    transitions.erase(std::unique(transitions.begin(), transitions.end()), transitions.end());
    return transitions.empty() ? constant(false) : add(Op::kEnabled, transitions);
}
std::uint32_t PredicateBuilder::none_enabled(std::vector<std::uint32_t> transitions) {
    std::sort(transitions.begin(), transitions.end());
    transitions.erase(std::unique(transitions.begin(), transitions.end()), transitions.end());
    return transitions.empty() ? constant(true) : add(Op::kNoneEnabled, transitions);
}

std::uint32_t PredicateBuilder::join(Op op, std::span<const std::uint32_t> parts) {
    const std::uint32_t neutral = constant(op == Op::kAnd), decisive = constant(op == Op::kOr);
    const Op merged_op = op == Op::kAnd ? Op::kNoneEnabled : Op::kEnabled;
    std::vector<std::uint32_t> children, merged;
    std::uint32_t lists = 0, last_list = 0;
    const auto take = [&](std::uint32_t child) {
        const Predicate::Node& node = made_.nodes[child];
        if (node.op == merged_op && node.count <= kFlattened) {
            merged.insert(merged.end(), made_.list.begin() + node.first,
                          made_.list.begin() + node.first + node.count);
            ++lists;
            last_list = child;
        } else if (child != neutral) {
            children.push_back(child);
        }
    };
    for (const std::uint32_t part : parts) {
        if (part == decisive) {
            return decisive;
        }
        const Predicate::Node node = made_.nodes[part];
        if (node.op == op && node.count <= kFlattened) {
            for (std::uint32_t i = 0; i < node.count; ++i) {
                take(made_.list[node.first + i]);
            }
        } else {
            take(part);
        }
    }
    if (lists == 1) {
        children.push_back(last_list);
    } else if (lists > 1) {
        children.push_back(merged_op == Op::kEnabled ? enabled(std::move(merged))
                                                     : none_enabled(std::move(merged)));
    }
    std::sort(children.begin(), children.end());
    children.erase(std::unique(children.begin(), children.end()), children.end());
    if (children.empty()) {
        return neutral;
    }
    return children.size() == 1 ? children.front() : add(op, children);
}

std::uint32_t PredicateBuilder::copy(const Predicate& p, bool negated) {
    std::vector<std::uint32_t> made(p.nodes.size()), list;
    for (std::size_t i = 0; i < p.nodes.size(); ++i) {
        const Predicate::Node& node = p.nodes[i];
        const Op op = negated ? negation_of(node.op) : node.op;
        list.assign(p.list.begin() + node.first, p.list.begin() + node.first + node.count);
        switch (op) {
            case Op::kFalse:
            case Op::kTrue:
                made[i] = constant(op == Op::kTrue);
                break;
            case Op::kAtMost:
                made[i] = at_most(p.sums[node.index], negated ? node.limit - 1 : node.limit);
                break;
            case Op::kAtLeast:
                made[i] = at_least(p.sums[node.index], negated ? node.limit + 1 : node.limit);
                break;
            case Op::kEnabled:
                made[i] = enabled(list);
                break;
            case Op::kNoneEnabled:
                made[i] = none_enabled(list);
                break;
            case Op::kAnd:
            case Op::kOr:
                for (std::uint32_t& child : list) {
                    child = made[child];
                }
                made[i] = join(op, list);
                break;
        }
    }
    return made.back();
}

Predicate PredicateBuilder::finish(std::uint32_t root) {
    std::vector<std::uint8_t> needed(made_.nodes.size(), 0);
    needed[root] = 1;
    for (std::uint32_t i = root + 1; i-- > 0;) {  // parents come after their children
        const Predicate::Node& node = made_.nodes[i];
        if (needed[i] != 0 && (node.op == Op::kAnd || node.op == Op::kOr)) {
            for (std::uint32_t k = 0; k < node.count; ++k) {
                needed[made_.list[node.first + k]] = 1;
            }
        }
    }
    Predicate result;
    std::vector<std::uint32_t> moved(made_.nodes.size()), moved_sum(made_.sums.size(), ~0u);
    for (std::uint32_t i = 0; i <= root; ++i) {
        if (needed[i] == 0) {
            continue;
        }
        Predicate::Node node = made_.nodes[i];
        const bool joins = node.op == Op::kAnd || node.op == Op::kOr;
        const auto first = static_cast<std::uint32_t>(result.list.size());
        for (std::uint32_t k = 0; k < node.count; ++k) {
            const std::uint32_t item = made_.list[node.first + k];
            result.list.push_back(joins ? moved[item] : item);
        }
        node.first = first;
        if (node.op == Op::kAtMost || node.op == Op::kAtLeast) {
            if (moved_sum[node.index] == ~0u) {
                moved_sum[node.index] = static_cast<std::uint32_t>(result.sums.size());
                result.sums.push_back(made_.sums[node.index]);
            }
            node.index = moved_sum[node.index];
        }
        moved[i] = static_cast<std::uint32_t>(result.nodes.size());
        result.nodes.push_back(node);
    }
    return result;
}

Predicate Predicate::constant(bool value) {
    return single([&](PredicateBuilder& b) { return b.constant(value); });
}
Predicate Predicate::at_most(LinearSum sum, std::int64_t limit) {
    return single([&](PredicateBuilder& b) { return b.at_most(std::move(sum), limit); });
}
Predicate Predicate::at_least(LinearSum sum, std::int64_t limit) {
    return single([&](PredicateBuilder& b) { return b.at_least(std::move(sum), limit); });
}
Predicate Predicate::enabled(std::vector<std::uint32_t> transitions) {
    return single([&](PredicateBuilder& b) { return b.enabled(std::move(transitions)); });
}
Predicate Predicate::no_successor(const PlainNet& net) {
    std::vector<std::uint32_t> list;
    for (std::uint32_t t = 0; t < net.transition_count(); ++t) {
        if (net.optional.empty() || net.optional[t] == 0) {
            list.push_back(t);
        }
    }
    return single([&](PredicateBuilder& b) { return b.none_enabled(std::move(list)); });
}
Predicate Predicate::all_of(std::span<const Predicate> parts) { return joined(parts, true); }
Predicate Predicate::any_of(std::span<const Predicate> parts) { return joined(parts, false); }
Predicate Predicate::negated() const {
    return single([&](PredicateBuilder& b) { return b.copy(*this, true); });
}

bool Predicate::holds(const PlainNet& net, std::span<const std::uint32_t> marking) const {
    std::vector<std::uint8_t> value(nodes.size());
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const Node& node = nodes[i];
        const std::span<const std::uint32_t> items(list.data() + node.first, node.count);
        bool v = false;
        switch (node.op) {
            case Op::kFalse:
            case Op::kTrue:
                v = node.op == Op::kTrue;
                break;
            case Op::kAtMost:
                v = value_of(sums[node.index], marking) <= node.limit;
                break;
            case Op::kAtLeast:
                v = value_of(sums[node.index], marking) >= node.limit;
                break;
            case Op::kEnabled:
            case Op::kNoneEnabled:
                v = any_enabled(net, items, marking) == (node.op == Op::kEnabled);
                break;
            case Op::kAnd:
                v = std::all_of(items.begin(), items.end(),
                                [&](std::uint32_t c) { return value[c] != 0; });
                break;
            case Op::kOr:
                v = std::any_of(items.begin(), items.end(),
                                [&](std::uint32_t c) { return value[c] != 0; });
                break;
        }
        value[i] = v ? 1 : 0;
    }
    return value.back() != 0;
}

Predicate simplified(const Predicate& p, const PlainNet& net,
                     std::span<const std::uint32_t> upper) {
    PredicateBuilder builder;
    const auto never = [&](std::uint32_t t) {
        const auto too_much = [&](const net::Weighted& w) { return w.weight > upper[w.place]; };
        const auto takes = net.takes.row(t), reads = net.reads.row(t);
        return std::any_of(takes.begin(), takes.end(), too_much) ||
               std::any_of(reads.begin(), reads.end(), too_much);
    };
    const std::uint32_t root = rebuild(
        p, builder, [&](const Predicate::Node& node, std::vector<std::uint32_t>& transitions) {
            if (node.op == Op::kEnabled || node.op == Op::kNoneEnabled) {
                transitions.erase(std::remove_if(transitions.begin(), transitions.end(), never),
                                  transitions.end());
                return node.op == Op::kEnabled ? builder.enabled(transitions)
                                               : builder.none_enabled(transitions);
            }
            const LinearSum& sum = p.sums[node.index];
            std::int64_t least = 0, most = 0;
            for (const LinearSum::Term& term : sum.terms) {
                (term.factor < 0 ? least : most) += term.factor * std::int64_t{upper[term.place]};
            }
            const bool at_most = node.op == Op::kAtMost;
            if (at_most ? most <= node.limit : least >= node.limit) {
                return builder.constant(true);
            }
            if (at_most ? least > node.limit : most < node.limit) {
                return builder.constant(false);
            }
            return at_most ? builder.at_most(sum, node.limit) : builder.at_least(sum, node.limit);
        });
    return builder.finish(root);
}

}  // namespace puppetri::proof
