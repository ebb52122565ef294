// SPDX-License-Identifier: MIT
// The score as people read it: one line per actor and prop, time from left to right.
#pragma once
#include <string>

#include "puppetri/stage/performance.h"

namespace puppetri::cli {

// `width` columns of time; a movement begins with | and its name as far as there is room, and lasts
// until its token leaves. Long runs are broken into bands, of which the first four are shown; `.`
// goes on from the band before.
//           0 s                2 s                4 s
//     ana   |hold      |throw |ready
//     ball                    |fly  |
std::string score_chart(const stage::Performance& performance, SimTime end, int width);

}  // namespace puppetri::cli
