// SPDX-License-Identifier: MIT
// A log from elsewhere held against a net: could the net have done this? Firing by firing, at the
// logged times, with what a log does not tell (how long random durations lasted, whether the
// outside made an event occur) chosen so that it fits, where that is possible.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "puppetri/base/time.h"
#include "puppetri/net/net.h"

namespace puppetri::run {

struct Observed {
    SimTime at;
    net::TransitionIndex transition;
    bool operator==(const Observed&) const = default;
};

struct ReplayOptions {
    // Logged times may be wrong by so much, each, so that what lasts may seem twice as much longer
    // or shorter.
    SimTime tolerance = {};
    // Transitions that the log never mentions fire unseen as soon as they can, instead of being
    // missed.
    bool unlogged_fire = false;
    SimTime beat = {kTicksPerSecond};  // of paced nets
};

struct Deviation {
    enum class Kind : std::uint8_t {
        kCannotFire,  // tokens, guard, inhibitor, event, or not yet
        kOvertaken,   // another one that can fire too has a higher priority
        kMissed,      // the net would have fired something before, and the log does not
        kOutOfOrder,  // the log goes back in time
        kFault,       // firing it stops the net: a datum leaves its range, ...
    };
    Kind kind = Kind::kCannotFire;
    std::uint64_t index = 0;  // of the logged firing
    SimTime at;               // when the net and the log part
    // False: something before was chosen that the log leaves open (which of several tokens with
    // attributes, what fired unseen), and another choice might fit.
    bool certain = true;
    // One sentence each, naming elements: what is in the way.
    std::vector<std::string> reasons;
    std::vector<net::TransitionIndex> could_fire;  // at that moment
};

struct Replayed {
    std::uint64_t firings = 0;  // of the log that the net could follow
    std::uint64_t unseen = 0;   // firings that the log does not have (unlogged_fire)
    std::optional<Deviation> deviation;
    // The state after the last firing that it could follow.
    std::vector<std::uint32_t> tokens;  // by place
    std::vector<Value> data;
};

// Follows the log until it ends or the net cannot.
// Gives   durations, delays and occurrences of events that the log leaves open are taken in its
//         favour; where that takes a guess, a deviation is not certain.
// Cost    one engine step per firing, and one snapshot where several tokens come into question.
Replayed replay(const net::Net& net, std::span<const Observed> log,
                const ReplayOptions& options = {});

}  // namespace puppetri::run
