// SPDX-License-Identifier: MIT
// Does a place grow without bound? If so: which, and how.
#pragma once
#include <cstdint>
#include <vector>

#include "puppetri/proof/budget.h"
#include "puppetri/proof/plain_net.h"

namespace puppetri::proof {

struct BoundednessAnswer {
    enum Kind : std::uint8_t {
        kBounded,    // every place: for every timing
        kUnbounded,  // of the untimed net: `pump` can be repeated for ever after `prefix`, and adds
                     // tokens to `place` each time
        kUnknown,
    };
    Kind kind = kUnknown;
    const char* method = "";  // "semiflows", "sub-invariant", "coverability tree"
    std::uint32_t place = ~std::uint32_t{0};
    std::vector<std::uint32_t> prefix, pump;  // transitions
};

// First the structural test (some y > 0 with y C <= 0: bounded from any marking), then depth-first
// search for a marking that covers an ancestor. With inhibitors a pump counts only if no inhibitor
// of its transitions tests a place that it changes; with levels nothing is called unbounded. Source
// Karp, Miller: Parallel program schemata, JCSS 3, 1969 (unbounded iff some marking covers an
//         ancestor strictly); Murata 1989, section VI (structural boundedness).
BoundednessAnswer boundedness(const PlainNet& net, const Budget& budget);

}  // namespace puppetri::proof
