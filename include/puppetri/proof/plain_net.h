// SPDX-License-Identifier: MIT
// The plain untimed net: places hold numbers, transitions take, give, read and are inhibited. What
// structure, explorers and decision diagrams work on. Made from a compiled net; `exact` says
// whether the net has anything that this picture leaves out (time, priorities, data, identity,
// events): then its graph is an over-approximation of the net's behaviours.
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "puppetri/net/net.h"

namespace puppetri::proof {

using Marking = std::vector<std::uint32_t>;  // tokens per place

struct PlainNet {
    // Rows per transition, entries in order of places, parallel arcs of one kind added up (reads
    // and inhibitors of one place: the strictest). A read place may also be taken from: enabled if
    // it has at least max(read, take).
    net::Rows<net::Weighted> takes, gives, reads;
    net::Rows<net::Weighted> unless;  // fewer than `weight` tokens
    Marking initial;
    // Per transition. A higher level blocks lower ones only where the net's time and events allow
    // to say so (docs/semantics.md); 0 for all where nothing may be said.
    std::vector<std::uint32_t> level;
    bool has_levels = false;
    // True if a delay, event or free guard may keep the transition from firing for ever or for a
    // while: it may fire, but does not count as enabled when death is decided.
    std::vector<std::uint8_t> optional;
    // Why the picture is not the whole net, an element each: "place a.flight has a duration".
    // Empty: exact.
    std::vector<std::string> left_out;

    std::uint32_t place_count() const { return static_cast<std::uint32_t>(initial.size()); }
    std::uint32_t transition_count() const { return takes.size(); }
    bool exact() const { return left_out.empty(); }
    bool has_inhibitors() const { return !unless.items.empty(); }
    // Enabled by its arcs alone, levels apart.
    bool enabled(std::span<const std::uint32_t> marking, std::uint32_t t) const;
    // Needs enabled(); fires in place.
    // Gives  false if a count would pass 2^32 - 1 (the marking is left as it was).
    bool fire(std::span<std::uint32_t> marking, std::uint32_t t) const;
};

// Places, transitions and their indices are those of the net. `all P` arcs, tokens with attributes,
// data and guards are over-approximated or, where they cannot be, reported in left_out with
// `unsound` set, and then nothing may be concluded from the picture.
struct Plain {
    PlainNet net;
    bool unsound = false;
};
Plain plain(const net::Net& net);

}  // namespace puppetri::proof
