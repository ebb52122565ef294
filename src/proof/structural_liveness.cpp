// SPDX-License-Identifier: MIT
// Theorems about liveness, component by component.
#include "puppetri/proof/structural_liveness.h"

#include <algorithm>

#include "disjoint_sets.h"
#include "puppetri/proof/complement.h"
#include "puppetri/proof/components.h"
#include "puppetri/proof/linear_program.h"
#include "puppetri/proof/net_class.h"
#include "puppetri/proof/semiflows.h"

namespace puppetri::proof {

namespace {

constexpr std::uint32_t kNone = ~std::uint32_t{0};

// The input places of a transition, reads among them.
template <class Visit>
void each_input(const PlainNet& net, std::uint32_t t, Visit visit) {
    for (const auto* rows : {&net.takes, &net.reads}) {
        for (const net::Weighted& w : rows->row(t)) {
            visit(w.place);
        }
    }
}
template <class Visit>
void each_output(const PlainNet& net, std::uint32_t t, Visit visit) {
    for (const auto* rows : {&net.gives, &net.reads}) {
        for (const net::Weighted& w : rows->row(t)) {
            visit(w.place);
        }
    }
}

// The unmarked places of a circuit without tokens; empty: every circuit has one. Needs a marked
// graph: transitions that wait for each other's unmarked places, in a ring.
PlaceSet unmarked_circuit(const PlainNet& net) {
    const std::uint32_t transitions = net.transition_count();
    std::vector<std::uint32_t> producer(net.place_count(), kNone), waits(transitions, 0);
    for (std::uint32_t t = 0; t < transitions; ++t) {
        each_output(net, t, [&](std::uint32_t p) { producer[p] = t; });
        each_input(net, t, [&](std::uint32_t p) { waits[t] += net.initial[p] == 0 ? 1 : 0; });
    }
    // Whoever waits for nobody can go; the others wait in circles.
    std::vector<std::uint32_t> open;
    for (std::uint32_t t = 0; t < transitions; ++t) {
        if (waits[t] == 0) {
            open.push_back(t);
        }
    }
    std::vector<std::uint32_t> consumer(net.place_count(), kNone);
    for (std::uint32_t t = 0; t < transitions; ++t) {
        each_input(net, t, [&](std::uint32_t p) { consumer[p] = t; });
    }
    while (!open.empty()) {
        const std::uint32_t t = open.back();
        open.pop_back();
        each_output(net, t, [&](std::uint32_t p) {
            if (net.initial[p] == 0 && --waits[consumer[p]] == 0) {
                open.push_back(consumer[p]);
            }
        });
    }
    const auto stuck =
        std::find_if(waits.begin(), waits.end(), [](std::uint32_t w) { return w > 0; });
    if (stuck == waits.end()) {
        return {};
    }
    // Walk backwards through unmarked places of stuck transitions until one comes again.
    std::vector<std::uint32_t> seen(transitions, kNone);
    std::vector<std::uint32_t> way;
    auto t = static_cast<std::uint32_t>(stuck - waits.begin());
    while (seen[t] == kNone) {
        seen[t] = static_cast<std::uint32_t>(way.size());
        std::uint32_t through = kNone;
        each_input(net, t, [&](std::uint32_t p) {
            if (net.initial[p] == 0 && waits[producer[p]] > 0) {
                through = p;
            }
        });
        way.push_back(through);
        t = producer[through];
    }
    PlaceSet circuit(way.begin() + seen[t], way.end());
    std::sort(circuit.begin(), circuit.end());
    return circuit;
}

// The columns or rows of C have a combination with all factors at least 1.
bool has_positive_flow(const PlainNet& net, bool of_places, const Budget& budget) {
    const std::vector<Flow> columns = effects(net);
    LinearProgram program;
    std::vector<std::vector<LinearProgram::Term>> rows(of_places ? net.transition_count()
                                                                 : net.place_count());
    const std::uint32_t unknowns = of_places ? net.place_count() : net.transition_count();
    for (std::uint32_t i = 0; i < unknowns; ++i) {
        program.at_least(program.variable(), 1);
    }
    for (std::uint32_t t = 0; t < columns.size(); ++t) {
        for (const Flow::Term& term : columns[t].terms) {
            if (of_places) {
                rows[t].push_back({term.index, term.factor});
            } else {
                rows[term.index].push_back({t, term.factor});
            }
        }
    }
    for (const auto& row : rows) {
        const std::uint32_t sum = program.sum(row);
        program.at_least(sum, 0);
        program.at_most(sum, 0);
    }
    Meter meter(budget, "flows");
    return is_feasible(program, meter);
}

std::uint32_t count_clusters(const PlainNet& net) {
    DisjointSets sets(net.place_count() + net.transition_count());
    for (std::uint32_t t = 0; t < net.transition_count(); ++t) {
        each_input(net, t, [&](std::uint32_t p) { sets.join(p, net.place_count() + t); });
    }
    std::uint32_t count = 0;
    sets.numbered(count);
    return count;
}

bool is_well_formed(const PlainNet& net, const Budget& budget) {
    const Flows basis = place_flow_basis(net, budget);
    if (!basis.complete) {
        return false;
    }
    const std::uint64_t rank = net.place_count() - basis.flows.size();
    return rank + 1 == count_clusters(net) && has_positive_flow(net, true, budget) &&
           has_positive_flow(net, false, budget);
}

StructuralLiveness judge(const PlainNet& net, const Budget& budget) {
    StructuralLiveness out;
    if (net.place_count() == 0) {
        out.live = out.deadlock_free = out.bounded = net.transition_count() > 0;
        out.theorem = "a transition without inputs is always enabled";
        return out;
    }
    const NetClass kind = classify(net);
    if (!kind.ordinary.holds) {
        return out;
    }
    if (kind.marked_graph.holds) {
        out.theorem = "marked graph: live iff every circuit has a token (Commoner et al. 1971)";
        out.unmarked = unmarked_circuit(net);
        out.live = out.deadlock_free = out.unmarked.empty();
        out.not_live = !out.live;
        out.bounded = out.live && kind.strongly_connected.holds;
        return out;
    }
    const bool free_choice = kind.extended_free_choice.holds;
    if (free_choice && kind.strongly_connected.holds && is_well_formed(net, budget)) {
        out.theorem =
            "well-formed free choice net, every siphon marked (rank theorem; Desel, Esparza 1995)";
        PlaceSet empty;
        for (std::uint32_t p = 0; p < net.place_count(); ++p) {
            if (net.initial[p] == 0) {
                empty.push_back(p);
            }
        }
        out.unmarked = greatest_siphon_within(net, empty);
        out.live = out.deadlock_free = out.bounded = out.unmarked.empty();
        out.not_live = !out.live;
        return out;
    }
    const SiphonAnswer answer = commoner(net, budget);
    if (answer.kind == SiphonAnswer::kHolds) {
        out.deadlock_free = true;
        out.live = free_choice;
        out.theorem =
            free_choice
                ? "free choice net, every siphon contains a marked trap (Commoner's theorem)"
                : "every siphon contains a marked trap (Commoner's property)";
    } else if (answer.kind == SiphonAnswer::kFails && free_choice) {
        out.not_live = true;
        out.unmarked = answer.siphon;
        out.theorem = "free choice net, a siphon contains no marked trap (Commoner's theorem)";
    }
    return out;
}

}  // namespace

StructuralLiveness structural_liveness(const PlainNet& net, const Budget& budget) {
    StructuralLiveness out;
    if (net.has_inhibitors()) {
        const auto same = without_inhibitors(net, budget);
        if (same) {
            out = structural_liveness(*same, budget);
            std::erase_if(out.unmarked, [&](std::uint32_t p) { return p >= net.place_count(); });
        }
        return out;
    }
    if (net.has_levels || net.transition_count() == 0 ||
        std::find(net.optional.begin(), net.optional.end(), 1) != net.optional.end()) {
        return out;
    }
    const Components parts = components(net);
    out.live = out.bounded = true;
    for (std::uint32_t c = 0; c < parts.count; ++c) {
        const SubNet part = component(net, parts, c);
        if (part.transitions.empty()) {
            continue;  // tokens that nobody moves
        }
        const StructuralLiveness one = judge(part.net, budget);
        out.live = out.live && one.live;
        out.bounded = out.bounded && one.bounded;
        if (one.deadlock_free && !out.deadlock_free) {
            out.deadlock_free = true;
            out.theorem = one.theorem;
        }
        if (one.not_live && !out.not_live) {
            out.not_live = true;
            out.theorem = one.theorem;
            for (const std::uint32_t p : one.unmarked) {
                out.unmarked.push_back(part.places[p]);
            }
        }
    }
    out.bounded = out.bounded && out.live;
    return out;
}

}  // namespace puppetri::proof
