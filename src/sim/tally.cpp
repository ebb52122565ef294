// SPDX-License-Identifier: MIT
// Running means and variances.
#include "puppetri/sim/tally.h"

#include <algorithm>
#include <cmath>

namespace puppetri::sim {

void Tally::add(double x) {
    ++count_;
    const double off = x - mean_;
    mean_ += off / static_cast<double>(count_);
    squares_ += off * (x - mean_);
    low_ = std::min(low_, x);
    high_ = std::max(high_, x);
}

void Tally::merge(const Tally& other) {
    if (other.count_ == 0) {
        return;
    }
    const auto mine = static_cast<double>(count_), theirs = static_cast<double>(other.count_);
    const double off = other.mean_ - mean_;
    count_ += other.count_;
    mean_ += off * theirs / (mine + theirs);
    squares_ += other.squares_ + off * off * mine * theirs / (mine + theirs);
    low_ = std::min(low_, other.low_);
    high_ = std::max(high_, other.high_);
}

double Tally::variance() const {
    return count_ < 2 ? 0 : squares_ / static_cast<double>(count_ - 1);
}

double Tally::deviation() const { return std::sqrt(variance()); }

}  // namespace puppetri::sim
