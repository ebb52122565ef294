// SPDX-License-Identifier: MIT
// Lowering with the maps that `compile` keeps: where each element of the draft went.
#pragma once
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "puppetri/base/diagnostic.h"
#include "puppetri/net/draft.h"

namespace puppetri::net {

struct Lowered {
    NetDraft net;                          // no fusions, rendezvous, holdings, refinements left
    std::vector<std::uint32_t> place_map;  // of the draft -> of `net`
    std::vector<std::uint32_t> transition_map;
    std::vector<std::pair<std::string, std::uint32_t>> place_aliases;  // old names of fused places
    // Kept from the refinements: the way out of a module must leave it empty.
    struct Clean {
        std::uint32_t transition = 0;
        std::uint32_t refinement = 0;
    };
    std::vector<Clean> clean;
    std::vector<RefinementDraft> refinements;
};

// What the transitions before became; more or fewer than one only of ends of channels.
struct Met {
    std::vector<std::vector<std::uint32_t>> products;
};
Met meet_transitions(NetDraft& net, Diagnostics& defects);  // as meet() of net/net.h

// Appends what is wrong to `defects`; the result is usable only if that added no error.
Lowered lower_draft(const NetDraft& draft, Diagnostics& defects);

// One more defect.
void report(Diagnostics& list, const char* code, const SourceSpan& where, std::string element,
            std::string message, std::string remedy, Severity severity = Severity::kError);

}  // namespace puppetri::net
