// SPDX-License-Identifier: MIT
// Union and find with path halving; sets are numbered by their first elements, so that the result
// does not depend on the order of joins.
#pragma once
#include <cstdint>
#include <numeric>
#include <vector>

namespace puppetri::proof {

class DisjointSets {
 public:
    explicit DisjointSets(std::uint32_t count) : parent_(count) {
        std::iota(parent_.begin(), parent_.end(), 0u);
    }
    std::uint32_t find(std::uint32_t x) {
        while (parent_[x] != x) {
            parent_[x] = parent_[parent_[x]];
            x = parent_[x];
        }
        return x;
    }
    void join(std::uint32_t a, std::uint32_t b) {
        a = find(a);
        b = find(b);
        parent_[a < b ? b : a] = a < b ? a : b;
    }
    std::vector<std::uint32_t> numbered(std::uint32_t& count) {
        constexpr std::uint32_t kNone = ~std::uint32_t{0};
        std::vector<std::uint32_t> number(parent_.size(), kNone);
        count = 0;
        for (std::uint32_t i = 0; i < parent_.size(); ++i) {
            const std::uint32_t root = find(i);
            number[i] = root == i ? count++ : number[root];
        }
        return number;
    }

 private:
    std::vector<std::uint32_t> parent_;
};

}  // namespace puppetri::proof
