// SPDX-License-Identifier: MIT
// How long things take in a graph whose edges carry ticks.
#include <algorithm>
#include <limits>
#include <queue>

#include "puppetri/proof/timed_exact.h"
#include "timed_builder.h"
#include "wide_integer.h"

namespace puppetri::proof {

namespace {

constexpr std::uint32_t kNone = ~std::uint32_t{0};
constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::max();

// Edge by edge back from a state.
Path path_back(const Graph& g, const std::vector<std::uint32_t>& by,
               const std::vector<std::uint32_t>& from, std::uint32_t state) {
    Path path;
    for (std::uint32_t s = state; s != g.initial; s = from[s]) {
        path.push_back(by[s]);
    }
    std::reverse(path.begin(), path.end());
    return path;
}

// Dijkstra over the low ends.
void shortest_time(const Graph& g, const StateBits& wanted, TimeToReach& out) {
    std::vector<std::int64_t> at(g.size(), kNever);
    std::vector<std::uint32_t> by(g.size(), kNone), from(g.size(), kNone);
    using Entry = std::pair<std::int64_t, std::uint32_t>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
    at[g.initial] = 0;
    open.emplace(0, g.initial);
    while (!open.empty()) {
        const auto [time, s] = open.top();
        open.pop();
        if (time != at[s]) {
            continue;
        }
        if (wanted[s]) {
            out.reachable = true;
            out.shortest = time;
            out.shortest_path = path_back(g, by, from, s);
            return;
        }
        for (std::uint32_t e = g.edges.starts[s]; e < g.edges.starts[s + 1]; ++e) {
            const std::uint32_t t = g.edges.items[e].target;
            const std::int64_t then = time + g.low_ticks[e];
            if (then < at[t]) {
                at[t] = then;
                by[t] = e;
                from[t] = s;
                open.emplace(then, t);
            }
        }
    }
}

// The longest way through states outside the set, which have no cycle: a topological order does.
void longest_time(const Graph& g, const StateBits& wanted, TimeToReach& out) {
    StateBits others = wanted;
    others.complement();
    const StrongComponents components = strong_components(g, &others);
    std::vector<std::uint32_t> order(components.count, kNone);
    for (std::uint32_t s = 0; s < g.size(); ++s) {
        if (components.of[s] != StrongComponents::kNone) {
            order[components.of[s]] = s;
        }
    }
    std::vector<std::int64_t> at(g.size(), -1);
    std::vector<std::uint32_t> by(g.size(), kNone), from(g.size(), kNone);
    at[g.initial] = 0;
    std::uint32_t last = kNone;
    for (std::size_t i = order.size(); i-- > 0;) {
        const std::uint32_t s = order[i];
        if (at[s] < 0) {
            continue;
        }
        for (std::uint32_t e = g.edges.starts[s]; e < g.edges.starts[s + 1]; ++e) {
            const std::uint32_t t = g.edges.items[e].target;
            const std::int64_t high = g.high_ticks[e];
            const std::int64_t then = at[s] == kNever || high == kNever ? kNever : at[s] + high;
            if (then > at[t]) {
                at[t] = then;
                by[t] = e;
                from[t] = s;
                if (wanted[t] && (last == kNone || then > at[last])) {
                    last = t;
                }
            }
        }
    }
    if (last != kNone) {
        out.longest = at[last];
        out.longest_path = path_back(g, by, from, last);
    }
}

}  // namespace

bool can_avoid(const Graph& g, const StateBits& wanted) {
    if (wanted[g.initial]) {
        return false;
    }
    StateBits others = wanted;
    others.complement();
    if (lasso_within(g, g.initial, others)) {
        return true;
    }
    StateBits start(g.size());
    start.add(g.initial);
    bool stops = false;
    reached_from(g, start, &others).for_each([&](std::uint32_t s) {
        stops = stops || (others[s] && (g.flags[s] & Graph::kCut) != 0);
    });
    return stops;
}

TimeToReach time_to_reach(const Graph& g, const StateBits& wanted) {
    TimeToReach out;
    shortest_time(g, wanted, out);
    out.avoidable = can_avoid(g, wanted);
    out.longest = kNever;
    if (out.reachable && !out.avoidable) {
        out.longest = 0;
        if (!wanted[g.initial]) {
            longest_time(g, wanted, out);
        }
    }
    return out;
}

namespace {

// Edges that lie on cycles with visits, and the search for cycles of a better ratio.
class Ratio {
 public:
    Ratio(const Graph& g, const std::vector<std::uint8_t>& visits) : g_(g), visits_(visits) {
        components_ = strong_components(g);
        std::vector<std::uint32_t> sources(g.edges.items.size());
        visited_.resize(components_.count, 0);
        for (std::uint32_t s = 0; s < g.size(); ++s) {
            for (std::uint32_t e = g.edges.starts[s]; e < g.edges.starts[s + 1]; ++e) {
                sources[e] = s;
                if (visits[e] != 0 && inside(s, e)) {
                    visited_[components_.of[s]] = 1;
                }
            }
        }
        for (std::uint32_t e = 0; e < sources.size(); ++e) {
            if (inside(sources[e], e) && visited_[components_.of[sources[e]]] != 0) {
                edges_.push_back(e);
                sources_.push_back(sources[e]);
            }
        }
    }
    bool empty() const { return edges_.empty(); }

    // Time passes on a cycle without a visit, beside one with visits; or nobody knows how long a
    // round takes at most.
    bool visits_get_rarer() const {
        Graph others;  // without the visits
        others.edges.starts.assign(g_.size() + 1, 0);
        for (std::size_t i = 0; i < edges_.size(); ++i) {
            others.edges.starts[sources_[i] + 1] += visits_[edges_[i]] == 0 ? 1 : 0;
        }
        for (std::uint32_t s = 0; s < g_.size(); ++s) {
            others.edges.starts[s + 1] += others.edges.starts[s];
        }
        for (const std::uint32_t e : edges_) {
            if (visits_[e] == 0) {
                others.edges.items.push_back(g_.edges.items[e]);
            }
        }
        others.flags.assign(g_.size(), 0);
        const StrongComponents inner = strong_components(others);
        for (std::size_t i = 0; i < edges_.size(); ++i) {
            const std::uint32_t a = inner.of[sources_[i]];
            const std::uint32_t b = inner.of[g_.edges.items[edges_[i]].target];
            const std::int64_t high = g_.high_ticks[edges_[i]];
            if (high == kNever || (visits_[edges_[i]] == 0 && a == b && high > 0)) {
                return true;
            }
        }
        return false;
    }

    // The cycle of the best ratio, beginning with any cycle that has a visit.
    Round best(bool least) {
        const std::vector<std::int64_t>& lasts = least ? g_.low_ticks : g_.high_ticks;
        Round round;
        round.cycle = any_cycle();
        for (;;) {
            round.ticks = round.visits = 0;
            for (const std::uint32_t e : round.cycle) {
                round.ticks += lasts[e];
                round.visits += visits_[e];
            }
            Path better = negative_cycle([&](std::uint32_t e) {
                const Wide w = Wide{lasts[e]} * round.visits - Wide{round.ticks} * visits_[e];
                return least ? w : -w;
            });
            if (better.empty()) {
                return round;
            }
            round.cycle = std::move(better);
        }
    }

 private:
    bool inside(std::uint32_t source, std::uint32_t e) const {
        return components_.of[source] == components_.of[g_.edges.items[e].target];
    }

    Path any_cycle() const {
        for (std::size_t i = 0; i < edges_.size(); ++i) {
            if (visits_[edges_[i]] != 0) {
                StateBits home(g_.size());
                home.add(sources_[i]);
                const std::uint32_t target = g_.edges.items[edges_[i]].target;
                if (auto back = shortest_path(g_, target, home)) {
                    Path cycle = {edges_[i]};
                    cycle.insert(cycle.end(), back->begin(), back->end());
                    return cycle;
                }
            }
        }
        return {};
    }

    // Bellman-Ford from everywhere at once. Gives a cycle of negative weight, or nothing.
    template <class Weight>
    Path negative_cycle(Weight&& weight) const {
        std::vector<Wide> at(g_.size(), 0);
        std::vector<std::uint32_t> by(g_.size(), kNone);
        for (std::uint32_t round = 1;; ++round) {
            bool changed = false;
            for (std::size_t i = 0; i < edges_.size(); ++i) {
                const std::uint32_t t = g_.edges.items[edges_[i]].target;
                const Wide then = at[sources_[i]] + weight(edges_[i]);
                if (then < at[t]) {
                    at[t] = then;
                    by[t] = static_cast<std::uint32_t>(i);
                    changed = true;
                }
            }
            if (!changed) {
                return {};
            }
            if (round % 16 == 0 || round >= g_.size()) {
                Path cycle = cycle_of(by);
                if (!cycle.empty()) {
                    return cycle;
                }
            }
        }
    }
    // A cycle of predecessors is negative.
    Path cycle_of(const std::vector<std::uint32_t>& by) const {
        std::vector<std::uint32_t> mark(g_.size(), kNone);
        for (std::uint32_t start = 0; start < g_.size(); ++start) {
            std::uint32_t s = start;
            while (mark[s] == kNone && by[s] != kNone) {
                mark[s] = start;
                s = sources_[by[s]];
            }
            if (by[s] == kNone || mark[s] != start) {
                mark[s] = mark[s] == kNone ? start : mark[s];
                continue;
            }
            Path cycle;
            const std::uint32_t first = s;
            do {
                cycle.push_back(edges_[by[s]]);
                s = sources_[by[s]];
            } while (s != first);
            std::reverse(cycle.begin(), cycle.end());
            return cycle;
        }
        return {};
    }

    const Graph& g_;
    const std::vector<std::uint8_t>& visits_;
    StrongComponents components_;
    std::vector<std::uint8_t> visited_;  // per component
    std::vector<std::uint32_t> edges_, sources_;
};

}  // namespace

std::optional<CycleTime> cycle_time(const Graph& graph, const std::vector<std::uint8_t>& visits) {
    Ratio ratio(graph, visits);
    if (ratio.empty()) {
        return std::nullopt;
    }
    CycleTime c;
    c.least = ratio.best(true);
    if (!ratio.visits_get_rarer()) {
        c.greatest = ratio.best(false);
    }
    return c;
}

}  // namespace puppetri::proof
