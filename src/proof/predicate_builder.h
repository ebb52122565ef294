// SPDX-License-Identifier: MIT
// Building a predicate node by node, simplified on the way. Nodes may be shared; what the root does
// not need is left behind in the end.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "puppetri/proof/predicate.h"

namespace puppetri::proof {

class PredicateBuilder {
 public:
    using Op = Predicate::Op;
    static constexpr std::uint32_t kFalse = 0, kTrue = 1;  // nodes that are always there

    PredicateBuilder();
    std::uint32_t constant(bool value) const { return value ? kTrue : kFalse; }
    std::uint32_t at_most(LinearSum sum, std::int64_t limit);
    std::uint32_t at_least(LinearSum sum, std::int64_t limit);
    // The list is sorted and freed of doubles; an empty one is false.
    std::uint32_t enabled(std::vector<std::uint32_t> transitions);
    std::uint32_t none_enabled(std::vector<std::uint32_t> transitions);
    std::uint32_t all_of(std::span<const std::uint32_t> parts) { return join(Op::kAnd, parts); }
    std::uint32_t any_of(std::span<const std::uint32_t> parts) { return join(Op::kOr, parts); }
    // All nodes of a predicate, negated or not; gives what its root became.
    std::uint32_t copy(const Predicate& p, bool negated = false);
    // Leaves the builder empty of use.
    Predicate finish(std::uint32_t root);

 private:
    std::uint32_t add(Op op, std::span<const std::uint32_t> list);
    std::uint32_t compare(Op op, LinearSum sum, std::int64_t limit);
    std::uint32_t join(Op op, std::span<const std::uint32_t> parts);
    Predicate made_;
};

// Node by node into the builder: a node about tokens or transitions becomes what `leaf(node, list)`
// makes of it (`list` is a copy of its transitions), all others stay. Gives  what the root became.
template <class Leaf>
std::uint32_t rebuild(const Predicate& p, PredicateBuilder& builder, const Leaf& leaf) {
    using Op = Predicate::Op;
    std::vector<std::uint32_t> made(p.nodes.size()), list;
    for (std::size_t i = 0; i < p.nodes.size(); ++i) {
        const Predicate::Node& node = p.nodes[i];
        list.assign(p.list.begin() + node.first, p.list.begin() + node.first + node.count);
        if (node.op == Op::kFalse || node.op == Op::kTrue) {
            made[i] = builder.constant(node.op == Op::kTrue);
        } else if (node.op == Op::kAnd || node.op == Op::kOr) {
            for (std::uint32_t& child : list) {
                child = made[child];
            }
            made[i] = node.op == Op::kAnd ? builder.all_of(list) : builder.any_of(list);
        } else {
            made[i] = leaf(node, list);
        }
    }
    return made.back();
}

// Sorts by place, adds up equal places, drops zeros.
void normalize(LinearSum& sum);

}  // namespace puppetri::proof
