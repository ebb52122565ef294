// SPDX-License-Identifier: MIT
#include "place_order.h"

#include <algorithm>
#include <numeric>

#include "few_semiflows.h"
#include "puppetri/proof/semiflows.h"

namespace puppetri::proof {
namespace {

// Vertices are groups of places; an edge holds the vertices that a transition touches. Rows both
// ways.
struct Hypergraph {
    std::uint32_t vertices = 0;
    std::vector<std::vector<std::uint32_t>> edges;  // sorted, at least two vertices
    std::vector<std::vector<std::uint32_t>> edges_of;
};
using Order = std::vector<std::uint32_t>;  // vertices from the top down

Hypergraph hypergraph_of(const PlainNet& net, const PlaceGroups& groups) {
    Hypergraph graph;
    graph.vertices = static_cast<std::uint32_t>(groups.size());
    graph.edges_of.resize(groups.size());
    std::vector<std::uint32_t> group_of(net.place_count());
    for (std::uint32_t g = 0; g < groups.size(); ++g) {
        for (const std::uint32_t p : groups[g]) {
            group_of[p] = g;
        }
    }
    for (std::uint32_t t = 0; t < net.transition_count(); ++t) {
        std::vector<std::uint32_t> edge;
        for (const auto* rows : {&net.takes, &net.gives, &net.reads, &net.unless}) {
            for (const net::Weighted& w : rows->row(t)) {
                edge.push_back(group_of[w.place]);
            }
        }
        std::sort(edge.begin(), edge.end());
        edge.erase(std::unique(edge.begin(), edge.end()), edge.end());
        if (edge.size() > 1) {
            graph.edges.push_back(std::move(edge));
        }
    }
    // Transitions with the same places pull with one rope.
    std::sort(graph.edges.begin(), graph.edges.end());
    graph.edges.erase(std::unique(graph.edges.begin(), graph.edges.end()), graph.edges.end());
    for (std::uint32_t e = 0; e < graph.edges.size(); ++e) {
        for (const std::uint32_t v : graph.edges[e]) {
            graph.edges_of[v].push_back(e);
        }
    }
    return graph;
}

// How many levels firings walk through.
// Source  the unweighted metric of R. Siminiceanu, G. Ciardo, "New Metrics for Static Variable
//         Ordering in Decision Diagrams" (TACAS 2006). Their weight for firings high up misled us:
//         on LamportFastMutEx it prefers the worse direction of every order. Both are tried.
std::uint64_t span_of(const Hypergraph& graph, const Order& order) {
    std::vector<std::uint32_t> height(graph.vertices);
    for (std::uint32_t i = 0; i < order.size(); ++i) {
        height[order[i]] = i;
    }
    std::uint64_t sum = 0;
    for (const std::vector<std::uint32_t>& edge : graph.edges) {
        std::uint32_t top = 0, bottom = ~0u;
        for (const std::uint32_t v : edge) {
            top = std::max(top, height[v]);
            bottom = std::min(bottom, height[v]);
        }
        sum += top - bottom;
    }
    return sum;
}

// Each vertex moves to the mean of the centres of its edges, again and again.
// Source  F. Aloul, I. Markov, K. Sakallah, "FORCE: a fast and easy-to-implement variable-ordering
//         heuristic" (GLSVLSI 2003).
void force(const Hypergraph& graph, Order& order) {
    constexpr int kRounds = 60;
    std::vector<double> position(graph.vertices), centre(graph.edges.size());
    Order best = order;
    std::uint64_t best_span = span_of(graph, order);
    int idle = 0;
    for (int round = 0; round < kRounds && idle < 12; ++round, ++idle) {
        for (std::uint32_t i = 0; i < order.size(); ++i) {
            position[order[i]] = i;
        }
        for (std::uint32_t e = 0; e < graph.edges.size(); ++e) {
            double sum = 0;
            for (const std::uint32_t v : graph.edges[e]) {
                sum += position[v];
            }
            centre[e] = sum / double(graph.edges[e].size());
        }
        std::vector<double> wish = position;
        for (std::uint32_t v = 0; v < graph.vertices; ++v) {
            double sum = 0;
            for (const std::uint32_t e : graph.edges_of[v]) {
                sum += centre[e];
            }
            if (!graph.edges_of[v].empty()) {
                wish[v] = sum / double(graph.edges_of[v].size());
            }
        }
        std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
            return wish[a] != wish[b]           ? wish[a] < wish[b]
                   : position[a] != position[b] ? position[a] < position[b]
                                                : a < b;
        });
        if (const std::uint64_t span = span_of(graph, order); span < best_span) {
            best_span = span;
            best = order;
            idle = 0;
        }
    }
    order = best;
}

// Vertices one after the other, always one that leaves fewest edges half placed; of equals the one
// whose edges are the most nearly complete.
// Source  the idea of A. Noack (1999), used in MARCIE: M. Heiner et al. (2013).
Order narrow_front(const Hypergraph& graph, std::uint32_t start) {
    std::vector<std::uint32_t> missing(graph.edges.size());
    for (std::uint32_t e = 0; e < graph.edges.size(); ++e) {
        missing[e] = static_cast<std::uint32_t>(graph.edges[e].size());
    }
    std::vector<std::uint8_t> placed(graph.vertices, 0);
    Order order;
    std::uint32_t next = start;
    while (true) {
        placed[next] = 1;
        order.push_back(next);
        for (const std::uint32_t e : graph.edges_of[next]) {
            --missing[e];
        }
        if (order.size() == graph.vertices) {
            return order;
        }
        double best = -1e300;
        for (std::uint32_t v = 0; v < graph.vertices; ++v) {
            if (placed[v]) {
                continue;
            }
            double score = 0;
            for (const std::uint32_t e : graph.edges_of[v]) {
                const auto size = static_cast<std::uint32_t>(graph.edges[e].size());
                score += missing[e] == 1      ? 2.0
                         : missing[e] == size ? -1.0
                                              : double(size - missing[e]) / double(size);
            }
            score /= double(graph.edges_of[v].size() + 1);
            if (score > best) {
                best = score;
                next = v;
            }
        }
    }
}

using Places = std::vector<std::uint32_t>;

// Sets of places of which one is marked, with one token: semiflows of factors one and value one.
// All minimal ones if they are found in time, else those that a bounded search finds everywhere.
std::vector<Places> exclusive_places(const PlainNet& net, const Budget& budget) {
    Budget part = budget;
    part.seconds = std::max(0.5, std::min(5.0, budget.seconds / 10));
    part.states = 4000 + net.place_count();
    part.bytes = std::uint64_t{64} << 20;
    const Flows minimal = place_semiflows(net, part);
    std::vector<Places> units;
    if (minimal.complete) {
        for (const Flow& flow : minimal.flows) {
            std::uint64_t value = 0;
            Places places;
            for (const Flow::Term& term : flow.terms) {
                value += term.factor == 1 ? net.initial[term.index] : 2;
                places.push_back(term.index);
            }
            if (value == 1 && places.size() > 1) {
                units.push_back(std::move(places));
            }
        }
    } else {
        for (const Semiflow& flow : few_semiflows(net)) {
            Places places;
            for (const auto& [place, weight] : flow.terms) {
                places.push_back(place);
            }
            const bool plain = std::all_of(flow.terms.begin(), flow.terms.end(),
                                           [](const auto& term) { return term.second == 1; });
            if (plain && flow.total == 1 && places.size() > 1) {
                units.push_back(std::move(places));
            }
        }
    }
    return units;
}

// Places that exclude each other share a variable. Sets overlap: a ball is with one of the players,
// a player has one of the balls or none. Those of one size are taken, the large or the small ones
// first; what is left of a set whose other places are taken still excludes each other.
PlaceGroups exclusive_groups(const PlainNet& net, std::vector<Places> units, bool large_first) {
    std::stable_sort(units.begin(), units.end(), [&](const Places& a, const Places& b) {
        return large_first ? a.size() > b.size() : a.size() < b.size();
    });
    PlaceGroups groups;
    std::vector<std::uint8_t> taken(net.place_count(), 0);
    std::vector<Places> rests;
    const auto take = [&](Places& unit) {
        for (const std::uint32_t p : unit) {
            taken[p] = 1;
        }
        groups.push_back(std::move(unit));
    };
    const auto is_taken = [&](std::uint32_t p) { return taken[p] != 0; };
    for (Places& unit : units) {
        if (std::none_of(unit.begin(), unit.end(), is_taken)) {
            take(unit);
        } else {
            rests.push_back(std::move(unit));
        }
    }
    for (Places& rest : rests) {
        std::erase_if(rest, is_taken);
        if (rest.size() > 1) {
            take(rest);
        }
    }
    for (std::uint32_t p = 0; p < net.place_count(); ++p) {
        if (!taken[p]) {
            groups.push_back({p});
        }
    }
    // As the net declares them: authors write what belongs together side by side.
    std::sort(groups.begin(), groups.end());
    return groups;
}

struct Ranked {
    PlaceGroups groups;
    std::uint64_t span = 0;
};

// Orders of these groups, those with the shortest walks first, each followed by its reverse.
std::vector<Ranked> orders_of(const PlainNet& net, const PlaceGroups& groups) {
    const Hypergraph graph = hypergraph_of(net, groups);
    std::vector<Order> orders(1, Order(graph.vertices));
    std::iota(orders[0].begin(), orders[0].end(), 0u);
    if (graph.vertices > 2 && graph.vertices <= 1500) {
        orders.push_back(narrow_front(graph, 0));
        orders.push_back(narrow_front(graph, orders.back().back()));
    }
    for (std::size_t i = 0, plain = orders.size(); i < plain; ++i) {
        orders.push_back(orders[i]);
        force(graph, orders.back());
    }
    std::vector<std::pair<std::uint64_t, std::size_t>> ranking;
    for (std::size_t i = 0; i < orders.size(); ++i) {
        ranking.emplace_back(span_of(graph, orders[i]), i);
    }
    std::sort(ranking.begin(), ranking.end());
    // The declared order second: nets that count step by step are often told in their best order.
    const auto declared = std::find_if(ranking.begin(), ranking.end(),
                                       [](const auto& rank) { return rank.second == 0; });
    std::rotate(std::min(ranking.begin() + 1, declared), declared, declared + 1);
    std::vector<Ranked> result;
    for (const auto& [span, i] : ranking) {
        for (int direction = 0; direction < 2; ++direction) {
            Ranked ranked{.groups = {}, .span = span};
            for (const std::uint32_t v : orders[i]) {
                ranked.groups.push_back(groups[v]);
            }
            if (std::none_of(result.begin(), result.end(),
                             [&](const Ranked& r) { return r.groups == ranked.groups; })) {
                result.push_back(std::move(ranked));
            }
            std::reverse(orders[i].begin(), orders[i].end());
        }
    }
    return result;
}

}  // namespace

std::vector<PlaceGroups> place_orders(const PlainNet& net, const Budget& budget) {
    PlaceGroups single(net.place_count());
    for (std::uint32_t p = 0; p < net.place_count(); ++p) {
        single[p] = {p};
    }
    const std::vector<Places> units = exclusive_places(net, budget);
    std::vector<std::vector<Ranked>> kinds;
    std::vector<PlaceGroups> seen;
    for (const PlaceGroups& groups :
         {exclusive_groups(net, units, true), exclusive_groups(net, units, false), single}) {
        if (std::find(seen.begin(), seen.end(), groups) == seen.end()) {
            seen.push_back(groups);
            kinds.push_back(orders_of(net, groups));
        }
    }
    // Another kind goes first only where its walks are much shorter.
    for (std::size_t k = 1; k < kinds.size(); ++k) {
        if (kinds[k][0].span * 2 < kinds[0][0].span) {
            std::swap(kinds[0], kinds[k]);
        }
    }
    // A pair of directions of each kind in turn.
    std::vector<PlaceGroups> result;
    for (std::size_t pair = 0, left = 1; left > 0; pair += 2) {
        left = 0;
        for (std::vector<Ranked>& kind : kinds) {
            for (std::size_t i = pair; i < std::min(pair + 2, kind.size()); ++i, ++left) {
                result.push_back(std::move(kind[i].groups));
            }
        }
    }
    return result;
}

}  // namespace puppetri::proof
