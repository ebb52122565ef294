// SPDX-License-Identifier: MIT
#include "prop_timeline.h"

#include <algorithm>

#include "puppetri/base/require.h"

namespace puppetri::stage {

void PropTimeline::take(const Hold& hold) {
    PUP_REQUIRE(holds_.empty() || holds_.back().from <= hold.from);
    if (!holds_.empty() && holds_.back().from == hold.from) {
        holds_.back() = hold;
    } else {
        holds_.push_back(hold);
    }
}

const Hold& PropTimeline::at(SimTime at, bool before) const {
    const auto after = before
                           ? std::lower_bound(holds_.begin(), holds_.end(), at,
                                              [](const Hold& h, SimTime t) { return h.from < t; })
                           : std::upper_bound(holds_.begin(), holds_.end(), at,
                                              [](SimTime t, const Hold& h) { return t < h.from; });
    PUP_REQUIRE(after != holds_.begin());
    return *(after - 1);
}

}  // namespace puppetri::stage
