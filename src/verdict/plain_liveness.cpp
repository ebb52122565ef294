// SPDX-License-Identifier: MIT
// What can, or will, happen from every marking: liveness, the way back, ends. By theorem, by the
// bottom components of the graph of markings, on decision diagrams.
#include <algorithm>
#include <utility>

#include "plain_session.h"
#include "puppetri/proof/structural_liveness.h"

namespace puppetri::verdict {

namespace {

using proof::Predicate;
using proof::StateSet;
using proof::StrongComponents;
using proof::Truth;

constexpr std::uint32_t kNone = ~std::uint32_t{0};

// A run that ends shows that nothing else happens any more.
Firings dead_end(PlainSession& session) {
    return way_to_death(session, Predicate::constant(false));
}

// The first state, in the order of breadth-first search, of a bottom component that the test picks.
template <class Test>
std::uint32_t first_in_bottom(const PlainSession::Markings& m, Test&& test) {
    for (std::uint32_t s = 0; s < m.plain.graph.size(); ++s) {
        const std::uint32_t c = m.components.of[s];
        if (m.bottoms[c] && test(s, c)) {
            return s;
        }
    }
    return kNone;
}

// Live: in every bottom component of the graph every transition fires.
Outlook live_by_graph(PlainSession& session, std::span<const std::uint32_t> transitions) {
    const PlainSession::Markings* m = session.markings(0.6);
    if (m == nullptr) {
        return {};
    }
    const proof::Graph& graph = m->plain.graph;
    std::vector<std::uint32_t> number(m->components.count, 0);
    std::uint64_t count = 0;
    m->bottoms.for_each([&](std::uint32_t c) { number[c] = static_cast<std::uint32_t>(count++); });
    // Per bottom component, the transitions that fire in it.
    const std::uint64_t all = session.plain().transition_count();
    if (count * all > std::uint64_t{1} << 31) {
        return {};
    }
    proof::StateBits fires(static_cast<std::uint32_t>(count * all));
    const auto bit = [&](std::uint32_t component, std::uint32_t t) {
        return static_cast<std::uint32_t>(number[component] * all + t);
    };
    for (std::uint32_t s = 0; s < graph.size(); ++s) {
        const std::uint32_t c = m->components.of[s];
        if (m->bottoms[c]) {
            for (const proof::Edge& e : graph.edges.row(s)) {
                fires.add(bit(c, e.label));
            }
        }
    }
    Outlook out{.decision = {Truth::kTrue, How::kExploration}};
    const std::uint32_t at = first_in_bottom(*m, [&](std::uint32_t, std::uint32_t c) {
        for (const std::uint32_t t : transitions) {
            if (!fires[bit(c, t)]) {
                out.transition = t;
                return true;
            }
        }
        return false;
    });
    if (at != kNone) {
        out.decision.truth = Truth::kFalse;
        out.out = m->plain.firings_to(at);
    }
    return out;
}

Outlook live_by_diagrams(PlainSession& session, proof::SymbolicSpace* space, double fraction,
                         std::span<const std::uint32_t> transitions, bool with_way) {
    if (space == nullptr) {
        return {};
    }
    space->renew(session.share(fraction));
    for (const std::uint32_t t : transitions) {
        const std::optional<bool> live = space->live(t);
        if (!live.has_value()) {
            return {};
        }
        if (!*live) {
            Outlook out{.decision = {Truth::kFalse, How::kDiagrams}, .transition = t};
            if (with_way) {
                space->renew(session.share(0.5));
                out.out =
                    space->path_to(space->complement(space->ef(space->enabled(t, space->all()))));
            }
            return out;
        }
    }
    return {.decision = {Truth::kTrue, How::kDiagrams}};
}

}  // namespace

std::vector<Predicate> each_may_fire(const proof::PlainNet& net,
                                     std::span<const std::uint32_t> transitions) {
    std::vector<Predicate> goals;
    for (const std::uint32_t t : transitions) {
        std::vector<std::uint32_t> above;
        for (std::uint32_t u = 0; net.has_levels && u < net.transition_count(); ++u) {
            if (net.level[u] > net.level[t]) {
                above.push_back(u);
            }
        }
        const Predicate both[] = {Predicate::enabled({t}),
                                  Predicate::enabled(std::move(above)).negated()};
        goals.push_back(Predicate::all_of(both));
    }
    return goals;
}

Outlook decide_quasi_live(PlainSession& session, std::span<const std::uint32_t> transitions) {
    const std::vector<Decision> reached =
        decide_reachable(session, each_may_fire(session.plain(), transitions));
    Outlook out{.decision = {Truth::kTrue, How::kStructure}};
    for (std::size_t i = 0; i < reached.size(); ++i) {
        if (reached[i].truth == Truth::kFalse) {
            return {.decision = reached[i], .transition = transitions[i]};
        }
        if (reached[i].truth == Truth::kUnknown || out.decision.truth == Truth::kTrue) {
            out.decision = reached[i];
        }
    }
    return out;
}

Outlook decide_live(PlainSession& session, std::span<const std::uint32_t> transitions,
                    bool with_way) {
    const proof::PlainNet& net = session.plain();
    const bool all = transitions.size() == net.transition_count();
    const proof::StructuralLiveness by_theorem =
        proof::structural_liveness(net, session.share(0.1, 1));
    if (by_theorem.live || transitions.empty()) {
        return {.decision = {Truth::kTrue, How::kStructure}};
    }
    if (by_theorem.not_live && all && !with_way) {
        return {.decision = {Truth::kFalse, How::kStructure}};
    }
    // Where nothing can fire any more, or something never could, the net is not live.
    const Predicate dead[] = {Predicate::no_successor(net)};
    const Decision quick = decide_reachable_quickly(session, dead)[0];
    if (quick.truth == Truth::kTrue) {
        Outlook out{.decision = {Truth::kFalse, quick.how}, .transition = transitions[0]};
        if (with_way) {
            out.out = dead_end(session);
        }
        return out;
    }
    const std::vector<Decision> may =
        decide_reachable_quickly(session, each_may_fire(net, transitions));
    for (std::size_t i = 0; i < may.size(); ++i) {
        if (may[i].truth == Truth::kFalse) {  // not even from the start
            return {.decision = may[i],
                    .out = std::vector<std::uint32_t>(),
                    .transition = transitions[i]};
        }
    }
    Outlook result =
        live_by_diagrams(session, session.quick_symbolic(), 0.1, transitions, with_way);
    if (result.decision.truth == Truth::kUnknown) {
        result = live_by_graph(session, transitions);
    }
    if (result.decision.truth == Truth::kUnknown) {
        result = live_by_diagrams(session, session.symbolic(0.7), 1, transitions, with_way);
    }
    return result;
}

Outlook decide_reversible(PlainSession& session) {
    Outlook out;
    const auto drawn = [&](proof::SymbolicSpace* space, double fraction) {
        if (space == nullptr) {
            return;
        }
        space->renew(session.share(fraction));
        const StateSet far = space->complement(space->ef(space->initial()));
        const std::optional<bool> none = space->empty(far);
        if (none.has_value()) {
            out.decision = {proof::truth_of(*none), How::kDiagrams};
            if (!*none) {
                space->renew(session.share(0.5));
                out.out = space->path_to(far);
            }
        }
    };
    drawn(session.quick_symbolic(), 0.1);
    if (out.decision.truth != Truth::kUnknown) {
        return out;
    }
    if (const PlainSession::Markings* m = session.markings(0.6)) {
        const std::uint32_t home = m->components.of[m->plain.graph.initial];
        const std::uint32_t away =
            first_in_bottom(*m, [&](std::uint32_t, std::uint32_t c) { return c != home; });
        out.decision = {proof::truth_of(away == kNone), How::kExploration};
        if (away != kNone) {
            out.out = m->plain.firings_to(away);
        }
        return out;
    }
    drawn(session.symbolic(0.7), 1);
    return out;
}

Outlook decide_ends(PlainSession& session, const Predicate& final) {
    const bool declared = !final.is_constant(false);
    Outlook out;
    const auto drawn = [&](proof::SymbolicSpace* space, double fraction) {
        if (space == nullptr) {
            return;
        }
        space->renew(session.share(fraction));
        const StateSet rest = space->stuck();
        const StateSet good = declared ? space->both(rest, space->satisfying(final)) : rest;
        const StateSet hopeless = space->complement(space->ef(good));
        const std::optional<bool> always = space->empty(hopeless);
        const std::optional<bool> forever =
            space->holds_initially(space->eg(space->complement(rest)));
        if (always.has_value() && !*always) {
            out.decision = {Truth::kFalse, How::kDiagrams};
            out.out = space->path_to(hopeless);
        } else if (always.has_value() && forever.has_value()) {
            out.decision = {Truth::kTrue, How::kDiagrams};
            out.unlucky = *forever;
        }
    };
    drawn(session.quick_symbolic(), 0.2);
    if (out.decision.truth != Truth::kUnknown) {
        return out;
    }
    if (const PlainSession::Markings* m = session.markings(0.6)) {
        const proof::Graph& graph = m->plain.graph;
        const std::uint32_t lost = first_in_bottom(*m, [&](std::uint32_t s, std::uint32_t) {
            return !graph.dead(s) ||
                   (declared && !final.holds(session.plain(), m->plain.marking(s)));
        });
        if (lost != kNone) {
            out.decision = {Truth::kFalse, How::kExploration};
            out.out = m->plain.firings_to(lost);
        } else {
            out.decision = {Truth::kTrue, How::kExploration};
            out.unlucky = !proof::cyclic_components(graph, m->components).empty();
        }
        return out;
    }
    drawn(session.symbolic(0.7), 1);
    return out;
}

}  // namespace puppetri::verdict
