// SPDX-License-Identifier: MIT
// Tally: what is kept of observations that come one by one.
#pragma once
#include <cstdint>
#include <limits>

namespace puppetri::sim {

// Count, mean, variance and extremes of a stream of numbers; mergeable.
// Source  B. P. Welford, "Note on a method for calculating corrected sums of squares and products",
//         Technometrics 4 (1962); merging after Chan, Golub and LeVeque (1979).
class Tally {
 public:
    void add(double x);
    // As if the other's observations had been added here.
    void merge(const Tally& other);

    std::uint64_t count() const { return count_; }
    double mean() const { return mean_; }  // 0 of none
    double variance() const;               // of the sample, divided by n - 1; 0 of fewer than two
    double deviation() const;              // its root
    double low() const { return low_; }    // +infinity of none
    double high() const { return high_; }  // -infinity of none

 private:
    std::uint64_t count_ = 0;
    double mean_ = 0, squares_ = 0;
    double low_ = std::numeric_limits<double>::infinity();
    double high_ = -std::numeric_limits<double>::infinity();
};

}  // namespace puppetri::sim
