// SPDX-License-Identifier: MIT
// Repairs that theory gives: one more place that keeps the net out of what a rule forbids.
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "puppetri/proof/plain_net.h"
#include "puppetri/proof/predicate.h"
#include "puppetri/proof/siphons.h"

namespace puppetri::proof {

// A place to add: it starts with `tokens`; each transition in `takes` takes so many of it (one that
// takes and gives is listed in both).
struct MonitorPlace {
    struct Arc {
        std::uint32_t transition = 0;
        std::uint32_t weight = 1;
        bool operator==(const Arc&) const = default;
    };
    std::uint32_t tokens = 0;
    std::vector<Arc> takes, gives;  // in order of transitions
};

struct SupervisorAnswer {
    bool possible = false;
    MonitorPlace place;
    LinearSum sum;  // what is kept at most `limit`: what was asked for, perhaps with more places
    std::int64_t limit = 0;
    // If not: the sum is above the limit already, or a transition that nobody may hold back makes
    // it grow.
    std::string reason;
    std::uint32_t transition = ~std::uint32_t{0};
};

// Keeps sum <= limit for ever by a place with sum + tokens(place) = limit: its changes are -sum C,
// its initial tokens limit - sum m0. The least restrictive such control when all transitions may be
// held back. `uncontrollable` per transition (events and movements decide): the place may not take
// from these. Where it would, places are added to the sum from which such a transition takes, as
// long as that makes it harmless (the sum stays an upper bound of what was asked for); that forbids
// more than necessary, and where it does not end the answer is no.
// The place keeps the bound; it may make new deadlocks: prove again.
// Source  Moody, Antsaklis: Supervisory Control of Discrete Event Systems Using Petri Nets, 1998,
//         chapter 3 (place invariants) and 4 (uncontrollable transitions); Yamalidou, Moody,
//         Lemmon, Antsaklis, Automatica 32, 1996.
SupervisorAnswer supervise(const PlainNet& net, const LinearSum& sum, std::int64_t limit,
                           std::span<const std::uint8_t> uncontrollable = {});

// Keeps a siphon from being emptied: at least one token stays in it (ordinary nets).
// Source  Ezpeleta, Colom, Martinez: A Petri net based deadlock prevention policy for flexible
//         manufacturing systems, IEEE TRA 11, 1995; Moody, Antsaklis 1998, chapter 5.
SupervisorAnswer monitor_siphon(const PlainNet& net, const PlaceSet& siphon,
                                std::span<const std::uint8_t> uncontrollable = {});

// The empty siphon that explains a dead marking of an ordinary net: the greatest one among its
// empty places; empty where weights or inhibitors are to blame.
PlaceSet siphon_of_deadlock(const PlainNet& net, std::span<const std::uint32_t> dead_marking);

// The net with the place added (as its last place).
PlainNet with_monitor(const PlainNet& net, const MonitorPlace& place);

}  // namespace puppetri::proof
