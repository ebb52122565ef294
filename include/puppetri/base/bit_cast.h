// SPDX-License-Identifier: MIT
// std::bit_cast of C++20, which the standard library of Debian's emscripten does not have yet.
#pragma once
#include <type_traits>

#include "puppetri/base/bit_cast.h"

namespace puppetri {

template <class To, class From>
constexpr To bit_cast(const From& from) {
    static_assert(sizeof(To) == sizeof(From) && std::is_trivially_copyable_v<To> &&
                  std::is_trivially_copyable_v<From>);
    return __builtin_bit_cast(To, from);
}

}  // namespace puppetri
