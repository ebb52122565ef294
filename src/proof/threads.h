// SPDX-License-Identifier: MIT
// Several workers on one exploration.
#pragma once
#include <vector>

#include "search.h"

namespace puppetri::proof {

// Goes on with what one worker has begun (search.own), with up to so many threads; where there are
// none, with one.
// Gives  what each of them did; search.finished if everything was expanded.
std::vector<Own> run_together(Search& search, unsigned threads);

}  // namespace puppetri::proof
