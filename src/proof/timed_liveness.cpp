// SPDX-License-Identifier: MIT
// Liveness with time, by choosing well.
//
// Lemma. Let N be a bounded, strongly connected, extended free choice net and t a transition.
// Choose in each cluster c a transition a(c) with the shortest way to t. An endless firing sequence
// that fires in each cluster only a(c) fires t infinitely often. Proof. Let u fire infinitely
// often, u not t. A shortest way from u to t goes on to a place p and a transition v of p's cluster
// c, so a(c) is nearer to t than u; in particular u is not a(c), and does not take from p. So u
// adds to p infinitely often; p is bounded, so somebody takes from p infinitely often, which must
// be a(c). Go on with a(c) until t is reached.
//
// With durations every place is two, joined by a transition that fires by itself when the token is
// ready: the net stays bounded, strongly connected, free of choice in the same clusters, and live.
#include <algorithm>

#include "disjoint_sets.h"
#include "puppetri/base/distribution.h"
#include "puppetri/net/tables.h"
#include "puppetri/proof/complement.h"
#include "puppetri/proof/semiflows.h"
#include "puppetri/proof/structural_liveness.h"

namespace puppetri::proof {

namespace {

using net::ArcKind;
using net::DurationKind;
using net::DurationTable;
using net::NetTables;

class Check {
 public:
    Check(const net::Net& net, const Plain& picture)
        : net_(net), tables_(net.tables()), picture_(picture.net) {}

    // Why the theorem does not apply; empty: it does.
    std::string obstacle() {
        for (std::uint32_t p = 0; p < net_.place_count(); ++p) {
            const std::uint32_t d = tables_.place[p].duration;
            if (d != net::kNoIndex && !ends(tables_.durations[d])) {
                return place(p) + " has a duration that is computed or open";
            }
            if (!tables_.place_rich.empty() && tables_.place_rich[p] != net::kNoIndex &&
                tables_.rich[tables_.place_rich[p]].key.valid()) {
                return place(p) + " orders its tokens by something computed";
            }
            if (tables_.place[p].kind != net::PlaceKind::kCount) {
                for (const net::Watcher& w : tables_.total_watchers(p)) {
                    if (w.inhibits()) {
                        continue;  // told by the complement
                    }
                    return transition(w.transition()) + " looks at tokens of " + place(p) +
                           " that are not ready";
                }
            }
        }
        for (const net::Special& s : tables_.specials) {
            std::string why = obstacle(s);
            if (!why.empty()) {
                return transition(s.transition) + why;
            }
        }
        return clusters();
    }

 private:
    std::string place(std::uint32_t p) const {
        return "place " + std::string(net_.place(net::PlaceIndex{p}).path);
    }
    std::string transition(std::uint32_t t) const {
        return "transition " + std::string(net_.transition(net::TransitionIndex{t}).path);
    }

    bool ends(const DurationTable& d) const {
        Value low = 0, high = 0;
        switch (d.kind) {
            case DurationKind::kConstant:
            case DurationKind::kAuto:
                return true;
            case DurationKind::kDistribution:
                return !d.constants.empty() && support(d.distribution, d.constants).low >= 0;
            case DurationKind::kInterval:
                return tables_.code.is_constant(d.a, low) && tables_.code.is_constant(d.b, high) &&
                       low >= 0 && low <= high;
            case DurationKind::kAs: {
                const std::uint32_t other = tables_.place[d.sibling].duration;
                return other == net::kNoIndex ||
                       (tables_.durations[other].kind != DurationKind::kAs &&
                        ends(tables_.durations[other]));
            }
            case DurationKind::kExpression:
            case DurationKind::kOpen:
                break;
        }
        return false;
    }

    std::string obstacle(const net::Special& s) const {
        if (s.guard.valid()) {
            return " has a guard";
        }
        if (!s.events.empty()) {
            return " waits for an event";
        }
        if (!s.assignments.empty()) {
            return " sets data";
        }
        if (s.odds.valid()) {
            return " has odds that are computed";
        }
        if (s.delay != net::kNoIndex && !ends(tables_.delays[s.delay].duration)) {
            return " has a delay that is computed or open";
        }
        std::vector<std::uint32_t> bound;
        for (const net::ArcTable& arc : s.arcs) {
            if (arc.kind != ArcKind::kTake && arc.kind != ArcKind::kRead) {
                return " does more than take and read ready tokens";
            }
            if (arc.time_left != net::kNoIndex || (arc.weight > 1 && !arc.pattern.empty())) {
                return " asks for the time left, or for several tokens that fit";
            }
            for (const net::PatternTable& p : arc.pattern) {
                if (p.binds == net::kNoIndex) {
                    return " looks for tokens that fit a pattern";
                }
                bound.push_back(p.binds);
            }
        }
        std::sort(bound.begin(), bound.end());
        if (std::adjacent_find(bound.begin(), bound.end()) != bound.end()) {
            return " looks for tokens that fit together";
        }
        for (const net::OutputTable& o : s.outputs) {
            if (o.lasts.valid()) {
                return " gives a token a duration of its own";
            }
            for (const ProgramIndex a : o.attributes) {
                Value value = 0;
                if (!tables_.code.is_slot(a) && !tables_.code.is_constant(a, value)) {
                    return " computes an attribute";
                }
            }
        }
        return {};
    }

    // Where there is a choice, it is free.
    std::string clusters() const {
        const std::uint32_t places = picture_.place_count(), count = net_.transition_count();
        DisjointSets sets(places + count);
        for (std::uint32_t t = 0; t < count; ++t) {
            for (const auto* rows : {&picture_.takes, &picture_.reads}) {
                for (const net::Weighted& w : rows->row(t)) {
                    sets.join(w.place, places + t);
                }
            }
        }
        std::vector<std::uint32_t> first(places + count, net::kNoIndex);
        for (std::uint32_t t = 0; t < count; ++t) {
            std::uint32_t& member = first[sets.find(places + t)];
            if (member == net::kNoIndex) {
                member = t;
                continue;
            }
            for (const std::uint32_t u : {member, t}) {
                const std::uint32_t special = tables_.transition[u].special;
                if (special != net::kNoIndex && tables_.specials[special].delay != net::kNoIndex) {
                    return transition(u) + " has a delay and a rival";
                }
            }
            if (tables_.transition[member].level != tables_.transition[t].level) {
                return transition(member) + " and " + transition(t) +
                       " want the same tokens with different priorities";
            }
        }
        return {};
    }

    const net::Net& net_;
    const NetTables& tables_;
    const PlainNet& picture_;
};

}  // namespace

// Endlessly many firings in one instant would go round: who takes a token that was given in the
// same instant depends on who gave it, and each firing takes one. So it is enough that no circuit
// goes through places only whose tokens may be taken at once.
bool instants_end(const net::Net& net) {
    const NetTables& tables = net.tables();
    const PlainNet picture = plain(net).net;
    const std::uint32_t count = net.transition_count();
    std::vector<std::uint8_t> takes_time(net.place_count(), 0), waits(count, 0);
    for (std::uint32_t p = 0; p < net.place_count(); ++p) {
        const std::uint32_t d = tables.place[p].duration;
        takes_time[p] = d != net::kNoIndex && tables.durations[d].kind == DurationKind::kConstant &&
                                tables.durations[d].ticks > 0
                            ? 1
                            : 0;
    }
    for (const net::Special& s : tables.specials) {
        for (const net::ArcTable& arc : s.arcs) {
            if (arc.kind == ArcKind::kTakeNow || arc.kind == ArcKind::kTakeAllNow) {
                takes_time[arc.place] = 0;
            }
        }
        for (const net::OutputTable& o : s.outputs) {
            if (o.lasts.valid()) {
                takes_time[o.place] = 0;
            }
        }
        if (s.delay != net::kNoIndex) {
            const net::DelayTable& delay = tables.delays[s.delay];
            waits[s.transition] = delay.duration.kind == DurationKind::kConstant &&
                                          delay.duration.ticks > 0 && delay.servers == 1
                                      ? 1
                                      : 0;
        }
    }
    // Firings of a transition that waits before each of them are as good as time.
    std::vector<std::vector<std::uint32_t>> consumers(net.place_count()), next(count);
    std::vector<std::uint32_t> before(count, 0);
    for (std::uint32_t t = 0; t < count; ++t) {
        if (picture.takes.row(t).empty() && waits[t] == 0) {
            return false;  // a source, or it takes all, be it nothing
        }
        for (const net::Weighted& w : picture.takes.row(t)) {
            consumers[w.place].push_back(t);
        }
    }
    for (std::uint32_t t = 0; t < count; ++t) {
        for (const net::Weighted& w : picture.gives.row(t)) {
            for (const std::uint32_t u : consumers[w.place]) {
                if (takes_time[w.place] == 0 && waits[u] == 0) {
                    next[t].push_back(u);
                    ++before[u];
                }
            }
        }
    }
    std::vector<std::uint32_t> open;
    for (std::uint32_t t = 0; t < count; ++t) {
        if (before[t] == 0) {
            open.push_back(t);
        }
    }
    std::uint32_t done = 0;
    while (!open.empty()) {
        const std::uint32_t t = open.back();
        open.pop_back();
        ++done;
        for (const std::uint32_t u : next[t]) {
            if (--before[u] == 0) {
                open.push_back(u);
            }
        }
    }
    return done == count;
}

TimedLiveness timed_liveness(const net::Net& net, const Budget& budget) {
    TimedLiveness out;
    Plain picture = plain(net);
    if (picture.unsound || picture.net.has_inhibitors()) {
        out.theorem =
            "an arc takes all tokens of a place, or is an inhibitor, or a place has a limit";
        return out;
    }
    Check check(net, picture);
    out.theorem = check.obstacle();
    if (!out.theorem.empty()) {
        return out;
    }
    picture.net.has_levels = false;  // priorities only order clusters
    picture.net.level.assign(picture.net.level.size(), 0);
    const StructuralLiveness structure = structural_liveness(picture.net, budget);
    if (!structure.live || !structure.bounded) {
        out.theorem = structure.not_live ? "the untimed net is not live"
                                         : "the untimed net is not known to be live and bounded";
        return out;
    }
    out.live_unless_stopped = true;
    out.theorem = std::string(structure.theorem) + ", and every choice stays free in time";
    out.needs_time_goes_on = !net.paced() && !instants_end(net);
    for (const net::Special& s : net.tables().specials) {
        out.needs_clean_ends = out.needs_clean_ends || !s.must_be_clean.empty();
    }
    out.live = !out.needs_time_goes_on && !out.needs_clean_ends;
    return out;
}

IdentityAnswer conserves_identity(const net::Net& net, std::span<const std::uint32_t> places,
                                  std::span<const std::uint32_t> attribute) {
    const NetTables& tables = net.tables();
    std::vector<std::uint32_t> which(net.place_count(), net::kNoIndex);
    for (std::size_t i = 0; i < places.size(); ++i) {
        which[places[i]] = attribute[i];
    }
    for (const net::Special& s : tables.specials) {
        const auto no = [&](const char* why, std::uint32_t place) {
            return IdentityAnswer{
                false, "transition " +
                           std::string(net.transition(net::TransitionIndex{s.transition}).path) +
                           why + std::string(net.place(net::PlaceIndex{place}).path)};
        };
        std::vector<std::uint32_t> taken, given;  // variables
        std::uint32_t last = 0;
        for (const net::ArcTable& arc : s.arcs) {
            const std::uint32_t a = which[arc.place];
            const bool all = arc.kind == ArcKind::kTakeAll || arc.kind == ArcKind::kTakeAllNow;
            if (a == net::kNoIndex ||
                (!all && arc.kind != ArcKind::kTake && arc.kind != ArcKind::kTakeNow)) {
                continue;
            }
            if (all || arc.weight != 1) {
                return no(" takes more than one token at once of place ", arc.place);
            }
            const auto pattern = std::find_if(
                arc.pattern.begin(), arc.pattern.end(),
                [&](const auto& p) { return p.attribute == a && p.binds != net::kNoIndex; });
            if (pattern == arc.pattern.end()) {
                return no(" does not ask whose token it takes of place ", arc.place);
            }
            taken.push_back(pattern->binds);
            last = arc.place;
        }
        for (const net::OutputTable& o : s.outputs) {
            const std::uint32_t a = which[o.place];
            if (a == net::kNoIndex) {
                continue;
            }
            const bool handed_on = o.weight == 1 && a < o.attributes.size() &&
                                   tables.code.is_slot(o.attributes[a]) &&
                                   tables.code.slots(o.attributes[a]).front().kind ==
                                       static_cast<std::uint32_t>(net::SlotKind::kVariable);
            if (!handed_on) {
                return no(" makes tokens of its own for place ", o.place);
            }
            given.push_back(tables.code.slots(o.attributes[a]).front().index);
            last = o.place;
        }
        std::sort(taken.begin(), taken.end());
        std::sort(given.begin(), given.end());
        if (taken != given || std::adjacent_find(taken.begin(), taken.end()) != taken.end()) {
            return no(" does not hand on each identity once, at place ", last);
        }
    }
    return {true, "each firing hands on the identities that it takes"};
}

}  // namespace puppetri::proof
