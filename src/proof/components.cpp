// SPDX-License-Identifier: MIT
// Connected components by union and find, and cones of influence by a work list.
#include "puppetri/proof/components.h"

#include <algorithm>

#include "disjoint_sets.h"
#include "puppetri/proof/slice.h"

namespace puppetri::proof {

namespace {

constexpr std::uint32_t kNone = ~std::uint32_t{0};

using ArcRows = net::Rows<net::Weighted> PlainNet::*;
constexpr ArcRows kArcs[] = {&PlainNet::takes, &PlainNet::gives, &PlainNet::reads,
                             &PlainNet::unless};

// The part with the marked places and transitions; arcs to other places are left out.
SubNet part(const PlainNet& net, const std::vector<std::uint8_t>& keep_place,
            const std::vector<std::uint8_t>& keep_transition) {
    SubNet out;
    std::vector<std::uint32_t> now(net.place_count(), kNone);
    for (std::uint32_t p = 0; p < net.place_count(); ++p) {
        if (keep_place[p] != 0) {
            now[p] = static_cast<std::uint32_t>(out.places.size());
            out.places.push_back(p);
            out.net.initial.push_back(net.initial[p]);
        }
    }
    for (std::uint32_t t = 0; t < net.transition_count(); ++t) {
        if (keep_transition[t] == 0) {
            continue;
        }
        out.transitions.push_back(t);
        for (const ArcRows rows : kArcs) {
            net::Rows<net::Weighted>& to = out.net.*rows;
            for (const net::Weighted& w : (net.*rows).row(t)) {
                if (now[w.place] != kNone) {
                    to.items.push_back({now[w.place], w.weight});
                }
            }
            to.starts.push_back(static_cast<std::uint32_t>(to.items.size()));
        }
        out.net.level.push_back(net.level[t]);
        out.net.optional.push_back(net.optional[t]);
    }
    out.net.has_levels = net.has_levels;
    out.net.left_out = net.left_out;
    return out;
}

}  // namespace

Components components(const PlainNet& net) {
    const std::uint32_t places = net.place_count(), transitions = net.transition_count();
    DisjointSets sets(places + transitions);
    for (std::uint32_t t = 0; t < transitions; ++t) {
        for (const ArcRows rows : kArcs) {
            for (const net::Weighted& w : (net.*rows).row(t)) {
                sets.join(w.place, places + t);
            }
        }
        if (net.has_levels) {
            sets.join(places, places + t);
        }
    }
    Components out;
    std::vector<std::uint32_t> number = sets.numbered(out.count);
    out.of_transition.assign(number.begin() + places, number.end());
    number.resize(places);
    out.of_place = std::move(number);
    return out;
}

SubNet component(const PlainNet& net, const Components& parts, std::uint32_t which) {
    std::vector<std::uint8_t> keep_place, keep_transition;
    for (const std::uint32_t c : parts.of_place) {
        keep_place.push_back(c == which ? 1 : 0);
    }
    for (const std::uint32_t c : parts.of_transition) {
        keep_transition.push_back(c == which ? 1 : 0);
    }
    return part(net, keep_place, keep_transition);
}

SubNet slice(const PlainNet& net, std::span<const std::uint32_t> places) {
    std::vector<std::uint8_t> keep_place(net.place_count(), 0);
    std::vector<std::uint8_t> keep_transition(net.transition_count(), net.has_levels ? 1 : 0);
    // Who takes from a place or gives to it.
    net::Rows<std::uint32_t> changers;
    changers.starts.assign(net.place_count() + 1, 0);
    for (const ArcRows rows : {&PlainNet::takes, &PlainNet::gives}) {
        for (const net::Weighted& w : (net.*rows).items) {
            ++changers.starts[w.place + 1];
        }
    }
    for (std::uint32_t p = 0; p < net.place_count(); ++p) {
        changers.starts[p + 1] += changers.starts[p];
    }
    changers.items.resize(changers.starts.back());
    std::vector<std::uint32_t> next(changers.starts.begin(), changers.starts.end() - 1);
    for (std::uint32_t t = 0; t < net.transition_count(); ++t) {
        for (const ArcRows rows : {&PlainNet::takes, &PlainNet::gives}) {
            for (const net::Weighted& w : (net.*rows).row(t)) {
                changers.items[next[w.place]++] = t;
            }
        }
    }
    std::vector<std::uint32_t> open;
    const auto add = [&](std::uint32_t p) {
        if (keep_place[p] == 0) {
            keep_place[p] = 1;
            open.push_back(p);
        }
    };
    const auto add_tested = [&](std::uint32_t t) {
        for (const ArcRows rows : {&PlainNet::takes, &PlainNet::reads, &PlainNet::unless}) {
            for (const net::Weighted& w : (net.*rows).row(t)) {
                add(w.place);
            }
        }
    };
    for (const std::uint32_t p : places) {
        add(p);
    }
    for (std::uint32_t t = 0; t < net.transition_count() && net.has_levels; ++t) {
        add_tested(t);  // any transition may block any other
    }
    while (!open.empty()) {
        const std::uint32_t p = open.back();
        open.pop_back();
        for (const std::uint32_t t : changers.row(p)) {
            if (keep_transition[t] == 0) {
                keep_transition[t] = 1;
                add_tested(t);
            }
        }
    }
    return part(net, keep_place, keep_transition);
}

}  // namespace puppetri::proof
