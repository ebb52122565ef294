// SPDX-License-Identifier: MIT
#include "puppetri/notation/notation.h"

#include <algorithm>
#include <array>

#include "kinds.h"

namespace puppetri::notation {
namespace {

// In alphabetical order.
constexpr std::array kNotations = {
    Notation{"automaton", "a finite automaton whose states last", lower_automaton},
    Notation{"cells", "a cellular automaton whose cells may be figures", lower_cells},
    Notation{"equations",
             "differential, difference and delay equations beside the net, with crossings as "
             "events",
             lower_equations},
    Notation{"event_graph", "an event graph: events that schedule and cancel others",
             lower_event_graph},
    Notation{"linda", "a tuple space, and processes that put, take and read tuples", lower_linda},
    Notation{"logic", "a digital circuit of gates with delays", lower_logic},
    Notation{"markov", "a Markov chain in steps or in continuous time", lower_markov},
    Notation{"messages", "nodes that pass messages both ways along links", lower_messages},
    Notation{"pulses", "a pulse process on a signed, weighted digraph", lower_pulses},
    Notation{"queue", "a queueing network: sources, stations with servers, routes", lower_queue},
    Notation{"script", "a space-time-event script: who does what, from when to when, or when what",
             lower_script},
    Notation{"unit", "event units: sequence, parallel, choice, repeat, until, interrupt",
             lower_unit},
};

}  // namespace

std::span<const Notation> notations() { return kNotations; }

const Notation* find_notation(std::string_view kind) {
    const auto found = std::find_if(kNotations.begin(), kNotations.end(),
                                    [&](const Notation& n) { return n.kind == kind; });
    return found == kNotations.end() ? nullptr : &*found;
}

Lowered lower(const Notation& notation, const lang::Block& block, const lang::File& file) {
    Lowered out;
    out.net.name = block.name;
    out.net.parameters = block.parameters;
    out.net.span = block.span;
    notation.lower(block, file, out);
    return out;
}

}  // namespace puppetri::notation
