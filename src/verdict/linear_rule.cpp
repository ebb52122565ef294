// SPDX-License-Identifier: MIT
#include "linear_rule.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "puppetri/net/draft.h"
#include "puppetri/proof/graph_algorithms.h"

namespace puppetri::verdict {
namespace {

using proof::Buechi;
using proof::Edge;
using proof::Graph;

struct Letter {
    std::uint64_t holds = 0, fails = 0;
    bool opens(const Buechi::Edge& e) const {
        return (e.positive & ~holds) == 0 && (e.negative & ~fails) == 0;
    }
};

// What may be, or what is for certain.
Letter letter_of(const Graph& graph, std::uint32_t state, bool certain) {
    Letter l;
    for (std::uint32_t i = 0; i < graph.atoms.atoms; ++i) {
        const bool may = graph.atoms.may_hold(state, i), must = graph.atoms.must_hold(state, i);
        l.holds |= std::uint64_t{(certain ? must : may) ? 1u : 0u} << i;
        l.fails |= std::uint64_t{(certain ? !may : !must) ? 1u : 0u} << i;
    }
    return l;
}

// The product: for each node and each edge of the automaton that may be open there, a block of all
// edges of its moment.
struct Blocks {
    Product p;
    std::vector<std::uint32_t> first;  // block of each node, and one more
    std::vector<std::uint64_t> accepts;
    std::vector<std::uint8_t> certain;
};

bool make_blocks(LinearGame& game, const proof::Budget& budget, std::uint64_t most_edges,
                 Blocks& out) {
    const Graph& graph = game.moments.graph;
    Product& p = out.p;
    p.graph = &graph;
    p.complete = graph.ended == proof::Ended::kDone;
    const auto node_of = [&](std::uint32_t moment, std::uint32_t q) {
        const auto [at, fresh] = game.node_of.try_emplace(LinearGame::key(moment, q), p.size());
        if (fresh) {
            p.state.push_back(moment);
            p.monitor.push_back(q);
        }
        return at->second;
    };
    for (const std::uint32_t q : game.automaton.initial) {
        p.first.push_back(node_of(graph.initial, q));
    }
    proof::Meter meter(budget, "LTL");
    for (std::uint32_t n = 0; n < p.size(); ++n) {
        if ((n & 0xFFF) == 0 &&
            meter.look(p.size(), p.targets.size(), p.size() - n, 0) != proof::Ended::kDone) {
            return false;
        }
        p.starts.push_back(p.targets.size());
        out.first.push_back(static_cast<std::uint32_t>(out.accepts.size()));
        const std::uint32_t s = p.state[n], q = p.monitor[n];
        if (p.targets.size() > most_edges) {
            return false;
        }
        p.complete = p.complete && !p.cut(n);
        const Letter may = letter_of(graph, s, false), must = letter_of(graph, s, true);
        for (const Buechi::Edge& a : game.automaton.edges.row(q)) {
            if (!may.opens(a)) {
                continue;
            }
            out.accepts.push_back(a.accepts);
            out.certain.push_back(must.opens(a) ? 1 : 0);
            for (std::uint32_t e = graph.edges.starts[s]; e < graph.edges.starts[s + 1]; ++e) {
                p.targets.push_back(node_of(graph.edges.items[e].target, a.target));
                p.edge.push_back(e);
            }
        }
    }
    p.starts.push_back(p.targets.size());
    out.first.push_back(static_cast<std::uint32_t>(out.accepts.size()));
    return true;
}

// Calls visit(block, first edge of the product) for each block of a node.
template <class Visit>
void for_blocks(const Blocks& b, std::uint32_t n, Visit&& visit) {
    const Graph& graph = *b.p.graph;
    const std::uint32_t s = b.p.state[n];
    const std::uint64_t width = graph.edges.starts[s + 1] - graph.edges.starts[s];
    for (std::uint32_t k = b.first[n]; k < b.first[n + 1]; ++k) {
        visit(k, b.p.starts[n] + (k - b.first[n]) * width);
    }
}

// Some path that justice allows is accepted: a component with all acceptance sets in which time
// passes and nothing waits for ever, or without time and events that come ever again.
bool accepted(const Blocks& b, const proof::Waits& waits, std::uint64_t all) {
    const Product& p = b.p;
    const Graph& graph = *p.graph;
    for (const bool timeless : {true, false}) {
        Graph g;
        std::vector<std::uint64_t> marks, from;
        g.flags.resize(p.size());
        for (std::uint32_t n = 0; n < p.size(); ++n) {
            const std::uint32_t s = p.state[n];
            const std::uint32_t width = graph.edges.starts[s + 1] - graph.edges.starts[s];
            for_blocks(b, n, [&](std::uint32_t k, std::uint64_t e) {
                for (const std::uint64_t end = e + width; e < end; ++e) {
                    const Edge& edge = graph.edges.items[p.edge[e]];
                    if (timeless && (edge.label == Edge::kPass || waits.is_rare(edge))) {
                        continue;
                    }
                    g.edges.items.push_back({edge.label, p.targets[e]});
                    marks.push_back(b.accepts[k]);
                    from.push_back(p.edge[e]);
                }
            });
            g.edges.starts.push_back(static_cast<std::uint32_t>(g.edges.items.size()));
        }
        const proof::StrongComponents components = proof::strong_components(g);
        const std::uint32_t words = timeless ? 0 : (waits.kinds + 63) / 64;
        const unsigned silent = words != 0 ? Graph::kSettled : Graph::kOptional;
        struct Sum {
            std::uint64_t marks = 0;
            bool cyclic = false, passes = false;
        };
        std::vector<Sum> sums(components.count);
        std::vector<std::uint64_t> met(std::size_t{components.count} * words, 0);
        for (std::uint32_t n = 0; n < p.size(); ++n) {
            const std::uint32_t c = components.of[n], s = p.state[n];
            sums[c].passes = sums[c].passes || (graph.flags[s] & silent) != 0;
            for (std::uint32_t w = 0; w < words; ++w) {
                met[std::size_t{c} * words + w] |= ~waits.waiting[std::size_t{s} * words + w];
            }
            for (std::uint32_t e = g.edges.starts[n]; e < g.edges.starts[n + 1]; ++e) {
                if (components.of[g.edges.items[e].target] != c) {
                    continue;
                }
                sums[c].cyclic = true;
                sums[c].marks |= marks[e];
                sums[c].passes =
                    sums[c].passes || graph.lets_time_pass(static_cast<std::uint32_t>(from[e]));
                for (std::uint32_t w = 0; w < words; ++w) {
                    met[std::size_t{c} * words + w] |=
                        waits.stirred[std::size_t{from[e]} * words + w];
                }
            }
        }
        for (std::uint32_t c = 0; c < components.count; ++c) {
            bool just =
                sums[c].cyclic && (sums[c].marks & all) == all && (timeless || sums[c].passes);
            for (std::uint32_t kind = 0; words != 0 && just && kind < waits.kinds; ++kind) {
                just = ((met[std::size_t{c} * words + kind / 64] >> (kind % 64)) & 1) != 0;
            }
            if (just) {
                return true;
            }
        }
    }
    return false;
}

// The game. At a moment where transitions compete the first player says who wins; events that only
// the outside makes occur stay away; every other edge is the second player's, who need not go any
// unless time has to pass.
class Game {
 public:
    Game(const Blocks& b, const LinearGame& game, const proof::Waits& waits)
        : b_(b), graph_(*b.p.graph) {
        const std::uint32_t size = graph_.size();
        turns_.resize(size);
        for (std::uint32_t s = 0; s < size; ++s) {
            Turn& turn = turns_[s];
            for (std::uint32_t e = graph_.edges.starts[s]; e < graph_.edges.starts[s + 1]; ++e) {
                const Edge& edge = graph_.edges.items[e];
                const bool fires = (edge.label & Edge::kEvent) == 0;
                const bool stands = game.moments.origin[e] == Moments::kStands;
                turn.fires = turn.fires || fires;
                turn.stands = turn.stands || stands;
                turn.passes = turn.passes || (edge.label == Edge::kPass && !stands);
                turn.happens = turn.happens ||
                               (edge.label != Edge::kPass && !fires && !waits.is_by_outside(edge));
            }
            kind_.reserve(graph_.edges.items.size());
            for (std::uint32_t e = graph_.edges.starts[s]; e < graph_.edges.starts[s + 1]; ++e) {
                const Edge& edge = graph_.edges.items[e];
                const bool fires = (edge.label & Edge::kEvent) == 0;
                kind_.push_back(game.moments.origin[e] == Moments::kStands ? kMine
                                : fires                     ? (turn.passes ? kTheirs : kMine)
                                : waits.is_by_outside(edge) ? kLeftOut
                                                            : kTheirs);
            }
        }
    }

    std::vector<std::vector<std::uint32_t>> take_ranks() { return std::move(ranks_); }
    // Nothing: too much work.
    std::optional<Nodes> winning(std::uint32_t sets) {
        const Product& p = b_.p;
        ranks_.resize(std::max(sets, 1u));
        Nodes all(p.size(), 0);
        for (std::uint32_t n = 0; n < p.size(); ++n) {
            all[n] = p.cut(n) ? 0 : 1;
        }
        for (bool changed = true; changed;) {
            changed = false;
            for (std::uint32_t set = 0; set < std::max(sets, 1u); ++set) {
                // From here the set is met once more, inside `all`.
                Nodes near(p.size(), 0);
                ranks_[set].assign(p.size(), kFar);
                std::uint32_t round = 0;
                for (bool grows = true; grows;) {
                    grows = false;
                    for (std::uint32_t n = p.size(); n-- > 0;) {
                        if (all[n] == 0 || near[n] != 0) {
                            continue;
                        }
                        work_ += p.starts[n + 1] - p.starts[n] + 1;
                        if (forces(n, [&](std::uint32_t block, std::uint64_t e) {
                                const bool met = sets == 0 || ((b_.accepts[block] >> set) & 1) != 0;
                                return met ? all[p.targets[e]] != 0 : near[p.targets[e]] != 0;
                            })) {
                            near[n] = 1;
                            ranks_[set][n] = round++;
                            grows = true;
                        }
                    }
                    if (work_ > 400'000'000) {
                        return std::nullopt;
                    }
                }
                changed = changed || near != all;
                all = std::move(near);
            }
        }
        return all;
    }

 private:
    enum Kind : std::uint8_t { kMine, kTheirs, kLeftOut };
    struct Turn {
        bool fires = false, passes = false, happens = false, stands = false;
    };

    template <class Good>
    bool forces(std::uint32_t n, Good&& good) const {
        const std::uint32_t s = b_.p.state[n];
        const std::uint32_t first = graph_.edges.starts[s], end = graph_.edges.starts[s + 1];
        bool found = false;
        for_blocks(b_, n, [&](std::uint32_t block, std::uint64_t at) {
            if (found || b_.certain[block] == 0) {
                return;
            }
            bool theirs = true, some_theirs = false, mine = false, some_mine = false;
            for (std::uint32_t e = first; e < end && theirs;) {
                if (kind_[e] == kLeftOut) {
                    ++e;
                    continue;
                }
                if (kind_[e] == kTheirs) {
                    some_theirs = true;
                    theirs = good(block, at + (e - first));
                    ++e;
                    continue;
                }
                // Of one label: the second player says which.
                some_mine = true;
                bool group = true;
                const std::uint32_t label = graph_.edges.items[e].label;
                for (; e < end && kind_[e] == kMine && graph_.edges.items[e].label == label; ++e) {
                    group = group && good(block, at + (e - first));
                }
                mine = mine || group;
            }
            // Where tokens wait time passes; elsewhere the second player may do nothing at all.
            const bool has_to = turns_[s].passes && !turns_[s].stands;
            found = theirs && (some_mine ? mine || (has_to && some_theirs) : some_theirs);
        });
        return found;
    }

    const Blocks& b_;
    const Graph& graph_;
    std::vector<Turn> turns_;
    std::vector<std::vector<std::uint32_t>> ranks_;
    std::vector<std::uint8_t> kind_;  // per edge of the moments
    std::uint64_t work_ = 0;
};

// A run can be watched: what the formula reads changes at firings only.
bool can_be_watched(const net::Net& net, const proof::Temporal& formula) {
    for (const net::Formula& atom : formula.atoms) {
        for (const net::Formula::Node& n : atom.nodes) {
            if (n.op == net::FormulaOp::kReady || n.op == net::FormulaOp::kFireable) {
                return false;
            }
        }
        for (const Expr& e : atom.expressions) {
            for (const Expr::Node& n : e.nodes()) {
                if (n.op == ExprOp::kSlot &&
                    n.slot.kind == static_cast<std::uint32_t>(net::SlotKind::kReady)) {
                    return false;
                }
            }
        }
    }
    const auto& data = net.declarations().data;
    const auto& events = net.declarations().events;
    return std::none_of(data.begin(), data.end(), [](const auto& d) { return d.sensor; }) &&
           std::none_of(events.begin(), events.end(), [](const auto& e) { return e.sets.valid(); });
}

}  // namespace

Finding check_linear(const net::Net& net, const Obligation& o, const GraphView& view,
                     const proof::Budget& budget, std::uint64_t most_edges) {
    Finding f;
    auto game = std::make_shared<LinearGame>();
    std::optional<Buechi> automaton = proof::automaton_of(*o.temporal, true);
    if (!automaton) {
        f.reason = "the formula is too large";
        return f;
    }
    game->automaton = std::move(*automaton);
    game->moments = moments_of(*view.timed, o, true);
    const Graph& graph = game->moments.graph;
    Blocks blocks;
    if (graph.size() == 0 || !make_blocks(*game, budget, most_edges, blocks)) {
        f.reason = "not all was looked at";
        return f;
    }
    const proof::Waits& waits = game->moments.waits;
    if (!accepted(blocks, waits, game->automaton.all_sets())) {
        if (graph.over && blocks.p.complete) {
            f.kind = Finding::Kind::kHolds;
            f.force = Force::kEveryChoice;
        } else {
            f.reason = "not all states were looked at";
        }
        return f;
    }
    f.reason = "a path does not satisfy the formula, but it may be no run";
    if (!graph.over || o.temporal->has_next || !can_be_watched(net, *o.temporal)) {
        return f;
    }
    Game play(blocks, *game, waits);
    std::optional<Nodes> winning = play.winning(game->automaton.acceptance_sets);
    if (!winning || std::find(winning->begin(), winning->end(), 1) == winning->end()) {
        return f;
    }
    game->winning = *winning;
    game->ranks = play.take_ranks();
    f.kind = Finding::Kind::kSuspect;
    f.target = Finding::Target::kLinear;
    f.reason = "it can go on so that the formula fails, whatever takes how long";
    f.targets = std::move(*winning);
    f.product = std::move(blocks.p);
    f.game = std::move(game);
    return f;
}

LinearWatch::LinearWatch(const LinearGame& game, const Obligation& obligation,
                         const AtomReader& reader, const run::Player& player)
    : game_(game), o_(obligation), reader_(reader), player_(player) {
    for (const Operand& operand : o_.operands) {
        for (const Operand::Node& n : operand.nodes) {
            asks_for_events_ = asks_for_events_ || n.op == Operand::Node::Op::kEvent;
        }
    }
}

void LinearWatch::begin() {
    cases_ = {game_.automaton.initial};
    std::sort(cases_[0].begin(), cases_[0].end());
    read(Operand::kNoFiring);
}

void LinearWatch::occurred(std::span<const std::uint32_t> events) {
    for (const std::uint32_t e : events) {
        advance();
        judge(Edge::kEvent | e);
        at_event_ = asks_for_events_;
    }
}

void LinearWatch::time_passes() {
    advance();
    judge(Operand::kNoFiring);
}

void LinearWatch::fired() {
    advance();
    read(player_.last().value);
}

std::vector<std::uint32_t> LinearWatch::after(const std::vector<std::uint32_t>& states) const {
    std::vector<std::uint32_t> next;
    const Letter letter{holds_, fails_};
    for (const std::uint32_t q : states) {
        for (const Buechi::Edge& e : game_.automaton.edges.row(q)) {
            if (letter.opens(e) && std::find(next.begin(), next.end(), e.target) == next.end()) {
                next.push_back(e.target);
            }
        }
    }
    std::sort(next.begin(), next.end());
    return next;
}

bool LinearWatch::breaks(std::size_t back) const {
    const std::uint64_t all =
        o_.operands.size() == 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << o_.operands.size()) - 1;
    for (const bool passes : {false, true}) {
        std::vector<std::uint64_t> stem, loop;
        for (std::size_t i = 0; i < word_.size(); ++i) {
            if (!word_[i].clear) {
                return false;
            }
            if (!word_[i].perhaps || passes) {
                (i < back ? stem : loop).push_back(word_[i].holds);
            }
        }
        // The present moment ends the round, or stands.
        if ((holds_ | fails_) != all) {
            return false;
        }
        loop.push_back(holds_);
        if (!proof::accepts(game_.automaton, stem, loop)) {
            return false;
        }
    }
    return true;
}

void LinearWatch::advance() {
    constexpr std::size_t kMostCases = 16;
    const std::uint64_t all =
        o_.operands.size() == 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << o_.operands.size()) - 1;
    word_.push_back({holds_, (holds_ | fails_) == all, false});
    for (std::vector<std::uint32_t>& states : cases_) {
        states = after(states);
    }
    if (!std::exchange(at_event_, false)) {
        return;
    }
    judge(Operand::kNoFiring);
    word_.push_back({holds_, (holds_ | fails_) == all, true});
    const std::size_t count = cases_.size();
    for (std::size_t i = 0; i < count; ++i) {
        std::vector<std::uint32_t> later = after(cases_[i]);
        if (std::find(cases_.begin(), cases_.end(), later) == cases_.end()) {
            cases_.push_back(std::move(later));
        }
    }
    if (cases_.size() > kMostCases) {
        cases_ = {{}};  // nothing is certain any more
    }
}

void LinearWatch::read(std::uint32_t label) {
    reader_.read(player_, may_, must_);
    judge(label);
}

void LinearWatch::judge(std::uint32_t label) {
    const AtomRow row{may_.data(), must_.data()};
    holds_ = fails_ = 0;
    for (std::size_t i = 0; i < o_.operands.size(); ++i) {
        const Truth t = o_.operands[i].at(row, label);
        holds_ |= std::uint64_t{t.must ? 1u : 0u} << i;
        fails_ |= std::uint64_t{!t.may ? 1u : 0u} << i;
    }
}

}  // namespace puppetri::verdict
