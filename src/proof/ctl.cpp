// SPDX-License-Identifier: MIT
// CTL by labelling, operator by operator, from the inside out.
#include "puppetri/proof/ctl.h"

#include <algorithm>
#include <utility>

#include "puppetri/base/require.h"

namespace puppetri::proof {

namespace {

using Op = Temporal::Op;

// After which node each node's labels are not needed any more.
std::vector<std::uint32_t> last_uses(const Temporal& formula) {
    const auto size = static_cast<std::uint32_t>(formula.nodes.size());
    std::vector<std::uint32_t> last(size, size);
    for (std::uint32_t i = 0; i < size; ++i) {
        const Temporal::Node& n = formula.nodes[i];
        if (n.op == Op::kFalse || n.op == Op::kTrue || n.op == Op::kAtom) {
            continue;
        }
        last[n.a] = i;
        if (n.op == Op::kAnd || n.op == Op::kOr || n.op == Op::kSomeUntil) {
            last[n.b] = i;
        }
    }
    return last;
}

}  // namespace

CtlChecker::CtlChecker(const Graph& graph, const Waits* waits) : graph_(graph) {
    const auto rare = [&](const Edge& e) { return waits->is_rare(e); };
    if (waits != nullptr && (waits->kinds != 0 || std::any_of(graph.edges.items.begin(),
                                                              graph.edges.items.end(), rare))) {
        waits_ = waits;
    }
}

const net::Rows<std::uint32_t>& CtlChecker::backwards() {
    if (given_ != nullptr) {
        return *given_;
    }
    if (predecessors_.size() != graph_.size()) {
        predecessors_ = predecessors(graph_);
    }
    return predecessors_;
}

bool CtlChecker::cut(std::uint32_t state) const {
    return !graph_.flags.empty() && (graph_.flags[state] & Graph::kCut) != 0;
}

StateBits CtlChecker::some_next(const StateBits& a) {
    const net::Rows<std::uint32_t>& rows = backwards();
    StateBits result(graph_.size());
    a.for_each([&](std::uint32_t s) {
        for (const std::uint32_t before : rows.row(s)) {
            result.add(before);
        }
    });
    return result;
}

// The greatest set of a-states each of which may end or has a successor in the set: states without
// either are taken away until none is left, each edge being counted down once.
StateBits CtlChecker::some_globally(const StateBits& a, bool past_cuts) {
    const net::Rows<std::uint32_t>& rows = backwards();
    StateBits result = a;
    std::vector<std::uint32_t> ways(graph_.size(), 0), gone;
    a.for_each([&](std::uint32_t s) {
        if (may_end(graph_, s) || (past_cuts && cut(s))) {
            ways[s] = ~0u;  // never counted down to 0: fewer edges than that
            return;
        }
        for (const Edge& e : graph_.edges.row(s)) {
            ways[s] += a[e.target] ? 1 : 0;
        }
        if (ways[s] == 0) {
            gone.push_back(s);
        }
    });
    while (!gone.empty()) {
        const std::uint32_t s = gone.back();
        gone.pop_back();
        result.remove(s);
        for (const std::uint32_t before : rows.row(s)) {
            if (a[before] && --ways[before] == 0) {
                gone.push_back(before);
            }
        }
    }
    return result;
}

// The a-states from which a path stays in a and ends, is cut, or goes round for ever: in a
// component in which no kind of waiting goes on for ever, or without letting time pass.
StateBits CtlChecker::just_globally(const StateBits& a, const StateBits& cuts) {
    StateBits seeds(graph_.size());
    a.for_each([&](std::uint32_t s) {
        if (may_end(graph_, s) || cuts[s]) {
            seeds.add(s);
        }
    });
    const auto add_cycles = [&](const Graph& graph, const Waits* waits) {
        const StrongComponents components = strong_components(graph, &a);
        const StateBits cyclic = cyclic_components(graph, components);
        const std::uint32_t words = waits != nullptr ? (waits->kinds + 63) / 64 : 0;
        // Per component: time may pass somewhere in it; kinds that do not wait somewhere, or are
        // stirred.
        std::vector<bool> passes(components.count, false);
        const unsigned silent = words != 0 ? Graph::kSettled : Graph::kOptional;
        std::vector<std::uint64_t> met(std::size_t{components.count} * words, 0);
        a.for_each([&](std::uint32_t s) {
            const std::uint32_t c = components.of[s];
            passes[c] = passes[c] || (graph.flags[s] & silent) != 0;
            for (std::uint32_t w = 0; w < words; ++w) {
                met[std::size_t{c} * words + w] |= ~waits->waiting[std::size_t{s} * words + w];
            }
            for (std::uint32_t e = graph.edges.starts[s];
                 waits != nullptr && e < graph.edges.starts[s + 1]; ++e) {
                const std::uint32_t to = graph.edges.items[e].target;
                passes[c] =
                    passes[c] || (a[to] && components.of[to] == c && graph.lets_time_pass(e));
                for (std::uint32_t w = 0; a[to] && components.of[to] == c && w < words; ++w) {
                    met[std::size_t{c} * words + w] |= waits->stirred[std::size_t{e} * words + w];
                }
            }
        });
        a.for_each([&](std::uint32_t s) {
            const std::uint32_t c = components.of[s];
            bool just = cyclic[c] && (waits == nullptr || passes[c]);
            for (std::uint32_t kind = 0; waits != nullptr && just && kind < waits->kinds; ++kind) {
                just = ((met[std::size_t{c} * words + kind / 64] >> (kind % 64)) & 1) != 0;
            }
            if (just) {
                seeds.add(s);
            }
        });
    };
    add_cycles(graph_, waits_);
    Graph timeless;  // where no time passes, nothing that waits helps
    timeless.flags = graph_.flags;
    for (std::uint32_t s = 0; s < graph_.size(); ++s) {
        for (const Edge& e : graph_.edges.row(s)) {
            if (e.label != Edge::kPass && !waits_->is_rare(e)) {
                timeless.edges.items.push_back(e);
            }
        }
        timeless.edges.starts.push_back(static_cast<std::uint32_t>(timeless.edges.items.size()));
    }
    add_cycles(timeless, nullptr);
    return leading_to(backwards(), seeds, &a);
}

std::optional<std::vector<CtlChecker::Labels>> CtlChecker::all_labels(
    const Temporal& formula, std::span<const std::uint32_t> atoms, bool keep_all,
    const Budget& budget) {
    Meter meter(budget, "CTL");
    const std::uint32_t size = graph_.size();
    const std::vector<std::uint32_t> last = last_uses(formula);
    const StateBits none(size);
    StateBits cuts(size);
    for (std::uint32_t s = 0; s < size; ++s) {
        if (cut(s)) {
            cuts.add(s);
        }
    }
    const bool any_cut = !cuts.empty();
    // Where must and may are one everywhere, only `must` is kept.
    bool one = graph_.exact && !any_cut;
    std::vector<Labels> labels(formula.nodes.size());
    for (std::size_t i = 0; i < formula.nodes.size() && one; ++i) {
        if (formula.nodes[i].op == Op::kAtom) {
            const std::uint32_t atom = atoms[formula.nodes[i].index];
            for (std::uint32_t s = 0; s < size && one; ++s) {
                one = graph_.atoms.may_hold(s, atom) == graph_.atoms.must_hold(s, atom);
            }
        }
    }
    const auto may = [&](std::uint32_t i) -> const StateBits& {
        return one ? labels[i].must : labels[i].may;
    };
    for (std::uint32_t i = 0; i < formula.nodes.size(); ++i) {
        if (meter.look(size, graph_.edges.items.size(), 0, 0) != Ended::kDone) {
            return std::nullopt;
        }
        const Temporal::Node& n = formula.nodes[i];
        Labels& mine = labels[i];
        switch (n.op) {
            case Op::kFalse:
            case Op::kTrue:
                mine.must = StateBits(size, n.op == Op::kTrue);
                mine.may = one ? StateBits() : mine.must;
                break;
            case Op::kAtom:
                mine.must = states_where_atom_must(graph_, atoms[n.index]);
                mine.may = one ? StateBits() : states_where_atom_may(graph_, atoms[n.index]);
                break;
            case Op::kNot:
                mine.must = may(n.a);
                mine.must.complement();
                if (!one) {
                    mine.may = labels[n.a].must;
                    mine.may.complement();
                }
                break;
            case Op::kAnd:
                mine.must = labels[n.a].must;
                mine.must &= labels[n.b].must;
                if (!one) {
                    mine.may = labels[n.a].may;
                    mine.may &= labels[n.b].may;
                }
                break;
            case Op::kOr:
                mine.must = labels[n.a].must;
                mine.must |= labels[n.b].must;
                if (!one) {
                    mine.may = labels[n.a].may;
                    mine.may |= labels[n.b].may;
                }
                break;
            case Op::kSomeNext:
                mine.must = graph_.exact ? some_next(labels[n.a].must) : none;
                if (!one) {
                    mine.may = some_next(labels[n.a].may);
                    mine.may |= cuts;
                }
                break;
            case Op::kSomeGlobally:
                if (graph_.exact) {
                    mine.must = waits_ != nullptr ? just_globally(labels[n.a].must, none)
                                                  : some_globally(labels[n.a].must, false);
                } else {  // where it may not be left, every run keeps it
                    StateBits goal = labels[n.a].must;
                    goal.complement();
                    goal |= cuts;
                    mine.must = leading_to(backwards(), goal);
                    mine.must.complement();
                }
                if (!one) {
                    mine.may = waits_ != nullptr ? just_globally(labels[n.a].may, cuts)
                                                 : some_globally(labels[n.a].may, true);
                }
                break;
            case Op::kSomeUntil:
                if (graph_.exact) {
                    mine.must = leading_to(backwards(), labels[n.b].must, &labels[n.a].must);
                } else {  // where it cannot be avoided, some run does it
                    StateBits open = labels[n.b].must;
                    open.complement();
                    StateBits broken = labels[n.a].must;
                    broken.complement();
                    broken |= cuts;
                    broken &= open;
                    mine.must = leading_to(backwards(), broken, &open);
                    mine.must |=
                        waits_ != nullptr ? just_globally(open, cuts) : some_globally(open, true);
                    mine.must.complement();
                }
                if (!one) {
                    StateBits goal = cuts;
                    goal &= labels[n.a].may;
                    goal |= labels[n.b].may;
                    mine.may = leading_to(backwards(), goal, &labels[n.a].may);
                }
                break;
            case Op::kNext:
            case Op::kUntil:
            case Op::kRelease:
                PUP_REQUIRE(n.op == Op::kSomeNext);  // branching time only
        }
        if (!keep_all) {
            const auto forget = [&](std::uint32_t operand) {
                if (last[operand] == i && operand != i) {
                    labels[operand] = {};
                }
            };
            forget(n.a);
            forget(n.b);
        }
    }
    if (one) {
        for (Labels& l : labels) {
            if (l.must.size() == size && size > 0) {
                l.may = l.must;
            }
        }
    }
    return labels;
}

std::optional<CtlChecker::Labels> CtlChecker::label(const Temporal& formula,
                                                    std::span<const std::uint32_t> atoms,
                                                    const Budget& budget) {
    std::optional<std::vector<Labels>> labels = all_labels(formula, atoms, false, budget);
    return labels.has_value() ? std::optional(std::move(labels->back())) : std::nullopt;
}

Truth CtlChecker::holds(const Temporal& formula, std::span<const std::uint32_t> atoms,
                        const Budget& budget) {
    const std::optional<Labels> labels = label(formula, atoms, budget);
    if (!labels.has_value() || graph_.size() == 0) {
        return Truth::kUnknown;
    }
    return labels->must[graph_.initial]   ? Truth::kTrue
           : !labels->may[graph_.initial] ? Truth::kFalse
                                          : Truth::kUnknown;
}

std::optional<Lasso> CtlChecker::evidence(const Temporal& formula,
                                          std::span<const std::uint32_t> atoms,
                                          const Budget& budget) {
    const std::optional<std::vector<Labels>> labels = all_labels(formula, atoms, true, budget);
    if (!labels.has_value() || graph_.size() == 0) {
        return std::nullopt;
    }
    const auto certain = [&](std::uint32_t node, std::uint32_t s, bool value) {
        return value ? (*labels)[node].must[s] : !(*labels)[node].may[s];
    };
    const auto is_state_formula = [&](std::uint32_t node) {
        const Op op = formula.nodes[node].op;
        return op == Op::kAtom || op == Op::kTrue || op == Op::kFalse ||
               (op == Op::kNot && formula.nodes[formula.nodes[node].a].op == Op::kAtom);
    };
    Lasso lasso;
    bool shown = false;
    auto node = static_cast<std::uint32_t>(formula.nodes.size()) - 1;
    std::uint32_t s = graph_.initial;
    bool value = true;
    if (!certain(node, s, true)) {
        value = false;
        if (!certain(node, s, false)) {
            return std::nullopt;
        }
    }
    for (;;) {
        const Temporal::Node& n = formula.nodes[node];
        if (n.op == Op::kNot) {
            node = n.a;
            value = !value;
        } else if (n.op == Op::kAnd || n.op == Op::kOr) {
            // One operand is enough for `or` to hold and for `and` to fail; else a temporal one.
            const bool one_is_enough = (n.op == Op::kOr) == value;
            if (one_is_enough) {
                node = certain(n.a, s, value) && (!certain(n.b, s, value) || is_state_formula(n.a))
                           ? n.a
                           : n.b;
            } else {
                node = is_state_formula(n.a) ? n.b : n.a;
            }
        } else if (n.op == Op::kSomeNext && value) {
            const StateBits& goal = (*labels)[n.a].must;
            std::uint32_t edge = graph_.edges.starts[s];
            while (!goal[graph_.edges.items[edge].target]) {
                ++edge;
            }
            lasso.stem.push_back(edge);
            s = graph_.edges.items[edge].target;
            node = n.a;
            shown = true;
        } else if (n.op == Op::kSomeUntil && value) {
            const std::optional<Path> path =
                shortest_path(graph_, s, (*labels)[n.b].must, &(*labels)[n.a].must);
            if (!path.has_value()) {
                break;
            }
            lasso.stem.insert(lasso.stem.end(), path->begin(), path->end());
            s = path->empty() ? s : graph_.edges.items[path->back()].target;
            node = n.b;
            shown = true;
        } else if (n.op == Op::kSomeGlobally && value) {
            const std::optional<Lasso> rest = lasso_within(graph_, s, (*labels)[n.a].must);
            if (rest.has_value()) {
                lasso.stem.insert(lasso.stem.end(), rest->stem.begin(), rest->stem.end());
                lasso.loop = rest->loop;
                shown = true;
            }
            break;
        } else {
            break;
        }
    }
    return shown ? std::optional(std::move(lasso)) : std::nullopt;
}

}  // namespace puppetri::proof
