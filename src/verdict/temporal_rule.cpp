// SPDX-License-Identifier: MIT
#include "temporal_rule.h"

#include <algorithm>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "linear_rule.h"
#include "moments.h"
#include "puppetri/proof/ctl.h"
#include "puppetri/proof/ltl.h"

namespace puppetri::verdict {
namespace {

using Kind = Finding::Kind;
using proof::Temporal;

void take(Finding& f, const std::optional<proof::Lasso>& lasso, const Moments& moments) {
    if (!lasso) {
        return;
    }
    const auto append = [&](const proof::Path& path) {
        for (const std::uint32_t e : path) {
            if (moments.origin[e] != Moments::kStands) {
                f.path.push_back(moments.origin[e]);
            }
        }
    };
    f.shown = true;
    append(lasso->stem);
    const auto stem = static_cast<std::uint32_t>(f.path.size());
    append(lasso->loop);
    if (f.path.size() > stem) {
        f.loop_from = stem;
    }
}

// Under how many negations path quantifiers stand: an even number only, or an odd one only.
struct Polarity {
    bool even = false, odd = false;
};
Polarity polarity_of(const Temporal& formula) {
    using Op = Temporal::Op;
    std::vector<Polarity> of(formula.nodes.size());
    of.back().even = true;
    Polarity out;
    for (std::size_t i = formula.nodes.size(); i-- > 0;) {
        const Temporal::Node& n = formula.nodes[i];
        const auto hand_down = [&](std::uint32_t to, bool flips) {
            of[to].even = of[to].even || (flips ? of[i].odd : of[i].even);
            of[to].odd = of[to].odd || (flips ? of[i].even : of[i].odd);
        };
        switch (n.op) {
            case Op::kFalse:
            case Op::kTrue:
            case Op::kAtom:
                break;
            case Op::kNot:
                hand_down(n.a, true);
                break;
            case Op::kAnd:
            case Op::kOr:
                hand_down(n.a, false);
                hand_down(n.b, false);
                break;
            default:
                out.even = out.even || of[i].even;
                out.odd = out.odd || of[i].odd;
                hand_down(n.a, false);
                if (n.op == Op::kSomeUntil) {
                    hand_down(n.b, false);
                }
        }
    }
    return out;
}

// A run that gets to one state of a set decides the formula: EF x is true where x must hold, AG x
// false where it cannot. Looks through what negations, `and` and `or` at its root leave of that.
// Gives  whether there is such a set: f.certain, by the states of the graph, and f.proves.
bool by_one_state(const Temporal& formula, proof::CtlChecker& checker,
                  std::span<const std::uint32_t> atoms, const proof::Budget& budget, Finding& f) {
    using Op = Temporal::Op;
    struct Part {
        std::uint32_t node;
        bool value;   // of this part
        bool proves;  // the root's value then
    };
    const auto root = static_cast<std::uint32_t>(formula.nodes.size()) - 1;
    std::vector<Part> open = {{root, true, true}, {root, false, false}};
    for (std::size_t i = 0; i < open.size(); ++i) {
        const Part part = open[i];
        const Temporal::Node& n = formula.nodes[part.node];
        if (n.op == Op::kNot) {
            open.push_back({n.a, !part.value, part.proves});
        } else if (n.op == Op::kAnd || n.op == Op::kOr) {
            if ((n.op == Op::kOr) == part.value) {  // one operand is enough
                open.push_back({n.a, part.value, part.proves});
                open.push_back({n.b, part.value, part.proves});
            }
        } else if (n.op == Op::kSomeUntil && part.value && formula.nodes[n.a].op == Op::kTrue) {
            Temporal inner = formula;
            inner.nodes.resize(n.b + 1);
            const auto labels = checker.label(inner, atoms, budget);
            if (!labels || labels->must.empty()) {
                continue;
            }
            f.certain.assign(labels->must.size(), 0);
            labels->must.for_each([&](std::uint32_t s) { f.certain[s] = 1; });
            f.proves = part.proves;
            return true;
        }
    }
    return false;
}

std::vector<std::uint32_t> numbers(std::size_t count) {
    std::vector<std::uint32_t> out(count);
    for (std::uint32_t i = 0; i < count; ++i) {
        out[i] = i;
    }
    return out;
}

}  // namespace

Finding check_temporal(const net::Net& net, const Obligation& o, const GraphView& view,
                       const proof::Budget& budget) {
    Finding f;
    if (o.temporal->logic == Temporal::Logic::kNeither) {
        f.reason = "it mixes branching and linear time";
        return f;
    }
    const proof::Graph& states = view.timed->graph;
    // Graphs of many behaviours at once may part a step in two, or join two.
    if (o.temporal->has_next && !(view.concrete && states.exact)) {
        f.reason = "a formula with `next` asks for single steps, which only exact states have";
        return f;
    }
    // Single steps of branching time: standing in the last state is one, too.
    const bool steps = o.temporal->has_next && o.temporal->logic == proof::Temporal::Logic::kCtl;
    Moments moments = moments_of(*view.timed, o, steps);
    const proof::Graph& graph = moments.graph;
    const std::vector<std::uint32_t> atoms = numbers(o.operands.size());
    constexpr std::uint64_t kMostEdges = 40'000'000;
    const std::string not_all =
        view.timed->not_over.empty()
            ? "the method does not see every run"
            : "the method does not see every run: " + view.timed->not_over.front();
    if (o.temporal->logic == Temporal::Logic::kLtl && !graph.exact) {
        return check_linear(net, o, view, budget, kMostEdges);
    }
    if (o.temporal->logic == Temporal::Logic::kLtl) {
        const proof::LtlAnswer answer = proof::check_ltl(graph, *o.temporal, atoms, budget);
        if (answer.holds == proof::Truth::kTrue && graph.over) {
            f.kind = Kind::kHolds;
            f.force = Force::kEveryChoice;
        } else if (answer.holds == proof::Truth::kFalse && graph.exact) {
            f.kind = Kind::kRefuted;
            f.reason = "a run does not satisfy the formula";
            take(f, answer.counterexample, moments);
        } else {
            f.reason = answer.ended != proof::Ended::kDone
                           ? std::string("not all was looked at: ") + proof::name_of(answer.ended)
                       : answer.holds == proof::Truth::kTrue
                           ? not_all
                           : "a path does not satisfy the formula, but it may be no run";
        }
        return f;
    }
    // A class of states has several futures: its paths only bound what each of them can do.
    moments.graph.exact = graph.exact && view.concrete;
    proof::CtlChecker checker(graph, &moments.waits);
    const proof::Truth truth = checker.holds(*o.temporal, atoms, budget);
    // Where runs are missing, what some run does is still shown by a run that is there.
    const Polarity polarity = polarity_of(*o.temporal);
    if (truth == proof::Truth::kTrue && (graph.over || (graph.exact && !polarity.odd))) {
        f.kind = Kind::kHolds;
    } else if (truth != proof::Truth::kTrue && graph.over && !graph.exact &&
               by_one_state(*o.temporal, checker, atoms, budget, f) &&
               !(truth == proof::Truth::kFalse && f.proves)) {
        auto kept = std::make_shared<LinearGame>();
        kept->moments = std::move(moments);
        f.kind = Kind::kSuspect;
        f.target = Finding::Target::kHopeless;
        f.product = make_product(kept->moments.graph, nullptr, kMostEdges);
        f.targets.resize(f.product.size());
        for (std::uint32_t n = 0; n < f.product.size(); ++n) {
            f.targets[n] = f.certain[f.product.state[n]];
        }
        f.certain = f.targets;
        f.game = std::move(kept);
        f.sure = truth == proof::Truth::kFalse;
        f.reason = f.proves ? "a run may get there" : "a run gets to where it fails";
    } else if (truth == proof::Truth::kFalse && (graph.over || (graph.exact && !polarity.even))) {
        f.kind = Kind::kRefuted;
        f.reason = "the formula does not hold at the start";
        take(f,
             o.temporal->logic == Temporal::Logic::kState ? std::optional(proof::Lasso{})
             : graph.exact ? checker.evidence(*o.temporal, atoms, budget)
                           : std::nullopt,
             moments);
    } else {
        f.reason = truth == proof::Truth::kUnknown || graph.over
                       ? "this method sees neither that it holds nor that it does not"
                       : not_all;
    }
    return f;
}

}  // namespace puppetri::verdict
