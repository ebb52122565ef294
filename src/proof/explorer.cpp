// SPDX-License-Identifier: MIT
// From a question to workers and back to an answer.
#include "puppetri/proof/explorer.h"

#include <algorithm>

#include "run_alone.h"
#include "search.h"
#include "stubborn.h"
#include "threads.h"

namespace puppetri::proof {

namespace {

// Smaller nets are explored before a second thread has started: that takes as long as about a
// thousand states.
constexpr std::uint64_t kWorthThreads = 3'000;

Finding finding_of(const Search& search, std::uint32_t state) {
    Finding f;
    if (state == StateStore::kNoState) {
        return f;
    }
    f.found = true;
    const std::uint32_t places = search.net.place_count();
    f.marking = marking_of(search.form, state, places);
    if (!search.options.witnesses) {
        return f;
    }
    f.firings = firings_to(search.net, search.form, state, search.symmetry);
    if (!search.symmetry.none()) {
        f.marking = search.net.initial;
        for (const std::uint32_t t : f.firings) {
            search.net.fire(f.marking, t);
        }
    }
    return f;
}

}  // namespace

Exploration explore(const PlainNet& net, const ExploreOptions& options, const Budget& budget) {
    Search search(net, options, budget);
    Exploration out;
    out.reduced =
        options.reduce && !net.has_levels && (options.find_dead || !options.goals.empty());
    if (out.reduced) {
        search.stubborn =
            std::make_unique<const Stubborn>(net, options.goals, options.find_dead, options.final);
    }
    // What is to be found soon is looked for in the depth, unless the way there should be short.
    const bool depth_first = options.stop_when_found && !options.witnesses;
    const bool threads = budget.threads > 1 && !depth_first;
    run_alone(search, depth_first, threads ? kWorthThreads : ~std::uint64_t{0});
    std::vector<Own> owns;
    if (threads && !search.stop && search.own.head < search.own.next) {
        owns = run_together(search, budget.threads);
    } else {
        owns.push_back(std::move(search.own));
        out.complete = depth_first ? owns[0].stack.empty() : owns[0].head == owns[0].next;
    }
    out.symmetric = !search.symmetry.none();
    out.ended = search.ended;
    out.complete = (out.complete || search.finished) && out.ended == Ended::kDone;
    out.bounds.assign(net.place_count(), 0);
    for (const Own& own : owns) {
        out.states += own.states;
        out.edges += own.edges;
        out.max_tokens_per_marking = std::max(out.max_tokens_per_marking, own.most_tokens);
        for (std::uint32_t p = 0; p < own.bounds.size(); ++p) {
            out.bounds[p] = std::max(out.bounds[p], own.bounds[p]);
        }
    }
    for (const Symmetry::Group& g : search.symmetry.groups) {  // what one holds, all may hold
        for (std::uint32_t k = 0; k < g.width; ++k) {
            std::uint32_t most = 0;
            for (std::size_t i = k; i < g.places.size(); i += g.width) {
                most = std::max(most, out.bounds[g.places[i]]);
            }
            for (std::size_t i = k; i < g.places.size(); i += g.width) {
                out.bounds[g.places[i]] = most;
            }
        }
    }
    for (const std::uint32_t b : out.bounds) {
        out.max_tokens_in_place = std::max(out.max_tokens_in_place, b);
    }
    out.dead = finding_of(search, search.dead);
    for (const auto& r : search.reached) {
        out.goals.push_back(finding_of(search, r));
    }
    out.bits_per_state = search.form.packing.bits;
    out.bytes = std::max(search.most_bytes.load(), search.bytes());
    out.seconds = search.meter.seconds();
    return out;
}

}  // namespace puppetri::proof
