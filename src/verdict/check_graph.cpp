// SPDX-License-Identifier: MIT
#include "puppetri/verdict/check_graph.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "puppetri/net/tables.h"
#include "quiet.h"

namespace puppetri::verdict {
namespace {

using net::RuleKind;
using Kind = Finding::Kind;
using Target = Finding::Target;

Finding unknown(std::string reason) {
    Finding f;
    f.reason = std::move(reason);
    return f;
}

class Checker {
 public:
    Checker(const net::Net& net, const Obligation& o, const GraphView& view,
            std::uint64_t most_edges)
        : net_(net), o_(o), view_(view), graph_(view.timed->graph), most_edges_(most_edges) {}

    Finding run() {
        switch (o_.kind) {
            case RuleKind::kBounded:
                return o_.operands.empty() ? finite() : safety();
            case RuleKind::kLeadsTo:
            case RuleKind::kTakesAtMost:
                return o_.within ? in_time() : eventually();
            case RuleKind::kEnds:
                return ends();
            case RuleKind::kDeadlockFree:
                return deadlock_free();
            case RuleKind::kLive:
                return live();
            case RuleKind::kQuasiLive:
                return quasi_live();
            case RuleKind::kReversible:
                return reversible();
            case RuleKind::kNobodyFreezes:
                return nobody_freezes();
            case RuleKind::kFormula:
                return unknown("a temporal formula");
            default:
                return safety();
        }
    }

 private:
    Product product(const Monitor* monitor) const {
        return make_product(graph_, monitor, most_edges_, view_.timed->stops, net_.paced());
    }
    // All runs are paths, and all paths have been looked at.
    bool covers(const Product& p) const { return graph_.over && p.complete; }

    Finding cut_short() const {
        if (!graph_.over) {
            return unknown(view_.timed->not_over.empty() ? "the method does not see every run"
                                                         : "the method does not see every run: " +
                                                               view_.timed->not_over.front());
        }
        if (graph_.ended != proof::Ended::kDone) {
            return unknown(std::string("not all states were looked at: ") +
                           proof::name_of(graph_.ended));
        }
        return unknown("not all states were looked at");
    }

    Finding suspect(Product p, Nodes targets, Target target, std::string reason) const {
        Finding f;
        f.kind = Kind::kSuspect;
        f.target = target;
        f.reason = std::move(reason);
        f.product = std::move(p);
        f.targets = std::move(targets);
        return f;
    }
    static Finding holds(Force force = Force::kPlain) {
        Finding f;
        f.kind = Kind::kHolds;
        f.force = force;
        return f;
    }
    static Nodes where(const Product& p, bool (*test)(const Product&, std::uint32_t)) {
        Nodes nodes(p.size(), 0);
        for (std::uint32_t n = 0; n < p.size(); ++n) {
            nodes[n] = test(p, n) ? 1 : 0;
        }
        return nodes;
    }
    static bool any(const Nodes& nodes) {
        return std::find(nodes.begin(), nodes.end(), 1) != nodes.end();
    }

    // Some moment of the graph may make the operand true.
    bool ever(const Operand& operand) const {
        if (operand.at(Product::row_of(graph_, graph_.initial), Operand::kNoFiring).may) {
            return true;
        }
        for (std::uint32_t s = 0; s < graph_.size(); ++s) {
            for (const proof::Edge& e : graph_.edges.row(s)) {
                if (operand.at(Product::row_of(graph_, e.target), e.label).may) {
                    return true;
                }
                // `only if` reads a firing with the state before it.
                if (o_.kind == RuleKind::kOnlyIf &&
                    operand.at(Product::row_of(graph_, s), e.label).may) {
                    return true;
                }
            }
        }
        return false;
    }
    void tell_vacuity(Finding& f) const {
        const bool conditional = o_.kind == RuleKind::kOnlyIf || o_.kind == RuleKind::kUntil ||
                                 o_.kind == RuleKind::kLeadsTo || o_.kind == RuleKind::kTakesAtMost;
        if (conditional && !ever(o_.operands[0])) {
            f.notes.push_back("vacuous: what the rule begins with never happens");
        }
        if (o_.kind == RuleKind::kAlternate) {
            std::size_t silent = 0;
            for (const Operand& operand : o_.operands) {
                silent += ever(operand) ? 0 : 1;
            }
            if (silent == o_.operands.size()) {
                f.notes.push_back("vacuous: none of them ever happens");
            } else if (silent > 0) {
                f.notes.push_back(std::to_string(silent) + " of them never happens");
            }
        }
        if (o_.kind == RuleKind::kMutex) {
            std::size_t happen = 0;
            for (const Operand& operand : o_.operands) {
                happen += ever(operand) ? 1 : 0;
            }
            if (happen < 2) {
                f.notes.push_back("vacuous: at most one of them ever happens");
            }
        }
    }

    Finding safety() {
        const Monitor monitor(o_);
        Product p = product(&monitor);
        Nodes broken = where(p, [](const Product& q, std::uint32_t n) { return q.broken(n); });
        const bool possible = o_.kind == RuleKind::kPossible;
        if (any(broken)) {
            return suspect(std::move(p), std::move(broken), Target::kBroken,
                           possible ? "it may hold" : how_broken(o_.kind));
        }
        if (!covers(p)) {
            return cut_short();
        }
        if (possible) {
            Finding f;
            f.kind = Kind::kImpossible;
            f.reason = "no run of the net gets there, whatever its timing";
            return f;
        }
        Finding f = holds();
        tell_vacuity(f);
        return f;
    }

    // `bounded` without a number: all states have been found.
    Finding finite() {
        if (graph_.over && graph_.ended == proof::Ended::kDone) {
            return holds();
        }
        Finding f = cut_short();
        // Who grew most, where the search was then.
        std::uint32_t most = 0, where = 0;
        for (std::uint32_t p = 0; graph_.size() > 0 && p < net_.place_count(); ++p) {
            const std::uint32_t n =
                view_.timed->tokens(graph_.size() - 1, net::PlaceIndex{p}).total;
            if (n > most) {
                most = n;
                where = p;
            }
        }
        if (most > 0) {
            f.reason += "; place " + std::string(net_.place(net::PlaceIndex{where}).path) +
                        " has " + std::to_string(most) + " tokens there and may grow for ever";
        }
        return f;
    }

    Nodes owing(const Product& p, const Monitor& monitor) const {
        Nodes open(p.size(), 0);
        for (std::uint32_t n = 0; n < p.size(); ++n) {
            open[n] = monitor.owes(p.monitor[n]) ? 1 : 0;
        }
        return open;
    }

    // Where a run may rest although something is owed.
    static Nodes resting(const Product& p, const Nodes& open) {
        Nodes nodes(p.size(), 0);
        for (std::uint32_t n = 0; n < p.size(); ++n) {
            nodes[n] = open[n] != 0 && p.rests(n) ? 1 : 0;
        }
        return nodes;
    }
    static Nodes set_of(const Product& p, const std::vector<std::uint32_t>& list) {
        Nodes nodes(p.size(), 0);
        for (const std::uint32_t n : list) {
            nodes[n] = 1;
        }
        return nodes;
    }

    // Nodes from which no path leaves `open`, unless the outside helps.
    Nodes hopeless(const Product& p, const Nodes& open) const {
        Nodes lost(p.size(), 0);
        if (!covers(p)) {
            return lost;
        }
        Nodes out(p.size(), 0);
        for (std::uint32_t n = 0; n < p.size(); ++n) {
            out[n] = open[n] == 0 ? 1 : 0;
        }
        std::vector<std::uint8_t> optional(p.targets.size(), 0);
        for (std::uint64_t e = 0; e < p.targets.size(); ++e) {
            optional[e] = view_.timed->waits.is_by_outside(graph_.edges.items[p.edge[e]]) ? 1 : 0;
        }
        const std::vector<std::uint32_t> far = distances(p, out, optional);
        for (std::uint32_t n = 0; n < p.size(); ++n) {
            lost[n] = far[n] == kFar ? 1 : 0;
        }
        return lost;
    }

    // The greatest part of `open` that a run can be kept in by times and the outside, whoever wins
    // ties: nodes where only ties decide have to have every winner's edge in it.
    Nodes kept_in(const Product& p, const Nodes& open) const {
        Nodes inside = open;
        bool changed = true;
        while (changed) {
            changed = false;
            for (std::uint32_t n = 0; n < p.size(); ++n) {
                if (inside[n] == 0 || p.rests(n)) {
                    continue;
                }
                bool some = false, every_winner = true, tie = false;
                for (std::uint64_t e = p.starts[n]; e < p.starts[n + 1];) {
                    const std::uint32_t label = p.label(e);
                    bool stays = false;  // some edge of this label
                    for (; e < p.starts[n + 1] && p.label(e) == label; ++e) {
                        stays = stays || inside[p.targets[e]] != 0;
                    }
                    if ((label & proof::Edge::kEvent) == 0) {
                        tie = true;
                        every_winner = every_winner && stays;
                    } else {
                        some = some || stays;
                    }
                }
                if (!some && !(tie && every_winner)) {
                    inside[n] = 0;
                    changed = true;
                }
            }
        }
        return inside;
    }

    // Every path leaves `open` (where it does not rest); or those that do not are unlucky for ever.
    Finding leaves(Product p, const Nodes& open, const char* owed) {
        const auto cycle = endless(p, open, {}, &view_.timed->waits);
        if (!cycle) {
            if (!covers(p)) {
                return cut_short();
            }
            Finding f = holds(Force::kEveryChoice);
            tell_vacuity(f);
            return f;
        }
        // Where neither times nor the outside can keep it from the way out, only ties can: then it
        // is taken with probability 1, since there are finitely many nodes.
        if (covers(p) && !endless(p, kept_in(p, open), {}, &view_.timed->waits)) {
            Finding f = suspect(std::move(p), {}, Target::kEndless,
                                std::string("only ever-unlucky ties (probability 0) go "
                                            "round for ever ") +
                                    owed);
            f.kind = Kind::kHolds;
            f.force = Force::kProbabilityOne;
            f.targets = set_of(f.product, *cycle);
            tell_vacuity(f);
            return f;
        }
        Nodes target = set_of(p, *cycle);
        return suspect(std::move(p), std::move(target), Target::kEndless,
                       std::string("it may go round for ever ") + owed);
    }

    // A run that rests in `rest`, or gets to where it is hopeless, refutes it.
    std::optional<Finding> stuck(Product& p, const Nodes& open, Nodes rest, const char* resting,
                                 const char* owed) {
        Nodes lost = hopeless(p, open);
        const bool rests = any(rest);
        if (!any(lost)) {
            return rests ? std::optional(
                               suspect(std::move(p), std::move(rest), Target::kRest, resting))
                         : std::nullopt;
        }
        for (std::uint32_t n = 0; n < p.size(); ++n) {
            rest[n] = rest[n] != 0 || lost[n] != 0 ? 1 : 0;
        }
        Finding f = suspect(std::move(p), std::move(rest), Target::kHopeless,
                            rests ? std::string(resting) + ", or is out of reach"
                                  : std::string("what is awaited is out of reach ") + owed);
        f.certain = std::move(lost);
        return f;
    }

    Finding eventually() {
        const Monitor monitor(o_);
        Product p = product(&monitor);
        const Nodes open = owing(p, monitor);
        if (auto f = stuck(p, open, resting(p, open),
                           "everything may come to rest before it happens", "before it happens")) {
            return std::move(*f);
        }
        return leaves(std::move(p), open, "before it happens");
    }

    Finding ends() {
        Product p = product(nullptr);
        const bool declared = !net_.tables().finals.empty();
        Nodes open(p.size(), 1);
        Nodes wrong(p.size(), 0);
        for (std::uint32_t n = 0; n < p.size(); ++n) {
            if (p.rests(n)) {
                const bool good = !declared || (p.final_marking(n) && !p.stops(n));
                wrong[n] = good ? 0 : 1;
                if (good && graph_.dead(p.state[n])) {
                    open[n] = 0;
                }
            }
        }
        // Polls that nobody answers any more are a rest like any other.
        const Nodes quiet = quiet_for_ever(p), perhaps = quiet_perhaps(p, {}, &view_.timed->waits);
        Nodes surely_open = open;
        for (std::uint32_t n = 0; n < p.size(); ++n) {
            if (!declared || p.final_marking(n)) {
                open[n] = quiet[n] != 0 ? 0 : open[n];
                surely_open[n] = perhaps[n] != 0 ? 0 : open[n];
            }
        }
        if (auto f = stuck(p, surely_open, std::move(wrong),
                           "it may come to rest where no end is declared", "without an end")) {
            return std::move(*f);
        }
        // States that may rest, but need not, are ends; what goes on from them must end as well.
        return leaves(std::move(p), open, "without an end");
    }

    Finding deadlock_free() {
        Product p = product(nullptr);
        Nodes dead(p.size(), 0), silent(p.size(), 0);
        const Nodes quiet = graph_.over ? quiet_for_ever(p) : Nodes(p.size(), 0);
        for (std::uint32_t n = 0; n < p.size(); ++n) {
            dead[n] = p.rests(n) && !p.final_marking(n) && !p.stops(n) ? 1 : 0;
            silent[n] = quiet[n] != 0 && !p.final_marking(n) ? 1 : 0;
        }
        // Where there is a dead marking, it is the plainer thing to show.
        if (any(dead)) {
            return suspect(std::move(p), std::move(dead), Target::kRest,
                           "everything may come to rest where no end is declared");
        }
        if (any(silent)) {
            Nodes certain = silent;
            Finding f = suspect(std::move(p), std::move(silent), Target::kHopeless,
                                "it may come to where nothing ever fires again, though events go "
                                "on, and no end is declared");
            f.certain = std::move(certain);
            return f;
        }
        return covers(p) ? holds() : cut_short();
    }

    // From everywhere one of the edges, or of the nodes, can be reached (or a run rests in an end,
    // where that is good enough).
    Finding stays_possible(Product p, const std::vector<std::uint8_t>& may_edges,
                           const std::vector<std::uint8_t>& must_edges, const Nodes& may_nodes,
                           const Nodes& must_nodes, const std::string& what) {
        if (!covers(p)) {
            return cut_short();
        }
        const std::vector<std::uint32_t> far = distances_to_edges(p, may_edges, may_nodes);
        Nodes hopeless(p.size(), 0);
        for (std::uint32_t n = 0; n < p.size(); ++n) {
            hopeless[n] = far[n] == kFar ? 1 : 0;
        }
        if (any(hopeless)) {
            Finding f = suspect(std::move(p), std::move(hopeless), Target::kHopeless,
                                what + " can become impossible for ever");
            f.certain = f.targets;
            return f;
        }
        if (view_.concrete && graph_.exact) {
            return holds();
        }
        // It cannot be avoided: then it is possible a fortiori.
        Nodes open(p.size(), 0);
        bool rests = false;
        for (std::uint32_t n = 0; n < p.size(); ++n) {
            open[n] = must_nodes.empty() || must_nodes[n] == 0 ? 1 : 0;
            rests = rests || (open[n] != 0 && p.rests(n));
        }
        if (!rests && !endless(p, open, must_edges, &view_.timed->waits)) {
            return holds(Force::kEveryChoice);
        }
        return unknown(what +
                       " stays possible as far as this method sees, but may be put off for ever; "
                       "only an exact method can say more");
    }

    Finding live() {
        Product p = product(nullptr);
        for (const std::uint32_t t : o_.transitions) {
            std::vector<std::uint8_t> edges(p.targets.size(), 0);
            for (std::uint64_t e = 0; e < p.targets.size(); ++e) {
                edges[e] = p.label(e) == t ? 1 : 0;
            }
            const std::string name(net_.transition(net::TransitionIndex{t}).path);
            const bool last = t == o_.transitions.back();
            Finding f = stays_possible(last ? std::move(p) : Product(p), edges, edges, {}, {},
                                       "firing " + name);
            if (f.kind != Kind::kHolds || last) {
                f.transition = t;
                f.subject = name;
                return f;
            }
        }
        return holds();
    }

    Finding quasi_live() {
        Product p = product(nullptr);
        std::vector<std::uint8_t> seen(net_.transition_count(), 0);
        for (std::uint64_t e = 0; e < p.targets.size(); ++e) {
            if (p.label(e) < seen.size()) {
                seen[p.label(e)] = 1;
            }
        }
        for (const std::uint32_t t : o_.transitions) {
            if (seen[t] == 0) {
                if (!covers(p)) {
                    return cut_short();
                }
                Finding f;
                f.kind = Kind::kImpossible;
                f.transition = t;
                f.subject = net_.transition(net::TransitionIndex{t}).path;
                f.reason = f.subject + " never fires, whatever the timing";
                return f;
            }
        }
        const std::vector<std::uint8_t>& c = view_.timed->coincidental;
        if (graph_.exact && std::find(c.begin(), c.end(), 1) == c.end()) {
            return holds();
        }
        Nodes none(p.size(), 0);
        return suspect(std::move(p), std::move(none), Target::kFires,
                       "each of them may fire, as far as this method sees");
    }

    Finding reversible() {
        Product p = product(nullptr);
        Nodes may(p.size(), 0), must(p.size(), 0);
        for (std::uint32_t n = 0; n < p.size(); ++n) {
            const Truth t = o_.operands[0].at(p.row(n), Operand::kNoFiring);
            may[n] = t.may ? 1 : 0;
            must[n] = t.must ? 1 : 0;
        }
        return stays_possible(std::move(p), {}, {}, may, must, "the start");
    }

    Finding nobody_freezes() {
        Product p = product(nullptr);
        Finding weakest = holds(Force::kEveryChoice);
        // Where an end is declared and nothing happens any more, everything has come to rest.
        const std::vector<std::uint8_t> idle = idle_firings(net_);
        Nodes must_end = quiet_for_ever(p, idle),
              may_end = quiet_perhaps(p, idle, &view_.timed->waits);
        for (std::uint32_t n = 0; n < p.size(); ++n) {
            const bool final = p.final_marking(n);
            must_end[n] = final && (must_end[n] != 0 || p.rests(n)) ? 1 : 0;
            may_end[n] = final && (may_end[n] != 0 || p.rests(n)) ? 1 : 0;
        }
        for (std::size_t i = 0; i < o_.operands.size(); ++i) {
            const Operand& moves = o_.operands[i];
            const std::string who =
                i < o_.subjects.size() ? o_.subjects[i] : "figure " + std::to_string(i + 1);
            if (moves.never()) {
                weakest.notes.push_back(who + " has no movements at all");
                continue;
            }
            std::vector<std::uint8_t> may(p.targets.size(), 0), must(p.targets.size(), 0);
            for (std::uint32_t n = 0; n < p.size(); ++n) {
                for (std::uint64_t e = p.starts[n]; e < p.starts[n + 1]; ++e) {
                    const Truth t = moves.at(p.row(p.targets[e]), p.label(e));
                    may[e] = t.may ? 1 : 0;
                    must[e] = t.must ? 1 : 0;
                }
            }
            Finding f = stays_possible(Product(p), may, must, may_end, must_end,
                                       "another movement of " + who);
            if (f.kind != Kind::kHolds) {
                f.subject = who;
                return f;
            }
            if (f.force == Force::kPlain) {
                weakest.force = Force::kPlain;
            }
        }
        return weakest;
    }

    // Leads to within T, takes at most T.
    Finding in_time() {
        const Monitor monitor(o_);
        Product p = product(&monitor);
        const Nodes open = owing(p, monitor);
        Nodes begins(p.size(), 0);
        std::vector<std::uint32_t> from;
        const auto begin = [&](std::uint32_t n) {
            if (open[n] != 0 && begins[n] == 0) {
                begins[n] = 1;
                from.push_back(n);
            }
        };
        for (const std::uint32_t n : p.first) {
            begin(n);
        }
        for (std::uint32_t n = 0; n < p.size(); ++n) {
            for (std::uint64_t e = p.starts[n]; e < p.starts[n + 1] && open[n] == 0; ++e) {
                begin(p.targets[e]);
            }
        }
        Nodes rest = resting(p, open);
        if (any(rest)) {
            return suspect(std::move(p), std::move(rest), Target::kRest,
                           "everything may come to rest before it happens");
        }
        if (from.empty()) {
            if (!covers(p)) {
                return cut_short();
            }
            Finding f = holds(Force::kEveryChoice);
            tell_vacuity(f);
            return f;
        }
        const std::int64_t allowed = o_.within->ticks;
        if (covers(p)) {
            const auto stay =
                longest_stay(p, open, from, view_.by_ticks, &view_.timed->waits, view_.at_most);
            if (stay && *stay <= allowed) {
                Finding f = holds(Force::kEveryChoice);
                tell_vacuity(f);
                return f;
            }
        }
        // Begin with those that may take too long.
        Nodes late(p.size(), 0);
        for (const std::uint32_t n : from) {
            const auto stay =
                longest_stay(p, open, {n}, view_.by_ticks, &view_.timed->waits, view_.at_most);
            late[n] = !stay || *stay > allowed ? 1 : 0;
        }
        if (!any(late)) {
            return cut_short();
        }
        return suspect(std::move(p), std::move(late), Target::kTooLong,
                       "it may take longer than that");
    }

    const net::Net& net_;
    const Obligation& o_;
    const GraphView& view_;
    const proof::Graph& graph_;
    const std::uint64_t most_edges_;
};

}  // namespace

const char* how_broken(net::RuleKind kind) {
    switch (kind) {
        case net::RuleKind::kNever:
            return "what must never be can be";
        case net::RuleKind::kAlways:
            return "what must always hold can fail";
        case net::RuleKind::kMutex:
            return "two of them can be true at once";
        case net::RuleKind::kExactlyOne:
            return "none of them, or more than one, can be true";
        case net::RuleKind::kBounded:
            return "there can be more tokens than allowed";
        case net::RuleKind::kAlternate:
            return "they can go out of turn";
        case net::RuleKind::kOnlyIf:
            return "it can happen without its condition";
        case net::RuleKind::kUntil:
            return "it can happen too early";
        default:
            return "a run can break it";
    }
}

Finding check_on_graph(const net::Net& net, const Obligation& obligation, const GraphView& view,
                       std::uint64_t most_edges) {
    return Checker(net, obligation, view, most_edges).run();
}

std::vector<std::int64_t> longest_waits(const net::Net& net,
                                        const std::vector<proof::TickRange>& actions) {
    const net::NetTables& tables = net.tables();
    std::vector<std::int64_t> most(net.place_count() + net.transition_count(), kNoLimit);
    const auto of = [&](const net::DurationTable& d, net::ActionIndex action) -> std::int64_t {
        Value value = 0;
        switch (d.kind) {
            case net::DurationKind::kConstant:
                return d.ticks;
            case net::DurationKind::kExpression:
                return tables.code.is_constant(d.a, value) ? value : kNoLimit;
            case net::DurationKind::kInterval:
                return tables.code.is_constant(d.b, value) ? value : kNoLimit;
            case net::DurationKind::kDistribution: {
                if (d.constants.empty() || !check(d.distribution, d.constants)) {
                    return kNoLimit;
                }
                const double high = support(d.distribution, d.constants).high * kTicksPerSecond;
                return high < 9e17 ? static_cast<std::int64_t>(std::ceil(high)) + 1 : kNoLimit;
            }
            case net::DurationKind::kAuto:
                return action.valid() && action.value < actions.size() ? actions[action.value].high
                                                                       : kNoLimit;
            default:
                return kNoLimit;
        }
    };
    // Arcs may give a token a duration of their own: nothing is claimed of such places.
    std::vector<std::uint8_t> own(net.place_count(), 0);
    for (const net::Special& s : tables.specials) {
        for (const net::OutputTable& out : s.outputs) {
            if (out.lasts.valid()) {
                own[out.place] = 1;
            }
        }
    }
    for (std::uint32_t p = 0; p < net.place_count(); ++p) {
        std::uint32_t number = tables.place[p].duration;
        std::uint32_t place = p;
        for (int hops = 0; hops < 64 && number != net::kNoIndex &&
                           tables.durations[number].kind == net::DurationKind::kAs;
             ++hops) {
            place = tables.durations[number].sibling;
            number = tables.place[place].duration;
        }
        if (number != net::kNoIndex && own[p] == 0 && own[place] == 0) {
            most[p] = of(tables.durations[number], net.action(net::PlaceIndex{place}));
        }
    }
    for (const net::DelayTable& d : tables.delays) {
        if (d.servers == 1 && d.memory == net::DelayMemory::kEnabling) {
            most[net.place_count() + d.transition] = of(d.duration, {});
        }
    }
    return most;
}

}  // namespace puppetri::verdict
