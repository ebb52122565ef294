// SPDX-License-Identifier: MIT
// Independent components: parts of a net that share nothing. Their product is never built: each is
// answered by itself and the answers are put together (dead: all are dead; live: all are live; a
// rule: in the part that it reads).
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "puppetri/net/draft.h"
#include "puppetri/net/net.h"
#include "puppetri/proof/plain_net.h"

namespace puppetri::proof {

struct Components {
    std::vector<std::uint32_t> of_place, of_transition;  // the number of its component
    std::vector<std::uint32_t> of_datum, of_event;       // of drafts only
    std::uint32_t count = 0;
};

// Connected by arcs of any kind. A net with levels is one component: a level blocks all lower ones,
// wherever they are.
Components components(const PlainNet& net);

// Of a whole draft (lowered or not): connected by arcs, data (guards, odds, assignments,
// durations), events, siblings, refinements, fusions, rendezvous. Where time passes, an instant
// settles all parts whatever their order, so priorities connect only what shares a place, a datum
// or an event (and is connected by that); in a draft without any time a higher priority may starve
// everything else, and all transitions of different priorities are connected.
Components components(const net::NetDraft& draft);

// The net of one part alone. Places, transitions, data, events keep their order.
struct SubNet {
    PlainNet net;
    std::vector<std::uint32_t> places, transitions;  // of the part -> of the whole
};
SubNet component(const PlainNet& net, const Components& parts, std::uint32_t which);

}  // namespace puppetri::proof
