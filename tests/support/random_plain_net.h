// SPDX-License-Identifier: MIT
// Random small plain nets with weights, read arcs, inhibitors, priorities, transitions that do not
// count as alive; and the obvious exploration of them, which knows nothing of packing.
#pragma once
#include <algorithm>
#include <cstdint>
#include <map>
#include <set>
#include <vector>

#include "puppetri/base/random.h"
#include "puppetri/proof/plain_net.h"
#include "puppetri/proof/predicate.h"

namespace puppetri::test {

struct PlainFeatures {
    bool inhibitors = true, reads = true, weights = true, levels = true, optional = true;
    bool conserving = false;  // as many tokens given as taken: always bounded
};

inline std::uint32_t below(RandomStream& stream, std::uint32_t n) {
    return static_cast<std::uint32_t>(stream.below(n));
}

inline proof::PlainNet random_plain_net(RandomStream& stream, const PlainFeatures& f) {
    proof::PlainNet net;
    const std::uint32_t places = 1 + below(stream, 7), transitions = 1 + below(stream, 8);
    for (std::uint32_t p = 0; p < places; ++p) {
        net.initial.push_back(below(stream, 3) == 0 ? 1 + below(stream, 3) : 0);
    }
    const auto row = [&](net::Rows<net::Weighted>& rows, std::uint32_t arcs, std::uint32_t most) {
        std::map<std::uint32_t, std::uint32_t> entries;
        for (std::uint32_t i = 0; i < arcs; ++i) {
            entries[below(stream, places)] +=
                f.weights && below(stream, 4) == 0 ? 1 + below(stream, most) : 1;
        }
        std::uint32_t sum = 0;
        for (const auto& [p, w] : entries) {
            rows.items.push_back({p, w});
            sum += w;
        }
        rows.starts.push_back(static_cast<std::uint32_t>(rows.items.size()));
        return sum;
    };
    const bool levels = f.levels && below(stream, 3) == 0;
    const bool optional = f.optional && below(stream, 3) == 0;
    const bool inhibitors = f.inhibitors && below(stream, 2) == 0;
    const bool reads = f.reads && below(stream, 2) == 0;
    for (std::uint32_t t = 0; t < transitions; ++t) {
        const std::uint32_t taken =
            row(net.takes, below(stream, 12) == 0 ? 0 : 1 + below(stream, 2), 3);
        if (f.conserving) {
            std::map<std::uint32_t, std::uint32_t> entries;
            for (std::uint32_t i = 0; i < taken; ++i) {
                ++entries[below(stream, places)];
            }
            for (const auto& [p, w] : entries) {
                net.gives.items.push_back({p, w});
            }
            net.gives.starts.push_back(static_cast<std::uint32_t>(net.gives.items.size()));
        } else {
            row(net.gives, below(stream, 3), 2);
        }
        row(net.reads, reads && below(stream, 3) == 0 ? 1 : 0, 2);
        row(net.unless, inhibitors && below(stream, 2) == 0 ? 1 : 0, 3);
        net.level.push_back(levels ? below(stream, 3) : 0);
        net.optional.push_back(optional && below(stream, 3) == 0 ? 1 : 0);
        net.has_levels = net.has_levels || net.level.back() != net.level[0];
    }
    return net;
}

struct NaiveGraph {
    std::vector<proof::Marking> markings;
    std::vector<std::vector<std::pair<std::uint32_t, std::uint32_t>>> edges;  // label, target
    bool complete = false;
};

// Breadth first; gives up beyond so many states.
inline NaiveGraph naive_graph(const proof::PlainNet& net, std::uint32_t most) {
    NaiveGraph g;
    std::map<proof::Marking, std::uint32_t> known;
    known[net.initial] = 0;
    g.markings.push_back(net.initial);
    for (std::uint32_t s = 0; s < g.markings.size(); ++s) {
        if (g.markings.size() > most) {
            return g;
        }
        g.edges.emplace_back();
        std::uint32_t highest = 0;
        std::vector<std::uint32_t> enabled;
        for (std::uint32_t t = 0; t < net.transition_count(); ++t) {
            if (net.enabled(g.markings[s], t)) {
                enabled.push_back(t);
                highest = std::max(highest, net.level[t]);
            }
        }
        for (const std::uint32_t t : enabled) {
            if (net.level[t] < highest) {
                continue;
            }
            proof::Marking next = g.markings[s];
            net.fire(next, t);
            const auto [it, fresh] =
                known.try_emplace(next, static_cast<std::uint32_t>(g.markings.size()));
            if (fresh) {
                g.markings.push_back(next);
            }
            g.edges[s].emplace_back(t, it->second);
        }
    }
    g.complete = true;
    return g;
}

// A linear inequality or an enabledness, or a few of them joined.
inline proof::Predicate random_predicate(RandomStream& stream, const proof::PlainNet& net,
                                         int depth = 2) {
    using proof::Predicate;
    const std::uint32_t kind = below(stream, depth > 0 ? 6 : 4);
    if (kind < 2) {
        proof::LinearSum sum;
        const std::uint32_t terms = 1 + below(stream, 2);
        for (std::uint32_t i = 0; i < terms; ++i) {
            const std::int64_t factor = static_cast<std::int64_t>(below(stream, 5)) - 2;
            sum.terms.push_back({below(stream, net.place_count()), factor});
        }
        const std::int64_t limit = static_cast<std::int64_t>(below(stream, 7)) - 2;
        return kind == 0 ? Predicate::at_most(sum, limit) : Predicate::at_least(sum, limit);
    }
    if (kind < 4) {
        const Predicate p = Predicate::enabled({below(stream, net.transition_count())});
        return kind == 2 ? p : p.negated();
    }
    std::vector<Predicate> parts;
    for (std::uint32_t i = 0; i < 2; ++i) {
        parts.push_back(random_predicate(stream, net, depth - 1));
    }
    return kind == 4 ? Predicate::all_of(parts) : Predicate::any_of(parts);
}

}  // namespace puppetri::test
