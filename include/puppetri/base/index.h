// SPDX-License-Identifier: MIT
// Typed indices: a place cannot be passed where a transition is wanted. The default value means
// "none".
#pragma once
#include <compare>
#include <cstdint>

namespace puppetri {

template <class Tag>
struct Index {
    static constexpr std::uint32_t kNone = ~std::uint32_t{0};

    std::uint32_t value = kNone;

    constexpr bool valid() const { return value != kNone; }
    auto operator<=>(const Index&) const = default;
};

}  // namespace puppetri
