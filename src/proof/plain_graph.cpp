// SPDX-License-Identifier: MIT
// The explored net as a graph: once through to number the states and count the edges, once more to
// write the edges into rows of exactly their size.
#include <algorithm>

#include "puppetri/proof/explorer.h"
#include "run_alone.h"
#include "search.h"
#include "stubborn.h"
#include "worker.h"

namespace puppetri::proof {

struct PlainStates {
    PlainNet net;
    Search::Form form;
};

namespace {

constexpr std::uint32_t kLookEvery = 4096;  // states

template <unsigned kWords>
void fill(Search& search, std::span<const CompiledPredicate> atoms, std::uint32_t expanded,
          Graph& graph) {
    Own own;
    Worker<kWords, false> worker(search, own);
    // Many atoms read the same places: each is unpacked once per state.
    std::vector<std::uint32_t> read =
        search.options.final != nullptr ? search.final.places() : std::vector<std::uint32_t>();
    for (const CompiledPredicate& atom : atoms) {
        const std::vector<std::uint32_t> places = atom.places();
        read.insert(read.end(), places.begin(), places.end());
    }
    std::sort(read.begin(), read.end());
    read.erase(std::unique(read.begin(), read.end()), read.end());
    Marking marking(read.empty() ? 0 : read.back() + std::size_t{1});
    const std::uint64_t row = (atoms.size() + 63) / 64;
    const auto states = static_cast<std::uint32_t>(graph.flags.size());
    for (std::uint32_t id = 0; id < states; ++id) {
        if (id % kLookEvery == 0) {
            search.look(0, 0);
        }
        worker.look_at(id);
        for (const std::uint32_t place : read) {
            marking[place] = worker.tokens(place);
        }
        for (std::size_t a = 0; a < atoms.size(); ++a) {
            if (atoms[a].holds(marking)) {
                graph.atoms.may[id * row + a / 64] |= std::uint64_t{1} << (a & 63);
            }
        }
        if (search.options.final != nullptr && search.final.holds(marking)) {
            graph.flags[id] |= Graph::kFinal;
        }
        if (id >= expanded || search.stop) {
            graph.flags[id] |= Graph::kCut;
            graph.edges.starts.push_back(static_cast<std::uint32_t>(graph.edges.items.size()));
            continue;
        }
        std::uint64_t any = 0, alive = 0;
        for (std::uint32_t w = 0; w < search.form.scanner->words(); ++w) {
            any |= worker.sight().enabled[w];
            alive |= worker.sight().enabled[w] & search.alive[w];
        }
        if (any != 0 && alive == 0) {
            graph.flags[id] |= Graph::kOptional;
        }
        worker.successors(id, [&](std::uint32_t label, std::uint32_t target) {
            graph.edges.items.push_back({label, target});
        });
        graph.edges.starts.push_back(static_cast<std::uint32_t>(graph.edges.items.size()));
    }
    graph.atoms.must = graph.atoms.may;
}

}  // namespace

PlainGraph build_graph(const PlainNet& net, std::span<const Predicate> atoms,
                       const Predicate* final, const Budget& budget) {
    ExploreOptions options;
    options.witnesses = true;
    options.final = final;
    Search search(net, options, budget);
    run_alone(search, false, ~std::uint64_t{0});
    std::vector<CompiledPredicate> compiled;
    for (const Predicate& atom : atoms) {
        compiled.emplace_back(net, atom);
    }
    PlainGraph out;
    Graph& graph = out.graph;
    graph.exact = net.exact();
    const std::uint64_t states = search.own.states;
    const std::uint64_t row = (atoms.size() + 63) / 64;
    const std::uint64_t bytes = search.bytes() + search.own.edges * sizeof(Edge) +
                                states * (sizeof(std::uint32_t) + 1 + 16 * row);
    const bool fits = bytes <= budget.bytes && search.own.edges < ~std::uint32_t{0};
    if (!fits) {
        search.end(Ended::kMemory);
    }
    // A search that was ended is not gone through again: its states are there, cut. But for one
    // that was to find so many states only: what they lead to is known.
    const Ended ended = search.ended;
    const bool again = fits && (ended == Ended::kDone || search.ended_by_count);
    search.counts_states = false;
    search.stop = !again;
    if (again) {
        graph.edges.items.reserve(search.own.edges);
    }
    graph.edges.starts.reserve(states + 1);
    graph.flags.assign(states, 0);
    graph.atoms.atoms = static_cast<std::uint32_t>(atoms.size());
    graph.atoms.may.assign(states * row, 0);
    const std::uint32_t expanded = again ? search.own.head : 0;
    switch (search.form.packing.words) {
        case 1:
            fill<1>(search, compiled, expanded, graph);
            break;
        case 2:
            fill<2>(search, compiled, expanded, graph);
            break;
        default:
            fill<0>(search, compiled, expanded, graph);
    }
    graph.ended = search.ended;
    out.states = std::make_shared<const PlainStates>(PlainStates{net, std::move(search.form)});
    return out;
}

Marking PlainGraph::marking(std::uint32_t state) const {
    return marking_of(states->form, state, states->net.place_count());
}

std::uint64_t PlainGraph::bytes() const { return states->form.store->bytes(); }

std::vector<std::uint32_t> PlainGraph::firings_to(std::uint32_t state) const {
    return proof::firings_to(states->net, states->form, state);
}

}  // namespace puppetri::proof
