// SPDX-License-Identifier: MIT
// The rules that take away places and transitions. Unless said otherwise a rule leaves the state
// space as it is, up to places that tell nothing: then it preserves every goal.
//
// Sources: Berthelot, Transformations and decompositions of nets, LNCS 254, 1987; Murata 1989,
// section V.C; Bønneland, Dyhr, Jensen, Johannsen, Srba: Stubborn versus structural reductions for
// Petri nets, JLAMP 102, 2019 (verifypn's rules); Thierry-Mieg: Structural reductions revisited,
// Petri Nets 2020, LNCS 12152.
#include <algorithm>

#include "reduction_net.h"

namespace puppetri::proof {

// A transition needs a place that stays empty: no token is there, and all who could bring one need
// such places too (an empty siphon). Or a place that can never be as full as needed, or never as
// empty: nobody adds to it, or nobody takes from it.
bool remove_never_enabled(ReductionNet& net) {
    const std::size_t count = net.transitions.size();
    std::vector<std::uint8_t> can_mark(net.place_count(), 0), grows(net.place_count(), 0),
        falls(net.place_count(), 0), fires(count, 0);
    for (std::uint32_t p = 0; p < net.place_count(); ++p) {
        can_mark[p] = net.initial[p] > 0 ? 1 : 0;
    }
    std::vector<std::uint32_t> missing(count, 0), open;  // places that it needs and that are empty
    for (std::uint32_t i = 0; i < count; ++i) {
        for (const ReductionArc& a : net.transitions[i].arcs) {
            missing[i] += a.need > 0 && can_mark[a.place] == 0 ? 1 : 0;
        }
        if (net.transitions[i].alive && missing[i] == 0) {
            open.push_back(i);
        }
    }
    while (!open.empty()) {
        const std::uint32_t i = open.back();
        open.pop_back();
        fires[i] = 1;
        for (const ReductionArc& a : net.transitions[i].arcs) {
            falls[a.place] |= a.change < 0 ? 1 : 0;
            if (a.change <= 0) {
                continue;
            }
            grows[a.place] = 1;
            if (can_mark[a.place] != 0) {
                continue;
            }
            can_mark[a.place] = 1;
            for (const std::uint32_t u : net.at(a.place)) {
                if (net.arc(u, a.place).need > 0 && --missing[u] == 0) {
                    open.push_back(u);
                }
            }
        }
    }
    bool any = false;
    for (std::uint32_t i = 0; i < net.transitions.size(); ++i) {
        const ReductionTransition& t = net.transitions[i];
        if (!t.alive) {
            continue;
        }
        const bool never =
            fires[i] == 0 || std::any_of(t.arcs.begin(), t.arcs.end(), [&](const ReductionArc& a) {
                return (grows[a.place] == 0 && net.initial[a.place] < a.need) ||
                       (falls[a.place] == 0 && net.initial[a.place] >= a.limit);
            });
        if (never) {
            net.remove_transition(i);
            ++net.applied;
            any = true;
        }
    }
    return any;
}

// A place from which nobody takes has at least its initial tokens for ever, one to which nobody
// adds has at most these: tests that this decides go away.
bool simplify_monotone_places(ReductionNet& net) {
    bool any = false;
    for (std::uint32_t p = 0; p < net.place_count(); ++p) {
        if (net.place_alive[p] == 0) {
            continue;
        }
        bool grows = false, falls = false;
        const std::vector<std::uint32_t> users = net.at(p);
        for (const std::uint32_t t : users) {
            grows = grows || net.arc(t, p).change > 0;
            falls = falls || net.arc(t, p).change < 0;
        }
        for (const std::uint32_t t : users) {
            const ReductionArc a = net.arc(t, p);
            if (!falls && a.need > 0 && a.need <= net.initial[p]) {
                net.drop_need(t, p);
                ++net.applied;
                any = true;
            }
            if (!grows && a.limit != ReductionArc::kNoLimit && net.initial[p] < a.limit) {
                net.drop_limit(t, p);
                ++net.applied;
                any = true;
            }
        }
    }
    return any;
}

// A place that nobody tests, and the question does not read.
bool remove_untested_places(ReductionNet& net) {
    bool any = false;
    for (std::uint32_t p = 0; p < net.place_count(); ++p) {
        if (net.place_alive[p] == 0 || net.keep[p] != 0) {
            continue;
        }
        const std::vector<std::uint32_t>& users = net.at(p);
        if (std::none_of(users.begin(), users.end(),
                         [&](std::uint32_t t) { return net.arc(t, p).tests(); })) {
            net.remove_place(p);
            ++net.applied;
            any = true;
        }
    }
    return any;
}

namespace {

// Nobody inhibited by p; f change(p) = g change(q) for every transition; and where q has enough, p
// has: m(p) = (g m(q) + c) / f with c = f m0(p) - g m0(q).
bool implies(ReductionNet& net, std::uint32_t q, std::uint32_t p) {
    const std::vector<std::uint32_t> users = net.at(p);
    std::vector<std::uint32_t> both = net.at(q);
    both.insert(both.end(), users.begin(), users.end());
    std::int64_t f = 0, g = 0;
    for (const std::uint32_t t : both) {
        const ReductionArc &a = net.arc(t, p), &b = net.arc(t, q);
        if (a.limit != ReductionArc::kNoLimit || (a.change == 0) != (b.change == 0)) {
            return false;
        }
        if (a.change != 0 && f == 0) {
            if ((a.change > 0) != (b.change > 0)) {
                return false;
            }
            f = b.change > 0 ? b.change : -b.change;
            g = a.change > 0 ? a.change : -a.change;
        }
        if (f * a.change != g * b.change) {
            return false;
        }
    }
    if (f == 0) {
        return false;  // constant: another rule's
    }
    const std::int64_t c = f * std::int64_t{net.initial[p]} - g * std::int64_t{net.initial[q]};
    return std::all_of(users.begin(), users.end(), [&](std::uint32_t t) {
        const ReductionArc &a = net.arc(t, p), &b = net.arc(t, q);
        return a.need == 0 || g * std::int64_t{b.need} + c >= f * std::int64_t{a.need};
    });
}

constexpr std::int64_t kSmall = 1 << 20;  // products of weights and tokens stay far within 63 bits

bool has_small_numbers(ReductionNet& net, std::uint32_t p) {
    const std::vector<std::uint32_t>& users = net.at(p);
    return net.initial[p] < kSmall && std::all_of(users.begin(), users.end(), [&](std::uint32_t t) {
               const ReductionArc& a = net.arc(t, p);
               return a.need < kSmall && a.change < kSmall && a.change > -kSmall;
           });
}

}  // namespace

// Redundant (implicit) places in their simplest form: a multiple of another place.
bool remove_implied_places(ReductionNet& net) {
    bool any = false;
    for (std::uint32_t p = 0; p < net.place_count(); ++p) {
        if (net.place_alive[p] == 0 || net.keep[p] != 0 || !has_small_numbers(net, p)) {
            continue;
        }
        const std::vector<std::uint32_t>& users = net.at(p);
        if (users.empty()) {
            continue;
        }
        const std::uint32_t first = users.front();
        for (const ReductionArc& a : net.transitions[first].arcs) {
            const std::uint32_t q = a.place;
            if (q != p && has_small_numbers(net, q) && implies(net, q, p)) {
                net.remove_place(p);
                ++net.applied;
                any = true;
                break;
            }
        }
    }
    return any;
}

namespace {

// Whenever u is enabled, t is.
bool enabled_with(const ReductionTransition& t, const ReductionTransition& u) {
    std::size_t j = 0;
    for (const ReductionArc& a : t.arcs) {
        if (!a.tests()) {
            continue;
        }
        while (j < u.arcs.size() && u.arcs[j].place < a.place) {
            ++j;
        }
        const bool same = j < u.arcs.size() && u.arcs[j].place == a.place;
        if ((same ? u.arcs[j].need : 0) < a.need ||
            (same ? u.arcs[j].limit : ReductionArc::kNoLimit) > a.limit) {
            return false;
        }
    }
    return true;
}

std::vector<std::pair<std::uint32_t, std::int64_t>> changes(const ReductionTransition& t) {
    std::vector<std::pair<std::uint32_t, std::int64_t>> out;
    for (const ReductionArc& a : t.arcs) {
        if (a.change != 0) {
            out.emplace_back(a.place, a.change);
        }
    }
    return out;
}

}  // namespace

constexpr std::uint64_t kMostComparisons = 10'000'000;

// u does what t does and is enabled only if t is: u goes, if t counts for death whenever u does.
// A transition that changes nothing goes if the question is reachability; if it is death, when some
// other one is enabled whenever it is. (Runs may stay with it for ever: not for stuttering.)
bool remove_dominated_transitions(ReductionNet& net) {
    std::vector<std::pair<std::vector<std::pair<std::uint32_t, std::int64_t>>, std::uint32_t>> all;
    for (std::uint32_t i = 0; i < net.transitions.size(); ++i) {
        if (net.transitions[i].alive) {
            all.emplace_back(changes(net.transitions[i]), i);
        }
    }
    std::sort(all.begin(), all.end());
    bool any = false;
    const auto remove = [&](std::uint32_t u) {
        net.remove_transition(u);
        ++net.applied;
        any = true;
    };
    for (std::size_t first = 0; first < all.size();) {
        std::size_t last = first;
        while (last < all.size() && all[last].first == all[first].first) {
            ++last;
        }
        for (std::size_t i = first; i < last; ++i) {
            const std::uint32_t u = all[i].second;
            if (all[i].first.empty() && net.preserves == Preserves::kReachability) {
                remove(u);
                continue;
            }
            for (std::size_t j = first; j < last && net.transitions[u].alive; ++j) {
                const std::uint32_t t = all[j].second;
                const ReductionTransition& by = net.transitions[t];
                const bool counts = net.preserves == Preserves::kReachability || !by.optional ||
                                    net.transitions[u].optional;
                if (t != u && by.alive && counts && enabled_with(by, net.transitions[u])) {
                    remove(u);
                }
            }
        }
        first = last;
    }
    // Those that change nothing are first in this order, each compared with all.
    const auto silent = static_cast<std::uint64_t>(
        std::count_if(all.begin(), all.end(), [](const auto& a) { return a.first.empty(); }));
    if (net.preserves == Preserves::kDeadlock && silent * all.size() <= kMostComparisons) {
        for (const auto& [change, u] : all) {
            if (!change.empty() || !net.transitions[u].alive) {
                continue;
            }
            for (const auto& other : all) {
                const ReductionTransition& t = net.transitions[other.second];
                if (other.second != u && t.alive && (!t.optional || net.transitions[u].optional) &&
                    enabled_with(t, net.transitions[u])) {
                    remove(u);
                    break;
                }
            }
        }
    }
    return any;
}

// Reachability only: a transition that only takes, from places that are neither kept nor inhibit.
// Without it every other one stays enabled (Thierry-Mieg 2020, rule of useless sinks).
bool remove_eaters(ReductionNet& net) {
    if (net.preserves != Preserves::kReachability) {
        return false;
    }
    bool any = false;
    for (std::uint32_t i = 0; i < net.transitions.size(); ++i) {
        const ReductionTransition& t = net.transitions[i];
        if (!t.alive) {
            continue;
        }
        const bool eats = std::all_of(t.arcs.begin(), t.arcs.end(), [&](const ReductionArc& a) {
            if (a.change == 0) {
                return true;
            }
            if (a.change > 0 || net.keep[a.place] != 0) {
                return false;
            }
            const std::vector<std::uint32_t>& users = net.at(a.place);
            return std::all_of(users.begin(), users.end(), [&](std::uint32_t u) {
                return net.arc(u, a.place).limit == ReductionArc::kNoLimit;
            });
        });
        if (eats) {
            net.remove_transition(i);
            ++net.applied;
            any = true;
        }
    }
    return any;
}

// Death only: a transition that tests nothing is enabled for ever, so nothing is ever dead; it
// alone remains.
bool remove_beside_always_enabled(ReductionNet& net) {
    if (net.preserves != Preserves::kDeadlock) {
        return false;
    }
    const auto always = std::find_if(
        net.transitions.begin(), net.transitions.end(), [](const ReductionTransition& t) {
            return t.alive && !t.optional &&
                   std::none_of(t.arcs.begin(), t.arcs.end(),
                                [](const ReductionArc& a) { return a.tests(); });
        });
    if (always == net.transitions.end()) {
        return false;
    }
    const auto stays = static_cast<std::uint32_t>(always - net.transitions.begin());
    bool any = false;
    for (std::uint32_t t = 0; t < net.transitions.size(); ++t) {
        if (net.transitions[t].alive && t != stays) {
            net.remove_transition(t);
            ++net.applied;
            any = true;
        }
    }
    return any;
}

}  // namespace puppetri::proof
