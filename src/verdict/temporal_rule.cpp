// SPDX-License-Identifier: MIT
#include "temporal_rule.h"

#include <utility>

#include "puppetri/proof/ctl.h"
#include "puppetri/proof/ltl.h"

namespace puppetri::verdict {
namespace {

using Kind = Finding::Kind;

// Statements about figures hold at most where one atom does, and for certain where another does:
// they get the bits of both.
proof::Graph with_bounds(const proof::Graph& graph, const Obligation& o) {
    proof::Graph out = graph;
    const std::uint64_t words = (graph.atoms.atoms + 63) / 64;
    for (std::size_t i = 0; i < o.may_atoms.size(); ++i) {
        const std::uint32_t may = o.may_atoms[i], must = o.must_atoms[i];
        for (std::uint32_t s = 0; may != must && s < graph.size(); ++s) {
            const std::uint64_t bit = std::uint64_t{1} << (may % 64);
            std::uint64_t& word = out.atoms.must[s * words + may / 64];
            word = graph.atoms.must_hold(s, must) ? word | bit : word & ~bit;
        }
    }
    return out;
}

void take(Finding& f, const std::optional<proof::Lasso>& lasso) {
    if (!lasso) {
        return;
    }
    f.path = lasso->stem;
    if (!lasso->loop.empty()) {
        f.loop_from = static_cast<std::uint32_t>(f.path.size());
        f.path.insert(f.path.end(), lasso->loop.begin(), lasso->loop.end());
    }
}

}  // namespace

Finding check_temporal(const net::Net&, const Obligation& o, const GraphView& view,
                       const proof::Budget& budget) {
    Finding f;
    if (o.speaks_of_steps) {
        f.reason = "temporal formulas about firings and occurrences have no method";
        return f;
    }
    if (o.temporal->logic == proof::Temporal::Logic::kNeither) {
        f.reason = "it mixes branching and linear time";
        return f;
    }
    proof::Graph own;
    const proof::Graph* graph = &view.timed->graph;
    // Graphs of many behaviours at once may part a step in two, or join two.
    if (o.temporal->has_next && !(view.concrete && graph->exact)) {
        f.reason = "a formula with `next` asks for single steps, which only exact states have";
        return f;
    }
    if (o.may_atoms != o.must_atoms) {
        own = with_bounds(*graph, o);
        graph = &own;
    }
    if (o.temporal->logic == proof::Temporal::Logic::kLtl) {
        const proof::LtlAnswer answer = proof::check_ltl(*graph, *o.temporal, o.may_atoms, budget);
        if (answer.holds == proof::Truth::kTrue) {
            f.kind = Kind::kHolds;
            f.force = Force::kEveryChoice;
        } else if (answer.holds == proof::Truth::kFalse && graph->exact) {
            f.kind = Kind::kRefuted;
            f.reason = "a run does not satisfy the formula";
            take(f, answer.counterexample);
        } else {
            f.reason = answer.ended != proof::Ended::kDone
                           ? std::string("not all was looked at: ") + proof::name_of(answer.ended)
                           : "a path does not satisfy the formula, but it may be no run";
        }
        return f;
    }
    // A class of states has several futures: branching time needs single states, or paths that only
    // bound what can be.
    if (!view.concrete && graph->exact) {
        f.reason = "nothing that branches may be concluded from classes of states";
        return f;
    }
    proof::CtlChecker checker(*graph);
    const proof::Truth truth = checker.holds(*o.temporal, o.may_atoms, budget);
    if (truth == proof::Truth::kTrue) {
        f.kind = Kind::kHolds;
    } else if (truth == proof::Truth::kFalse && view.concrete && graph->exact) {
        f.kind = Kind::kRefuted;
        f.reason = "the formula does not hold at the start";
        take(f, checker.evidence(*o.temporal, o.may_atoms, budget));
    } else {
        f.reason = "this method sees neither that it holds nor that it does not";
    }
    return f;
}

}  // namespace puppetri::verdict
