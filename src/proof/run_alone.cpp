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

// A transition that leads from a marking to another, up to symmetry, as the explorer would fire it;
// `from` becomes what it makes.
std::uint32_t step_towards(const PlainNet& net, Marking& from, const Marking& to,
                           const Symmetry& symmetry) {
    std::uint32_t highest = 0;
    for (std::uint32_t t = 0; net.has_levels && t < net.transition_count(); ++t) {
        if (net.enabled(from, t)) {
            highest = std::max(highest, net.level[t]);
        }
    }
    for (std::uint32_t t = 0; t < net.transition_count(); ++t) {
        if (!net.enabled(from, t) || (net.has_levels && net.level[t] < highest)) {
            continue;
        }
        Marking next = from;
        if (!net.fire(next, t)) {
            continue;
        }
        Marking seen = next;
        make_canonical(symmetry, seen);
        if (seen == to) {
            from = std::move(next);
            return t;
        }
    }
    return net.transition_count();
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
                                      std::uint32_t id, const Symmetry& symmetry) {
    std::vector<std::uint32_t> states;
    for (; id != StateStore::kNoState; id = form.store->parent(id)) {
        states.push_back(id);
    }
    std::vector<std::uint32_t> firings;
    Marking at = net.initial;
    for (std::size_t i = states.size() - 1; i-- > 0;) {
        firings.push_back(
            step_towards(net, at, marking_of(form, states[i], net.place_count()), symmetry));
    }
    return firings;
}

}  // namespace puppetri::proof
