// SPDX-License-Identifier: MIT
// The points of a sweep: every combination of the values that parameters take.
#pragma once
#include <string>
#include <vector>

#include "puppetri/base/result.h"
#include "puppetri/scene/settings.h"

namespace puppetri::cli {

// One parameter and its values, as in `a.out=2..6`.
struct Varied {
    std::string path;
    std::vector<std::string> values;
};

// PATH=VALUES, where VALUES are a list `10 s, 12 s, exponential(9 s)` (commas in brackets belong to
// the value), a range `2..6`, or a range with a step `0.5 s .. 2 s by 0.25 s`; a range's unit may
// stand once, at its end. Steps are exact decimals.
// Fails   with a sentence that says what is wrong.
Result<Varied, std::string> parse_varied(const std::string& text);

// All combinations, the last parameter fastest; one point without settings if nothing varies.
std::vector<std::vector<scene::Setting>> grid(const std::vector<Varied>& varied);

}  // namespace puppetri::cli
