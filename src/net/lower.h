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

// Transitions that meet others, and the plain ones that they have become.
struct Meets {
    std::uint32_t transition = 0;  // before meeting
    std::string path;
    SourceSpan where;
    std::uint32_t group = 0;  // those of one channel; a rendezvous has a group of its own
    std::vector<std::uint32_t> products;
};

// Warns of those that can never fire, since no token ever comes to a place that they need; where
// others of the group can, it is a word that is not used here, and a note.
void warn_of_dead_meetings(const NetDraft& net, const std::vector<Meets>& meetings,
                           Diagnostics& defects);

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
