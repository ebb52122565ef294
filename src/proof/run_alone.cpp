// SPDX-License-Identifier: MIT
// Choosing the worker for the number of words that a state has now, as often as that changes.
#include "run_alone.h"

#include <algorithm>

#include "worker.h"

namespace puppetri::proof {

namespace {

template <unsigned kWords>
void go_on(Search& search, bool depth_first, std::uint64_t up_to_states) {
    Worker<kWords, false> worker(search, search.own);
    if (depth_first) {
        worker.depth_first();
    } else {
        worker.breadth_first(up_to_states);
    }
}

// A transition that leads from one marking to another, as the explorer would fire it.
std::uint32_t step_between(const PlainNet& net, const Marking& from, const Marking& to) {
    std::uint32_t best = net.transition_count();
    Marking next;
    std::uint32_t highest = 0;
    for (std::uint32_t t = 0; t < net.transition_count(); ++t) {
        if (!net.enabled(from, t)) {
            continue;
        }
        const std::uint32_t level = net.has_levels ? net.level[t] : 0;
        if (level > highest) {
            highest = level;
            best = net.transition_count();
        }
        if (level < highest || best != net.transition_count()) {
            continue;
        }
        next = from;
        if (net.fire(next, t) && next == to) {
            best = t;
        }
    }
    return best;
}

}  // namespace

void run_alone(Search& search, bool depth_first, std::uint64_t up_to_states) {
    const auto open = [&] {
        return !search.stop && (depth_first ? !search.own.stack.empty()
                                            : search.own.head < search.own.next &&
                                                  search.own.states < up_to_states);
    };
    while (open()) {
        switch (search.form.packing.words) {
            case 1:
                go_on<1>(search, depth_first, up_to_states);
                break;
            case 2:
                go_on<2>(search, depth_first, up_to_states);
                break;
            default:
                go_on<0>(search, depth_first, up_to_states);
        }
    }
}

Marking marking_of(const Search::Form& form, std::uint32_t id, std::uint32_t places) {
    std::vector<std::uint64_t> state(form.packing.words);
    form.store->load<0>(id, state.data());
    Marking marking(places);
    form.packing.decode(state, marking);
    return marking;
}

std::vector<std::uint32_t> firings_to(const PlainNet& net, const Search::Form& form,
                                      std::uint32_t id) {
    std::vector<std::uint32_t> firings;
    Marking to = marking_of(form, id, net.place_count());
    for (id = form.store->parent(id); id != StateStore::kNoState; id = form.store->parent(id)) {
        Marking from = marking_of(form, id, net.place_count());
        firings.push_back(step_between(net, from, to));
        to = std::move(from);
    }
    std::reverse(firings.begin(), firings.end());
    return firings;
}

}  // namespace puppetri::proof
