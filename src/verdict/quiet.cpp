// SPDX-License-Identifier: MIT
#include "quiet.h"

#include <algorithm>
#include <map>
#include <utility>

#include "puppetri/net/tables.h"

namespace puppetri::verdict {
namespace {

using Idle = std::vector<std::uint8_t>;

bool fires(std::uint32_t label, const Idle& idle) {
    return label != proof::Edge::kPass && (label & proof::Edge::kEvent) == 0 &&
           (label >= idle.size() || idle[label] == 0);
}

// The nodes before each, along edges that are no firings.
class Before {
 public:
    Before(const Product& p, const Idle& idle) : starts_(p.size() + std::size_t{1}, 0) {
        for (std::uint64_t e = 0; e < p.targets.size(); ++e) {
            starts_[p.targets[e] + std::size_t{1}] += fires(p.label(e), idle) ? 0 : 1;
        }
        for (std::size_t n = 0; n < p.size(); ++n) {
            starts_[n + 1] += starts_[n];
        }
        sources_.resize(starts_.back());
        std::vector<std::uint64_t> next(starts_.begin(), starts_.end() - 1);
        for (std::uint32_t n = 0; n < p.size(); ++n) {
            for (std::uint64_t e = p.starts[n]; e < p.starts[n + 1]; ++e) {
                if (!fires(p.label(e), idle)) {
                    sources_[next[p.targets[e]]++] = n;
                }
            }
        }
    }
    // From the open nodes back along all edges: a node that `joins` is open as well.
    template <class Joins>
    void spread(std::vector<std::uint32_t> open, Joins&& joins) const {
        while (!open.empty()) {
            const std::uint32_t node = open.back();
            open.pop_back();
            for (std::uint64_t i = starts_[node]; i < starts_[node + std::size_t{1}]; ++i) {
                if (joins(sources_[i])) {
                    open.push_back(sources_[i]);
                }
            }
        }
    }

 private:
    std::vector<std::uint64_t> starts_;
    std::vector<std::uint32_t> sources_;
};

}  // namespace

Nodes quiet_for_ever(const Product& p, const Idle& idle) {
    Nodes quiet(p.size(), 1);
    std::vector<std::uint32_t> open;
    for (std::uint32_t n = 0; n < p.size(); ++n) {
        bool leaves = p.cut(n) || p.stops(n);
        for (std::uint64_t e = p.starts[n]; e < p.starts[n + 1]; ++e) {
            leaves = leaves || fires(p.label(e), idle);
        }
        if (leaves) {
            quiet[n] = 0;
            open.push_back(n);
        }
    }
    Before(p, idle).spread(std::move(open), [&](std::uint32_t source) {
        return std::exchange(quiet[source], std::uint8_t{0}) != 0;
    });
    return quiet;
}

Nodes quiet_perhaps(const Product& p, const Idle& idle, const proof::Waits* waits) {
    Nodes quiet(p.size(), 1);
    std::vector<std::uint64_t> ways(p.size(), 0);  // that stay among the quiet
    std::vector<std::uint32_t> open;
    for (std::uint32_t n = 0; n < p.size(); ++n) {
        for (std::uint64_t e = p.starts[n]; e < p.starts[n + 1]; ++e) {
            ways[n] += fires(p.label(e), idle) ? 0 : 1;
        }
        if (ways[n] == 0 && !p.rests(n) && !p.cut(n)) {
            quiet[n] = 0;
            open.push_back(n);
        }
    }
    Before(p, idle).spread(std::move(open), [&](std::uint32_t source) {
        return --ways[source] == 0 && !p.rests(source) && !p.cut(source) &&
               std::exchange(quiet[source], std::uint8_t{0}) != 0;
    });
    // Where no run goes round among them, it has to come to rest.
    std::vector<std::uint8_t> firings(p.targets.size(), 0);
    for (std::uint64_t e = 0; e < p.targets.size(); ++e) {
        firings[e] = fires(p.label(e), idle) ? 1 : 0;
    }
    if (endless(p, quiet, firings, waits)) {
        return quiet;
    }
    Nodes ends(p.size(), 0);
    for (std::uint32_t n = 0; n < p.size(); ++n) {
        ends[n] = p.rests(n) || p.cut(n) ? 1 : 0;
    }
    const std::vector<std::uint32_t> far = distances(p, ends, firings);
    for (std::uint32_t n = 0; n < p.size(); ++n) {
        quiet[n] = far[n] == kFar ? 0 : quiet[n];
    }
    return quiet;
}

std::vector<std::uint8_t> idle_firings(const net::Net& net) {
    const net::NetTables& n = net.tables();
    Idle out(net.transition_count(), 0);
    for (std::uint32_t t = 0; t < out.size(); ++t) {
        std::map<std::uint32_t, std::int64_t> change;
        bool plain = true;
        for (const net::Weighted& w : n.takes(t)) {
            change[w.place] -= w.weight;
            plain = plain && n.place[w.place].kind == net::PlaceKind::kCount;
        }
        for (const net::Weighted& w : n.gives(t)) {
            change[w.place] += w.weight;
            plain = plain && n.place[w.place].kind == net::PlaceKind::kCount;
        }
        if (n.transition[t].special != net::kNoIndex) {
            const net::Special& s = n.specials[n.transition[t].special];
            plain = plain && s.arcs.empty() && s.outputs.empty() && s.assignments.empty() &&
                    s.raises.empty() && s.must_be_clean.empty() && s.delay == net::kNoIndex;
        }
        out[t] = plain && std::all_of(change.begin(), change.end(),
                                      [](const auto& c) { return c.second == 0; })
                     ? 1
                     : 0;
    }
    return out;
}

}  // namespace puppetri::verdict
