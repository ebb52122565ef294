// SPDX-License-Identifier: MIT
// Some semiflows, fast: what packing needs are short ones, and none that are missing make it wrong.
// Whoever wants all minimal ones asks proof/semiflows.h.
#pragma once
#include <cstdint>
#include <utility>
#include <vector>

#include "puppetri/proof/plain_net.h"

namespace puppetri::proof {

// Non-negative weights of places whose sum over the tokens never changes.
struct Semiflow {
    std::vector<std::pair<std::uint32_t, std::int64_t>> terms;  // place, weight > 0; by place
    std::uint64_t total = 0;                                    // of the initial marking
};

// Cost    bounded whatever the net: at most `effort` elementary steps, about a nanosecond each.
// Source  Farkas' elimination (Martinez and Silva 1982), cut off: of too many combinations only
//         those with the smallest supports are made, so that what comes out is right but not all.
std::vector<Semiflow> few_semiflows(const PlainNet& net, std::uint64_t effort = 50'000'000);

}  // namespace puppetri::proof
