// SPDX-License-Identifier: MIT
// An exploration by one worker, and the way back from a state to the initial marking.
#pragma once
#include <cstdint>
#include <vector>

#include "search.h"

namespace puppetri::proof {

// Until all is expanded, so many states are known, or the search is stopped.
void run_alone(Search& search, bool depth_first, std::uint64_t up_to_states);

Marking marking_of(const Search::Form& form, std::uint32_t id, std::uint32_t places);

// Needs  a store with parents.
// Gives  firings that lead to the state, or, with symmetry, to one that it stands for.
std::vector<std::uint32_t> firings_to(const PlainNet& net, const Search::Form& form,
                                      std::uint32_t id, const Symmetry& symmetry = {});

}  // namespace puppetri::proof
