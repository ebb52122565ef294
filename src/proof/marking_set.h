// SPDX-License-Identifier: MIT
// A set of markings, exact: a table of open addressing over one array of counts.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

namespace puppetri::proof {

class MarkingSet {
 public:
    explicit MarkingSet(std::uint32_t places) : places_(places), slots_(1024, 0) {}

    std::uint32_t size() const { return count_; }
    std::uint64_t bytes() const { return (counts_.capacity() + slots_.capacity()) * 4; }
    // False: it was there already.
    bool insert(std::span<const std::uint32_t> marking) {
        if (2 * (count_ + 1) > slots_.size()) {
            grow();
        }
        std::uint32_t& slot = find(marking);
        if (slot != 0) {
            return false;
        }
        counts_.insert(counts_.end(), marking.begin(), marking.end());
        slot = ++count_;
        return true;
    }

 private:
    std::span<const std::uint32_t> marking(std::uint32_t i) const {
        return {counts_.data() + std::size_t{i} * places_, places_};
    }
    std::uint32_t& find(std::span<const std::uint32_t> m) {
        std::uint64_t h = 0x9e3779b97f4a7c15ull;
        for (const std::uint32_t n : m) {
            h = (h ^ n) * 0xff51afd7ed558ccdull;
            h ^= h >> 32;
        }
        for (std::size_t i = h & (slots_.size() - 1);; i = (i + 1) & (slots_.size() - 1)) {
            if (slots_[i] == 0) {
                return slots_[i];
            }
            const auto there = marking(slots_[i] - 1);
            bool same = true;
            for (std::uint32_t p = 0; p < places_ && same; ++p) {
                same = there[p] == m[p];
            }
            if (same) {
                return slots_[i];
            }
        }
    }
    void grow() {
        std::vector<std::uint32_t> old(slots_.size() * 2, 0);
        old.swap(slots_);
        for (const std::uint32_t s : old) {
            if (s != 0) {
                find(marking(s - 1)) = s;
            }
        }
    }

    std::uint32_t places_ = 0, count_ = 0;
    std::vector<std::uint32_t> counts_;
    std::vector<std::uint32_t> slots_;  // number + 1, or 0
};

}  // namespace puppetri::proof
