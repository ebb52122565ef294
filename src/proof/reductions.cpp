// SPDX-License-Identifier: MIT
// The order of the rules, and the way in and out of the form they work on.
#include "puppetri/proof/reductions.h"

#include <algorithm>

#include "puppetri/proof/slice.h"
#include "reduction_net.h"

namespace puppetri::proof {

namespace {

constexpr std::uint32_t kMostTokens = ~std::uint32_t{0} / 4;  // greater weights: left as it is

bool within_range(const PlainNet& net) {
    const auto small = [](const net::Rows<net::Weighted>& rows) {
        return std::all_of(rows.items.begin(), rows.items.end(),
                           [](const net::Weighted& w) { return w.weight < kMostTokens; });
    };
    return small(net.takes) && small(net.gives) && small(net.reads) && small(net.unless);
}

Reduction unchanged(const PlainNet& net) {
    Reduction out;
    out.net = net;
    for (std::uint32_t p = 0; p < net.place_count(); ++p) {
        out.place_of.push_back(p);
        out.now.push_back(p);
    }
    for (std::uint32_t t = 0; t < net.transition_count(); ++t) {
        out.sequences.items.push_back(t);
        out.sequences.starts.push_back(t + 1);
    }
    return out;
}

const ReductionArc kNoArc;

}  // namespace

void keep_presets(const PlainNet& net, std::span<const std::uint32_t> transitions,
                  ReductionGoal& goal) {
    goal.keep.resize(net.place_count(), 0);
    for (const std::uint32_t t : transitions) {
        for (const auto* rows : {&net.takes, &net.reads, &net.unless}) {
            for (const net::Weighted& w : rows->row(t)) {
                goal.keep[w.place] = 1;
            }
        }
    }
}

ReductionNet::ReductionNet(const PlainNet& net, const ReductionGoal& goal, const Budget& budget)
    : initial(net.initial),
      place_alive(net.place_count(), 1),
      keep(goal.keep),
      preserves(goal.preserves),
      at_(net.place_count()),
      stale_(net.place_count(), 0),
      has_limits_(net.has_inhibitors()),
      meter_(budget, "reductions") {
    keep.resize(net.place_count(), 0);
    for (std::uint32_t t = 0; t < net.transition_count(); ++t) {
        std::vector<ReductionArc> arcs;
        for (const net::Weighted& w : net.takes.row(t)) {
            arcs.push_back({w.place, w.weight, -std::int64_t{w.weight}, ReductionArc::kNoLimit});
        }
        for (const net::Weighted& w : net.gives.row(t)) {
            arcs.push_back({w.place, 0, w.weight, ReductionArc::kNoLimit});
        }
        for (const net::Weighted& w : net.reads.row(t)) {
            arcs.push_back({w.place, w.weight, 0, ReductionArc::kNoLimit});
        }
        for (const net::Weighted& w : net.unless.row(t)) {
            arcs.push_back({w.place, 0, 0, w.weight});
        }
        std::stable_sort(arcs.begin(), arcs.end(),
                         [](const auto& a, const auto& b) { return a.place < b.place; });
        ReductionTransition out;
        out.sequence = {t};
        out.optional = net.optional[t] != 0;
        for (const ReductionArc& a : arcs) {
            if (out.arcs.empty() || out.arcs.back().place != a.place) {
                out.arcs.push_back(a);
            } else {
                ReductionArc& sum = out.arcs.back();
                sum.need = std::max(sum.need, a.need);
                sum.change += a.change;
                sum.limit = std::min(sum.limit, a.limit);
            }
        }
        std::erase_if(out.arcs, [](const ReductionArc& a) { return a.empty(); });
        // "Fewer than none", as a place says that holds less than is given: it never fires, and no
        // rule has to know such limits.
        const bool never = std::any_of(out.arcs.begin(), out.arcs.end(),
                                       [](const ReductionArc& a) { return a.limit <= a.need; });
        add(std::move(out));
        if (never) {
            remove_transition(t);
            ++applied;
        }
    }
}

const std::vector<std::uint32_t>& ReductionNet::at(std::uint32_t place) {
    std::vector<std::uint32_t>& list = at_[place];
    if (stale_[place] == 0) {
        return list;
    }
    stale_[place] = 0;
    std::erase_if(
        list, [&](std::uint32_t t) { return !transitions[t].alive || find(t, place) == nullptr; });
    return list;
}

ReductionArc* ReductionNet::find(std::uint32_t transition, std::uint32_t place) {
    std::vector<ReductionArc>& arcs = transitions[transition].arcs;
    const auto it =
        std::lower_bound(arcs.begin(), arcs.end(), place,
                         [](const ReductionArc& a, std::uint32_t p) { return a.place < p; });
    return it != arcs.end() && it->place == place ? &*it : nullptr;
}

const ReductionArc& ReductionNet::arc(std::uint32_t transition, std::uint32_t place) const {
    const ReductionArc* found = const_cast<ReductionNet*>(this)->find(transition, place);
    return found != nullptr ? *found : kNoArc;
}

void ReductionNet::add(ReductionTransition t) {
    const auto index = static_cast<std::uint32_t>(transitions.size());
    for (const ReductionArc& a : t.arcs) {
        at_[a.place].push_back(index);
    }
    transitions.push_back(std::move(t));
}

void ReductionNet::remove_transition(std::uint32_t t) {
    transitions[t].alive = false;
    for (const ReductionArc& a : transitions[t].arcs) {
        stale_[a.place] = 1;
    }
}

void ReductionNet::remove_place(std::uint32_t p) {
    const std::vector<std::uint32_t> users = at(p);
    for (const std::uint32_t t : users) {
        std::erase_if(transitions[t].arcs, [&](const ReductionArc& a) { return a.place == p; });
    }
    place_alive[p] = 0;
    at_[p].clear();
}

void ReductionNet::drop_if_empty(std::uint32_t t, std::uint32_t p) {
    stale_[p] = 1;
    std::erase_if(transitions[t].arcs,
                  [&](const ReductionArc& a) { return a.place == p && a.empty(); });
}
void ReductionNet::drop_need(std::uint32_t t, std::uint32_t p) {
    find(t, p)->need = 0;
    drop_if_empty(t, p);
}
void ReductionNet::drop_limit(std::uint32_t t, std::uint32_t p) {
    find(t, p)->limit = ReductionArc::kNoLimit;
    drop_if_empty(t, p);
}

bool ReductionNet::visible(const ReductionTransition& t) const {
    return preserves != Preserves::kDeadlock &&
           std::any_of(t.arcs.begin(), t.arcs.end(),
                       [&](const ReductionArc& a) { return a.change != 0 && keep[a.place] != 0; });
}

Reduction ReductionNet::finish(const PlainNet& original) const {
    Reduction out;
    out.now.assign(place_count(), Reduction::kGone);
    for (std::uint32_t p = 0; p < place_count(); ++p) {
        if (place_alive[p] != 0) {
            out.now[p] = static_cast<std::uint32_t>(out.place_of.size());
            out.place_of.push_back(p);
            out.net.initial.push_back(initial[p]);
        }
    }
    for (const ReductionTransition& t : transitions) {
        if (!t.alive) {
            continue;
        }
        const auto put = [&](net::Rows<net::Weighted>& rows, auto weight) {
            for (const ReductionArc& a : t.arcs) {
                const std::int64_t w = weight(a);
                if (w > 0) {
                    rows.items.push_back({out.now[a.place], static_cast<std::uint32_t>(w)});
                }
            }
            rows.starts.push_back(static_cast<std::uint32_t>(rows.items.size()));
        };
        put(out.net.takes, [](const ReductionArc& a) { return -a.change; });
        put(out.net.gives, [](const ReductionArc& a) { return a.change; });
        put(out.net.reads, [](const ReductionArc& a) -> std::int64_t {
            return std::int64_t{a.need} > -a.change ? a.need : 0;
        });
        put(out.net.unless, [](const ReductionArc& a) -> std::int64_t {
            return a.limit == ReductionArc::kNoLimit ? 0 : a.limit;
        });
        out.net.level.push_back(0);
        out.net.optional.push_back(t.optional ? 1 : 0);
        out.sequences.items.insert(out.sequences.items.end(), t.sequence.begin(), t.sequence.end());
        out.sequences.starts.push_back(static_cast<std::uint32_t>(out.sequences.items.size()));
    }
    out.net.left_out = original.left_out;
    out.prefix = prefix;
    out.rest.assign(rest.rbegin(), rest.rend());
    out.rules_applied = applied;
    return out;
}

std::vector<std::uint32_t> Reduction::original(const PlainNet& whole,
                                               std::span<const std::uint32_t> reduced,
                                               bool dead) const {
    std::vector<std::uint32_t> out = prefix;
    for (const std::uint32_t t : reduced) {
        const auto row = sequences.row(t);
        out.insert(out.end(), row.begin(), row.end());
    }
    if (!dead || rest.empty()) {
        return out;
    }
    Marking marking = whole.initial;
    for (const std::uint32_t t : out) {
        whole.fire(marking, t);
    }
    for (const std::vector<std::uint32_t>& sequence : rest) {
        for (;;) {
            Marking next = marking;
            const bool fired = std::all_of(sequence.begin(), sequence.end(), [&](std::uint32_t t) {
                return whole.enabled(next, t) && whole.fire(next, t);
            });
            if (!fired) {
                break;
            }
            marking = std::move(next);
            out.insert(out.end(), sequence.begin(), sequence.end());
        }
    }
    return out;
}

Reduction reduce(const PlainNet& net, const ReductionGoal& goal, const Budget& budget) {
    if (net.has_levels || !within_range(net)) {
        return unchanged(net);
    }
    ReductionNet work(net, goal, budget);
    if (goal.preserves == Preserves::kReachability) {
        // What cannot influence the kept places goes first.
        std::vector<std::uint32_t> kept;
        for (std::uint32_t p = 0; p < net.place_count(); ++p) {
            if (work.keep[p] != 0) {
                kept.push_back(p);
            }
        }
        const SubNet part = slice(net, kept);
        std::vector<std::uint8_t> place(net.place_count(), 0),
            transition(net.transition_count(), 0);
        for (const std::uint32_t p : part.places) {
            place[p] = 1;
        }
        for (const std::uint32_t t : part.transitions) {
            transition[t] = 1;
        }
        for (std::uint32_t t = 0; t < net.transition_count(); ++t) {
            if (transition[t] == 0) {
                work.remove_transition(t);
                ++work.applied;
            }
        }
        for (std::uint32_t p = 0; p < net.place_count(); ++p) {
            if (place[p] == 0) {
                work.remove_place(p);
                ++work.applied;
            }
        }
    }
    for (bool changed = true; changed;) {
        changed = false;
        for (const auto rule :
             {remove_never_enabled, simplify_monotone_places, remove_untested_places,
              remove_implied_places, remove_dominated_transitions, remove_eaters,
              remove_beside_always_enabled, agglomerate_after, agglomerate_before}) {
            if (work.out_of_budget()) {
                return work.finish(net);
            }
            changed = rule(work) || changed;
        }
    }
    return work.finish(net);
}

}  // namespace puppetri::proof
