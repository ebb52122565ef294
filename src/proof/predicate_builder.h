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

// Sorts by place, adds up equal places, drops zeros.
void normalize(LinearSum& sum);

}  // namespace puppetri::proof
