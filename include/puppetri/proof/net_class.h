// SPDX-License-Identifier: MIT
// The structural classes of a net, in the definitions of the Model Checking Contest (its form for
// models, section "Structural properties"). Each that does not hold names one element that
// breaks it. Reads count as an arc in and an arc out; with inhibitors no class is claimed.
#pragma once
#include <cstdint>

#include "puppetri/proof/plain_net.h"

namespace puppetri::proof {

struct NetClass {
    struct Property {
        bool holds = false;
        std::uint32_t breaker = ~std::uint32_t{0};  // a place or a transition, as said below
    };
    Property ordinary;              // all arcs have weight 1 (transition)
    Property simple_free_choice;    // who shares an input place has no other (transition)
    Property extended_free_choice;  // who shares an input place shares all (transition)
    Property state_machine;         // exactly one input and one output place each (transition)
    Property marked_graph;          // exactly one input and one output transition each (place)
    Property connected;             // as an undirected graph (place)
    Property strongly_connected;    // (place)
    Property source_place;          // there is a place without producers (it, if holds)
    Property sink_place;            // there is a place without consumers (it, if holds)
    Property source_transition;     // there is one without inputs (it, if holds)
    Property sink_transition;       // there is one without outputs (it, if holds)
    Property loop_free;             // no place is input and output of a transition (transition)
    Property conservative;          // as many tokens out as in (transition)
    Property subconservative;       // no more tokens out than in (transition)
};
NetClass classify(const PlainNet& net);

}  // namespace puppetri::proof
