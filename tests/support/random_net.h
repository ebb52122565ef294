// SPDX-License-Identifier: MIT
// Random small nets that use every clause of the kernel, alone and together.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "puppetri/base/random.h"
#include "puppetri/net/draft.h"

namespace puppetri::test {

// What a random net may use; each net uses a random part of it.
struct Features {
    bool timed = true;       // constant durations, scheduled events
    bool intervals = true;   // durations and delays a .. b
    bool delays = true;      // with all memories
    bool inhibitors = true;  // unless, unless ready
    bool reads = true;       // with, while
    bool priorities = true;
    bool cuts = true;     // now, all, time left
    bool data = true;     // guards, assignments
    bool records = true;  // attributes, patterns, disciplines, order
    bool any = true;      // places whose tokens are drawn
    bool capacities = true;
    bool events = true;    // scheduled, raised, consumed, sensors, open places
    bool siblings = true;  // as P
    bool odds = true;
    bool weights = true;
    bool servers = true;      // delays with several servers
    bool holdings = true;     // for d
    bool expressions = true;  // durations computed from data and attributes
};

// The unit of all its times, in ticks.
inline constexpr std::int64_t kRandomNetUnit = 1000;

net::NetDraft random_net(RandomStream& stream, const Features& features = {});

// The same net with places, transitions, data and events declared in another order.
net::NetDraft reordered(const net::NetDraft& draft, RandomStream& stream);

// A few lines that show the net, for messages of failed tests.
std::string show(const net::NetDraft& draft);

}  // namespace puppetri::test
