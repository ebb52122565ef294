// SPDX-License-Identifier: MIT
#include "zone.h"

#include <algorithm>

namespace puppetri::proof {

bool Zone::add(std::uint32_t i, std::uint32_t j, std::int64_t b) {
    if (b >= bound(i, j)) {
        return true;
    }
    if (would_be_empty(i, j, b)) {
        return false;
    }
    // Every path that gets shorter goes through the new bound once.
    for (std::uint32_t k = 0; k < size_; ++k) {
        const std::int64_t to = Bound::add(bound(k, i), b);
        if (to >= bound(k, j)) {
            continue;
        }
        for (std::uint32_t l = 0; l < size_; ++l) {
            set(k, l, std::min(bound(k, l), Bound::add(to, bound(j, l))));
        }
    }
    return true;
}

bool Zone::close() {
    for (std::uint32_t k = 0; k < size_; ++k) {
        for (std::uint32_t i = 0; i < size_; ++i) {
            const std::int64_t ik = bound(i, k);
            if (ik == Bound::kInfinite) {
                continue;
            }
            for (std::uint32_t j = 0; j < size_; ++j) {
                set(i, j, std::min(bound(i, j), Bound::add(ik, bound(k, j))));
            }
        }
    }
    for (std::uint32_t i = 0; i < size_; ++i) {
        if (bound(i, i) < Bound::at_most(0)) {
            return false;
        }
    }
    return true;
}

Zone Zone::chosen(std::span<const std::uint32_t> from) const {
    Zone z(static_cast<std::uint32_t>(from.size()));
    const auto old = [&](std::uint32_t k) { return k == 0 ? 0 : from[k - 1]; };
    for (std::uint32_t i = 0; i < z.size_; ++i) {
        for (std::uint32_t j = 0; j < z.size_; ++j) {
            const bool known = old(i) != kFresh && old(j) != kFresh;
            z.set(i, j,
                  i == j  ? Bound::at_most(0)
                  : known ? bound(old(i), old(j))
                          : Bound::kInfinite);
        }
    }
    return z;
}

void Zone::fall_until(std::uint32_t i) {
    for (std::uint32_t j = 0; j < size_; ++j) {
        set(j, 0, bound(j, i));
        set(0, j, bound(i, j));
    }
    set(0, 0, Bound::at_most(0));
}

bool Zone::contains(const Zone& other) const {
    for (std::size_t k = 0; k < bounds_.size(); ++k) {
        if (other.bounds_[k] > bounds_[k]) {
            return false;
        }
    }
    return true;
}

}  // namespace puppetri::proof
