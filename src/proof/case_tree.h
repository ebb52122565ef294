// SPDX-License-Identifier: MIT
// A predicate as a tree of and, or and bounds on sums of tokens: what the state equation splits
// into cases. Enabledness is unfolded into counts.
#pragma once
#include <cstdint>
#include <vector>

#include "puppetri/proof/predicate.h"

namespace puppetri::proof {

struct CaseTree {
    enum class Kind : std::uint8_t { kAll, kAny, kBound };
    struct Node {
        Kind kind = Kind::kAll;
        std::vector<std::uint32_t> children;  // of kAll (none: true), kAny (none: false)
        std::uint32_t sum = 0;                // of kBound
        bool upper = false;
        std::int64_t limit = 0;
    };
    std::vector<Node> nodes;
    std::vector<LinearSum> sums;  // no two alike
    std::uint32_t root = 0;

    CaseTree(const PlainNet& net, const Predicate& predicate);

 private:
    std::uint32_t add(Node node);
    std::uint32_t bound(const LinearSum& sum, bool upper, std::int64_t limit);
    std::uint32_t enabled(const PlainNet& net, std::uint32_t t);
    std::uint32_t disabled(const PlainNet& net, std::uint32_t t);
    std::vector<std::uint32_t> place_sum_;  // per place: its number in `sums`, or kNone
    std::uint32_t place_bound(std::uint32_t place, bool upper, std::int64_t limit);
};

}  // namespace puppetri::proof
