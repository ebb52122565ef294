// SPDX-License-Identifier: MIT
// Numbers that are known before a net is instantiated: what a lowering has to know to check a line
// or to make as many elements as it says.
#pragma once
#include <cstdint>
#include <optional>

#include "line.h"
#include "puppetri/base/rational.h"
#include "puppetri/lang/syntax.h"

namespace puppetri::notation {

// The exact value of numbers without units and of their sums, differences, products and quotients;
// nothing where the value has a unit, depends on a name or does not fit.
std::optional<Rational> literal_number(const lang::Expr& e);

// A whole number of this range.
// Fails  with a diagnostic that speaks of `wanted`, "the number of cells".
std::optional<std::int64_t> literal_whole(const lang::Expr& e, std::int64_t low, std::int64_t high,
                                          std::string_view wanted, Teller& teller);

}  // namespace puppetri::notation
