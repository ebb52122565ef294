// SPDX-License-Identifier: MIT
// The score as people read it: one line per actor and prop, time from left to right.
#pragma once
#include <string>

#include "puppetri/stage/performance.h"

namespace puppetri::cli {

// `width` columns of time from 0 to `end`; a movement begins with | and its name as far as there is room.
//     0 s                2 s                4 s
//     ana  |hold      |throw |ready
//     ball                   |fly  |
std::string score_chart(const stage::Performance& performance, SimTime end, int width);

}  // namespace puppetri::cli
