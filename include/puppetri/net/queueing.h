// SPDX-License-Identifier: MIT
// Queueing networks within a net: stations, sources and delays, found by their shape, however they
// were written. What is found says which queues grow without bound, and whether the network's long
// run is a product over its stations (sim/product_form.h).
//   A station is `start: queue + free -> service` and `end: service -> free + ...`, a source a
//   clock
// `tick: clock -> clock + ...` or a transition that takes nothing, `after` some time; a delay is a
// place that takes time and leads on. Services that may be interrupted, and so carry their rest
// with them, are found as well.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "puppetri/base/diagnostic.h"
#include "puppetri/net/draft.h"

namespace puppetri::net {

// A place where customers are for a while.
struct QueueCenter {
    std::string name;                 // path of `service`
    PlaceIndex queue, service, free;  // of delays: `service` alone
    std::uint32_t servers = 0;        // 0: a delay
    double mean_s = 0;                // of a service
    bool exponential = false;
    bool random = false;    // its time varies
    TransitionIndex start;  // of stations
    std::vector<TransitionIndex> ends;
    std::vector<double> shares;  // of those who leave, by `ends`; empty: not certain
    SourceSpan where;
};

struct QueueSource {
    PlaceIndex clock;  // invalid: a transition that takes nothing
    std::vector<TransitionIndex> ticks;
    std::vector<std::size_t> to;  // centers
    double rate_per_s = 0;
    bool exponential = false, random = false;
};

struct QueueNetwork {
    std::vector<QueueCenter> centers;
    std::vector<QueueSource> sources;
    PlaceIndex inside;  // a place that counts all customers, if there is one
    // Customers that certainly come, per second, from outside; and the share of those leaving i
    // who go to j, [i * n + j]. Where something else decides, the least share, 0.
    std::vector<double> arrivals_per_s, routing;
    std::uint64_t customers = 0;  // there at the beginning
    // Why the long run is no product over the stations; empty: it is one.
    std::vector<std::string> why_not;
};

// Finds what there is; the draft is one that compiles.
QueueNetwork find_queues(const NetDraft& draft);

// One warning, `grows-without-bound`, for every station to which more customers come in the long
// run than its servers can serve, by the traffic equations: each station passes on what comes, or
// what it can. Equality counts where times vary.
Diagnostics growing_queues(const NetDraft& draft);

}  // namespace puppetri::net
