// SPDX-License-Identifier: MIT
// What a draft uses beyond places, transitions, weights and tokens, element by element, and which
// format has words for it.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "puppetri/io/net_file.h"

namespace puppetri::io {

enum class NetFeature : std::uint8_t {
    kInhibitors,
    kReads,
    kResets,
    kUnready,     // arcs that ask whether a token is ready, or do not
    kPriorities,  // of transitions without delay
    kOdds,        // constant, of transitions without delay
    kOtherOdds,
    kExponential,  // delays with a constant mean
    kIntervals,    // constant delays, a .. b
    kAtLeast,      // [a,w[
    kOtherDelays,
    kInfiniteServers,
    kOtherServers,  // more than one, and memories
    kCapacities,
    kPlaceTimes,  // constant, an interval, exponential
    kOtherPlaceTimes,
    kAttributes,
    kMovements,
    kGuards,
    kData,
    kEvents,
    kSources,      // transitions without any input, in nets without time
    kComposition,  // holdings, fusions, rendezvous, refinements
    kStatements,   // rules, states, final markings: not behaviour
};
const char* name_of(NetFeature feature);  // "inhibitor arcs"

struct FeatureUse {
    NetFeature feature;
    std::string element;
    SourceSpan where;
};
std::vector<FeatureUse> features_of(const net::NetDraft& draft);
bool can_say(NetFormat format, NetFeature feature);

// Without duration of its own: every token is ready at once.
bool is_untimed(const net::PlaceDraft& place);
// Nothing takes time.
bool is_timeless(const net::NetDraft& draft);
// The mean in seconds of an exponential delay with one server or infinitely many; nothing for
// others.
bool is_exponential(const net::DurationDraft& delay, double& mean);
std::int64_t initial_tokens(const net::PlaceDraft& place);
// What an arc is where every token is ready at once.
net::ArcKind plain_kind(net::ArcKind kind);

}  // namespace puppetri::io
