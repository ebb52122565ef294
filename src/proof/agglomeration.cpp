// SPDX-License-Identifier: MIT
// Two firings become one. Around a place p that the question does not read and nobody reads or is
// inhibited by, with producers H (they add to p) and consumers F (they take from p), each pair h, f
// becomes "h then f", and p is gone.
//
// After (post-agglomeration): the consumers need p alone, so that f can fire as soon as h has, and
// nothing can prevent it. In any run each f can be moved to just after its h: f adds its tokens
// earlier, which hinders nobody, as no place to which F adds inhibits. f is unseen, so the run
// looks the same. Where a run leaves tokens in p, some f may be added, or p would not be empty in a
// dead marking. Sources: Berthelot 1987; Haddad, Pradat-Peyre: New efficient Petri nets reductions
// for parallel programs verification, PPL 16, 2006; Thierry-Mieg 2020, rules of post-agglomeration.
//
// Before (pre-agglomeration): the producers add to p alone, so that h can wait until just before
// its f; its tokens stay where they were meanwhile, which hinders nobody, as no place from which H
// takes inhibits; and whoever else takes from these places did so while h's tokens were gone. h is
// unseen and reads nothing. h whose f never comes are left out: that changes nothing that is seen.
// For death and for endless runs the marking without these h must be dead if it was: so only H
// takes from these places, and nobody else looks at them. A dead marking of the reduced net becomes
// one of the original after firing what h are left (`rest`). Sources: the same; for reachability
// the weaker conditions are those of "free agglomeration", Thierry-Mieg 2020.
#include <algorithm>

#include "reduction_net.h"

namespace puppetri::proof {

namespace {

constexpr std::uint32_t kMostRepeats = 64;
constexpr std::size_t kLongest = 4096;  // firings in one

struct Around {
    std::vector<std::uint32_t> producers, consumers;
};

// Gives  false if p is read, inhibits, or somebody needs more of it than it takes.
bool look_around(ReductionNet& net, std::uint32_t p, Around& out) {
    for (const std::uint32_t t : net.at(p)) {
        const ReductionArc& a = net.arc(t, p);
        if (a.limit != ReductionArc::kNoLimit || a.change == 0) {
            return false;
        }
        if (a.change > 0) {
            if (a.need != 0) {
                return false;
            }
            out.producers.push_back(t);
        } else {
            if (a.need != -a.change) {
                return false;
            }
            out.consumers.push_back(t);
        }
    }
    return !out.consumers.empty();
}

bool inhibits(ReductionNet& net, std::uint32_t place) {
    if (!net.has_limits()) {
        return false;
    }
    const std::vector<std::uint32_t>& users = net.at(place);
    return std::any_of(users.begin(), users.end(), [&](std::uint32_t t) {
        return net.arc(t, place).limit != ReductionArc::kNoLimit;
    });
}

// "h, then f `times` times", where f's tests after h are known: needs become needs before h.
bool in_sequence(const ReductionTransition& h, const ReductionTransition& f, std::uint32_t times,
                 std::uint32_t without, ReductionTransition& out) {
    out = {};
    if (h.sequence.size() + f.sequence.size() * times > kLongest) {
        return false;
    }
    out.sequence = h.sequence;
    for (std::uint32_t i = 0; i < times; ++i) {
        out.sequence.insert(out.sequence.end(), f.sequence.begin(), f.sequence.end());
    }
    std::size_t i = 0, j = 0;
    while (i < h.arcs.size() || j < f.arcs.size()) {
        ReductionArc a, b;
        if (j == f.arcs.size() || (i < h.arcs.size() && h.arcs[i].place < f.arcs[j].place)) {
            a = h.arcs[i++];
            b.place = a.place;
        } else if (i == h.arcs.size() || f.arcs[j].place < h.arcs[i].place) {
            b = f.arcs[j++];
            a.place = b.place;
        } else {
            a = h.arcs[i++];
            b = f.arcs[j++];
        }
        if (a.place == without) {
            continue;
        }
        ReductionArc sum;
        sum.place = a.place;
        // Repeats (times > 1) happen only where f needs nothing but `without`.
        const std::int64_t before = std::int64_t{b.need} - a.change;
        sum.need = static_cast<std::uint32_t>(std::max<std::int64_t>(a.need, before));
        sum.change = a.change + b.change * times;
        sum.limit = a.limit;
        if (b.limit != ReductionArc::kNoLimit) {
            const std::int64_t limit = std::int64_t{b.limit} - a.change;
            if (limit <= 0) {
                out.alive = false;  // h forbids f
                return true;
            }
            sum.limit = std::min<std::uint32_t>(
                sum.limit, static_cast<std::uint32_t>(
                               std::min<std::int64_t>(limit, ReductionArc::kNoLimit - 1)));
        }
        if (before > (1 << 30) || sum.change > (1 << 30) || sum.change < -(1 << 30)) {
            return false;
        }
        if (!sum.empty()) {
            out.arcs.push_back(sum);
        }
    }
    out.optional = h.optional || f.optional;
    return true;
}

// Replaces the pairs; false (and nothing done) if one does not fit.
bool fuse(ReductionNet& net, std::uint32_t p, const Around& around,
          const std::vector<std::uint32_t>& times) {
    std::vector<ReductionTransition> fused;
    for (std::size_t i = 0; i < around.producers.size(); ++i) {
        for (const std::uint32_t f : around.consumers) {
            ReductionTransition both;
            if (!in_sequence(net.transitions[around.producers[i]], net.transitions[f], times[i], p,
                             both)) {
                return false;
            }
            if (both.alive) {
                fused.push_back(std::move(both));
            }
        }
    }
    for (const auto* list : {&around.producers, &around.consumers}) {
        for (const std::uint32_t t : *list) {
            net.remove_transition(t);
        }
    }
    net.remove_place(p);
    for (ReductionTransition& t : fused) {
        net.add(std::move(t));
    }
    ++net.applied;
    return true;
}

bool stays_small(const Around& around) {
    const std::size_t h = around.producers.size(), f = around.consumers.size();
    return h * f <= h + f;
}

bool try_after(ReductionNet& net, std::uint32_t p) {
    Around around;
    if (!look_around(net, p, around) || !stays_small(around)) {
        return false;
    }
    const bool reachability = net.preserves == Preserves::kReachability;
    const std::int64_t weight = -net.arc(around.consumers.front(), p).change;
    const bool single = around.consumers.size() == 1;
    for (const std::uint32_t f : around.consumers) {
        const ReductionTransition& t = net.transitions[f];
        if (net.arc(f, p).change != -weight || net.visible(t) || (t.optional && !reachability)) {
            return false;
        }
        for (const ReductionArc& a : t.arcs) {
            if (a.place != p && (a.tests() || inhibits(net, a.place))) {
                return false;
            }
        }
    }
    if ((weight != 1 || net.initial[p] > 0) && !single) {
        return false;
    }
    if (net.initial[p] % weight != 0 || net.initial[p] / weight > kMostRepeats) {
        return false;
    }
    std::vector<std::uint32_t> times;
    for (const std::uint32_t h : around.producers) {
        const std::int64_t given = net.arc(h, p).change;
        if (given % weight != 0 || given / weight > kMostRepeats || (given != weight && !single)) {
            return false;
        }
        times.push_back(static_cast<std::uint32_t>(given / weight));
    }
    // Tokens that are there already are used up at once.
    const std::uint32_t f = around.consumers.front();
    const std::uint32_t first = net.initial[p] / static_cast<std::uint32_t>(weight);
    const ReductionTransition consumer = net.transitions[f];
    if (first > 0 &&
        std::any_of(consumer.arcs.begin(), consumer.arcs.end(), [&](const ReductionArc& a) {
            return a.change > 0 && net.initial[a.place] + a.change * first > (1 << 30);
        })) {
        return false;
    }
    if (!fuse(net, p, around, times)) {
        return false;
    }
    for (std::uint32_t i = 0; i < first; ++i) {
        net.prefix.insert(net.prefix.end(), consumer.sequence.begin(), consumer.sequence.end());
        for (const ReductionArc& a : consumer.arcs) {
            if (a.place != p) {
                net.initial[a.place] += static_cast<std::uint32_t>(a.change);
            }
        }
    }
    return true;
}

bool try_before(ReductionNet& net, std::uint32_t p) {
    Around around;
    if (net.initial[p] != 0 || !look_around(net, p, around) || around.producers.empty() ||
        !stays_small(around)) {
        return false;
    }
    const bool reachability = net.preserves == Preserves::kReachability;
    for (const std::uint32_t f : around.consumers) {
        if (net.arc(f, p).change != -1 || (net.transitions[f].optional && !reachability)) {
            return false;
        }
    }
    for (const std::uint32_t h : around.producers) {
        const ReductionTransition& t = net.transitions[h];
        if (net.arc(h, p).change != 1 || net.visible(t) || (t.optional && !reachability) ||
            t.arcs.size() < 2) {  // a source would never be used up
            return false;
        }
        for (const ReductionArc& a : t.arcs) {
            if (a.place == p) {
                continue;
            }
            if (a.change >= 0 || a.need != -a.change || a.limit != ReductionArc::kNoLimit ||
                inhibits(net, a.place)) {
                return false;
            }
            if (reachability) {
                continue;
            }
            // Nobody else looks at the place, be it another producer.
            const std::vector<std::uint32_t>& users = net.at(a.place);
            if (std::any_of(users.begin(), users.end(), [&](std::uint32_t u) {
                    return u != h && net.arc(u, a.place).tests();
                })) {
                return false;
            }
        }
    }
    std::vector<std::vector<std::uint32_t>> rest;
    for (const std::uint32_t h : around.producers) {
        rest.push_back(net.transitions[h].sequence);
    }
    if (!fuse(net, p, around, std::vector<std::uint32_t>(around.producers.size(), 1))) {
        return false;
    }
    if (!reachability) {
        net.rest.insert(net.rest.end(), rest.begin(), rest.end());
    }
    return true;
}

template <class Try>
bool at_every_place(ReductionNet& net, Try attempt) {
    bool any = false;
    for (std::uint32_t p = 0; p < net.place_count(); ++p) {
        if ((p & 63) == 0 && net.out_of_budget()) {
            return any;
        }
        if (net.place_alive[p] != 0 && net.keep[p] == 0) {
            any = attempt(net, p) || any;
        }
    }
    return any;
}

}  // namespace

bool agglomerate_after(ReductionNet& net) { return at_every_place(net, try_after); }
bool agglomerate_before(ReductionNet& net) { return at_every_place(net, try_before); }

}  // namespace puppetri::proof
