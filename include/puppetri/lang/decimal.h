// SPDX-License-Identifier: MIT
// Decimals as people write them, read exactly.
#pragma once
#include <optional>
#include <string_view>

#include "puppetri/base/rational.h"

namespace puppetri::lang {

// Digits with at most one point and, behind them, at most one exponent: "12", "0.5", ".5", "1e-3".
// Fails  (nullopt) for any other text, a sign in front and the empty text among them, and for what
//        no Rational can be.
std::optional<Rational> parse_decimal(std::string_view text);

}  // namespace puppetri::lang
