// SPDX-License-Identifier: MIT
// Zones: sets of real points given by bounds of differences of two variables, as a matrix in its
// closed form (all bounds as tight as the others make them). Variable 0 is the number 0.
// Source  D. Dill, Timing assumptions and verification of finite-state concurrent systems (1989).
#pragma once
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace puppetri::proof {

// A bound "<= c" or "< c" in one word, so that tighter is smaller.
struct Bound {
    static constexpr std::int64_t kInfinite = std::numeric_limits<std::int64_t>::max();
    static constexpr std::int64_t kMost = std::int64_t{1} << 60;  // ticks beyond have no bound

    static constexpr std::int64_t at_most(std::int64_t c) {
        return c > kMost ? kInfinite : c < -kMost ? at_most(-kMost) : 2 * c + 1;
    }
    static constexpr std::int64_t below(std::int64_t c) {
        return c > kMost ? kInfinite : c < -kMost ? at_most(-kMost) : 2 * c;
    }
    static constexpr bool strict(std::int64_t b) { return (b & 1) == 0; }
    static constexpr std::int64_t limit(std::int64_t b) { return b >> 1; }
    static constexpr std::int64_t add(std::int64_t a, std::int64_t b) {
        if (a == kInfinite || b == kInfinite) {
            return kInfinite;
        }
        const std::int64_t c = limit(a) + limit(b);
        return strict(a) || strict(b) ? below(c) : at_most(c);
    }
};

class Zone {
 public:
    // The point 0 of so many variables besides the number.
    explicit Zone(std::uint32_t variables = 0)
        : size_(variables + 1), bounds_(std::size_t{size_} * size_, Bound::at_most(0)) {}

    std::uint32_t variables() const { return size_ - 1; }
    // Of x_i - x_j.
    std::int64_t bound(std::uint32_t i, std::uint32_t j) const {
        return bounds_[std::size_t{i} * size_ + j];
    }
    std::span<const std::int64_t> bounds() const { return bounds_; }
    void set(std::uint32_t i, std::uint32_t j, std::int64_t b) {
        bounds_[std::size_t{i} * size_ + j] = b;
    }
    // Adds x_i - x_j <= (or <) b to a closed zone and closes it again. False: nothing is left.
    // Cost   O(n^2).
    bool add(std::uint32_t i, std::uint32_t j, std::int64_t b);
    bool would_be_empty(std::uint32_t i, std::uint32_t j, std::int64_t b) const {
        return b < bound(i, j) && Bound::add(bound(j, i), b) < Bound::at_most(0);
    }
    // Closes any matrix. False: it is empty. Cost   O(n^3).
    bool close();
    // The new variable k is the old variable from[k - 1]; kFresh: nothing is known of it.
    static constexpr std::uint32_t kFresh = ~std::uint32_t{0};
    Zone chosen(std::span<const std::uint32_t> from) const;
    // Time passes until variable i is 0: all others fall by as much.
    void fall_until(std::uint32_t i);
    bool contains(const Zone& other) const;
    bool operator==(const Zone&) const = default;

 private:
    std::uint32_t size_ = 1;
    std::vector<std::int64_t> bounds_;
};

}  // namespace puppetri::proof
