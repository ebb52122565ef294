// SPDX-License-Identifier: MIT
// One pass over the arcs per property.
#include "puppetri/proof/net_class.h"

#include <algorithm>
#include <vector>

#include "puppetri/proof/components.h"

namespace puppetri::proof {

namespace {

constexpr std::uint32_t kNone = ~std::uint32_t{0};

// Input and output places of each transition: reads are both.
struct Graph {
    std::vector<std::vector<net::Weighted>> in, out;               // per transition
    std::vector<std::vector<std::uint32_t>> producers, consumers;  // per place

    explicit Graph(const PlainNet& net)
        : in(net.transition_count()),
          out(net.transition_count()),
          producers(net.place_count()),
          consumers(net.place_count()) {
        for (std::uint32_t t = 0; t < net.transition_count(); ++t) {
            const auto takes = net.takes.row(t), gives = net.gives.row(t);
            in[t].assign(takes.begin(), takes.end());
            out[t].assign(gives.begin(), gives.end());
            for (const net::Weighted& w : net.reads.row(t)) {
                add(in[t], w);
                add(out[t], w);
            }
            for (const net::Weighted& w : in[t]) {
                consumers[w.place].push_back(t);
            }
            for (const net::Weighted& w : out[t]) {
                producers[w.place].push_back(t);
            }
        }
    }
    static void add(std::vector<net::Weighted>& list, const net::Weighted& w) {
        const auto it =
            std::lower_bound(list.begin(), list.end(), w.place,
                             [](const net::Weighted& a, std::uint32_t p) { return a.place < p; });
        if (it == list.end() || it->place != w.place) {
            list.insert(it, w);
        } else {
            it->weight = std::max(it->weight, w.weight);
        }
    }
};

NetClass::Property holds_unless(std::uint32_t breaker) { return {breaker == kNone, breaker}; }

template <class Is>
std::uint32_t first(std::uint32_t count, Is is) {
    for (std::uint32_t i = 0; i < count; ++i) {
        if (is(i)) {
            return i;
        }
    }
    return kNone;
}

bool same_places(const std::vector<net::Weighted>& a, const std::vector<net::Weighted>& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [](const net::Weighted& x, const net::Weighted& y) {
                          return x.place == y.place && x.weight == y.weight;
                      });
}

std::uint64_t tokens(const std::vector<net::Weighted>& list) {
    std::uint64_t sum = 0;
    for (const net::Weighted& w : list) {
        sum += w.weight;
    }
    return sum;
}

// The first place that some walk from place 0 along (against) the arcs does not reach.
std::uint32_t unreached(const Graph& graph, bool forward) {
    const std::size_t places = graph.producers.size();
    if (places == 0) {
        return kNone;
    }
    std::vector<std::uint8_t> place(places, 0), transition(graph.in.size(), 0);
    std::vector<std::uint32_t> open = {0};
    place[0] = 1;
    while (!open.empty()) {
        const std::uint32_t p = open.back();
        open.pop_back();
        for (const std::uint32_t t : forward ? graph.consumers[p] : graph.producers[p]) {
            if (transition[t] != 0) {
                continue;
            }
            transition[t] = 1;
            for (const net::Weighted& w : forward ? graph.out[t] : graph.in[t]) {
                if (place[w.place] == 0) {
                    place[w.place] = 1;
                    open.push_back(w.place);
                }
            }
        }
    }
    return first(static_cast<std::uint32_t>(places),
                 [&](std::uint32_t p) { return place[p] == 0; });
}

}  // namespace

NetClass classify(const PlainNet& net) {
    const Graph graph(net);
    const std::uint32_t places = net.place_count(), transitions = net.transition_count();
    NetClass out;
    if (net.has_inhibitors()) {
        return out;
    }
    const auto heavy = [](const net::Weighted& w) { return w.weight != 1; };
    out.ordinary = holds_unless(first(transitions, [&](std::uint32_t t) {
        return std::any_of(graph.in[t].begin(), graph.in[t].end(), heavy) ||
               std::any_of(graph.out[t].begin(), graph.out[t].end(), heavy);
    }));
    std::uint32_t not_simple = kNone, not_extended = kNone;
    for (std::uint32_t p = 0; p < places; ++p) {
        const std::vector<std::uint32_t>& sharers = graph.consumers[p];
        for (const std::uint32_t t : sharers) {
            if (sharers.size() > 1 && graph.in[t].size() > 1) {
                not_simple = std::min(not_simple, t);
            }
            if (!same_places(graph.in[t], graph.in[sharers.front()])) {
                not_extended = std::min(not_extended, t);
            }
        }
    }
    out.simple_free_choice = holds_unless(not_simple);
    out.extended_free_choice = holds_unless(not_extended);
    out.state_machine = holds_unless(first(transitions, [&](std::uint32_t t) {
        return graph.in[t].size() != 1 || graph.out[t].size() != 1;
    }));
    out.marked_graph = holds_unless(first(places, [&](std::uint32_t p) {
        return graph.producers[p].size() != 1 || graph.consumers[p].size() != 1;
    }));
    const Components parts = components(net);
    out.connected = holds_unless(parts.count <= 1 ? kNone : first(places, [&](std::uint32_t p) {
        return parts.of_place[p] != 0;
    }));
    if (parts.count > 1) {
        out.connected.holds = false;  // the other part may have transitions only
    }
    // A transition without inputs or without outputs is on no walk from a place to a place.
    const std::uint32_t cut = std::min(unreached(graph, true), unreached(graph, false));
    out.source_transition.breaker =
        first(transitions, [&](std::uint32_t t) { return graph.in[t].empty(); });
    out.sink_transition.breaker =
        first(transitions, [&](std::uint32_t t) { return graph.out[t].empty(); });
    out.source_place.breaker =
        first(places, [&](std::uint32_t p) { return graph.producers[p].empty(); });
    out.sink_place.breaker =
        first(places, [&](std::uint32_t p) { return graph.consumers[p].empty(); });
    for (NetClass::Property* p :
         {&out.source_transition, &out.sink_transition, &out.source_place, &out.sink_place}) {
        p->holds = p->breaker != kNone;
    }
    out.strongly_connected = {cut == kNone && !out.source_transition.holds &&
                                  !out.sink_transition.holds && parts.count <= 1,
                              cut};
    out.loop_free = holds_unless(first(transitions, [&](std::uint32_t t) {
        return std::any_of(graph.in[t].begin(), graph.in[t].end(), [&](const net::Weighted& a) {
            return std::any_of(graph.out[t].begin(), graph.out[t].end(),
                               [&](const net::Weighted& b) { return a.place == b.place; });
        });
    }));
    out.conservative = holds_unless(first(
        transitions, [&](std::uint32_t t) { return tokens(graph.in[t]) != tokens(graph.out[t]); }));
    out.subconservative = holds_unless(first(
        transitions, [&](std::uint32_t t) { return tokens(graph.in[t]) < tokens(graph.out[t]); }));
    return out;
}

}  // namespace puppetri::proof
