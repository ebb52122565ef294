// SPDX-License-Identifier: MIT
// Closures are grown from seeds over precomputed lists. Where there is a choice (which unsatisfied
// arc to repair, which conjunct to change, which enabled transition to disable) any is right; the
// cheapest is taken, and of the whole sets that with the fewest enabled transitions.
#include "stubborn.h"

#include <algorithm>
#include <bit>

namespace puppetri::proof {

namespace {

using Op = Predicate::Op;
using net::Rows;
using net::Weighted;

constexpr std::uint32_t kTries = 6;  // sets that are compared in one state

template <class List>
void append_row(Rows<std::uint32_t>& rows, List& list) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
    rows.items.insert(rows.items.end(), list.begin(), list.end());
    rows.starts.push_back(static_cast<std::uint32_t>(rows.items.size()));
    list.clear();
}

}  // namespace

struct Stubborn::Tables {
    const PlainNet* net = nullptr;
    std::vector<Predicate> goals;
    Rows<std::uint32_t> producers, consumers;  // per place: who makes its count larger, smaller
    Rows<std::uint32_t> disabled_by;           // per transition: whom its firing may disable
    Rows<std::uint32_t> disablers;             // per transition: whose firing may disable it
    // Per goal, per node that compares a sum: who can make the comparison true.
    std::vector<Rows<std::uint32_t>> changers;

    Tables(const PlainNet& n, std::span<const Predicate> wanted, bool dead, const Predicate* final)
        : net(&n), goals(wanted.begin(), wanted.end()) {
        if (dead) {
            std::vector<Predicate> parts = {Predicate::no_successor(n)};
            if (final != nullptr) {
                parts.push_back(final->negated());
            }
            goals.push_back(Predicate::all_of(parts));
        }
        const std::uint32_t places = n.place_count(), transitions = n.transition_count();
        // What each firing changes.
        Rows<std::pair<std::uint32_t, std::int64_t>> effects;
        std::vector<std::vector<std::uint32_t>> more(places), less(places), needs(places),
            inhibited(places);
        for (std::uint32_t t = 0; t < transitions; ++t) {
            std::vector<std::pair<std::uint32_t, std::int64_t>> row;
            const auto add = [&](const Weighted& w, std::int64_t sign) {
                const auto it = std::find_if(row.begin(), row.end(),
                                             [&](const auto& e) { return e.first == w.place; });
                if (it == row.end()) {
                    row.emplace_back(w.place, sign * std::int64_t{w.weight});
                } else {
                    it->second += sign * std::int64_t{w.weight};
                }
            };
            for (const Weighted& w : n.gives.row(t)) {
                add(w, 1);
            }
            for (const Weighted& w : n.takes.row(t)) {
                add(w, -1);
                needs[w.place].push_back(t);
            }
            for (const Weighted& w : n.reads.row(t)) {
                needs[w.place].push_back(t);
            }
            for (const Weighted& w : n.unless.row(t)) {
                inhibited[w.place].push_back(t);
            }
            for (const auto& [p, change] : row) {
                if (change != 0) {
                    (change > 0 ? more : less)[p].push_back(t);
                    effects.items.emplace_back(p, change);
                }
            }
            effects.starts.push_back(static_cast<std::uint32_t>(effects.items.size()));
        }
        std::vector<std::uint32_t> list;
        std::vector<std::vector<std::uint32_t>> by(transitions);
        for (std::uint32_t t = 0; t < transitions; ++t) {
            for (const auto& [p, change] : effects.row(t)) {
                const std::vector<std::uint32_t>& hit = change < 0 ? needs[p] : inhibited[p];
                list.insert(list.end(), hit.begin(), hit.end());
            }
            for (const std::uint32_t u : list) {
                by[u].push_back(t);
            }
            append_row(disabled_by, list);
        }
        for (std::vector<std::uint32_t>& row : by) {
            append_row(disablers, row);
        }
        for (std::uint32_t p = 0; p < places; ++p) {
            append_row(producers, more[p]);
            append_row(consumers, less[p]);
        }
        for (const Predicate& goal : goals) {
            changers.emplace_back();
            for (const Predicate::Node& node : goal.nodes) {
                if (node.op == Op::kAtLeast || node.op == Op::kAtMost) {
                    for (std::uint32_t t = 0; t < transitions; ++t) {
                        const std::int64_t change =
                            change_of(goal.sums[node.index], effects.row(t));
                        if (node.op == Op::kAtLeast ? change > 0 : change < 0) {
                            list.push_back(t);
                        }
                    }
                }
                append_row(changers.back(), list);
            }
        }
    }

    static std::int64_t change_of(const LinearSum& sum,
                                  std::span<const std::pair<std::uint32_t, std::int64_t>> effect) {
        std::int64_t change = 0;
        for (const auto& [p, by] : effect) {
            for (const LinearSum::Term& term : sum.terms) {
                change += term.place == p ? term.factor * by : 0;
            }
        }
        return change;
    }
};

// One set being built.
struct Stubborn::Closure {
    const Tables& t;
    std::span<const std::uint32_t> marking;
    std::span<const std::uint64_t> enabled;
    Scratch& scratch;
    std::uint32_t count = 0;  // of enabled members

    bool is_enabled(std::uint32_t v) const { return ((enabled[v / 64] >> (v & 63)) & 1) != 0; }

    void begin() {
        if (++scratch.stamp == 0) {
            std::fill(scratch.in_set.begin(), scratch.in_set.end(), 0);
            scratch.stamp = 1;
        }
        scratch.members.clear();
        count = 0;
    }
    void add(std::uint32_t v) {
        if (scratch.in_set[v] != scratch.stamp) {
            scratch.in_set[v] = scratch.stamp;
            scratch.members.push_back(v);
            count += is_enabled(v) ? 1 : 0;
        }
    }
    void add(std::span<const std::uint32_t> list) {
        for (const std::uint32_t v : list) {
            add(v);
        }
    }

    // Members that a list would bring, the enabled ones counting most.
    std::uint32_t price(std::span<const std::uint32_t> list) const {
        std::uint32_t sum = 0;
        for (const std::uint32_t v : list) {
            if (scratch.in_set[v] != scratch.stamp) {
                sum += is_enabled(v) ? 16 : 1;
            }
        }
        return sum;
    }

    // Rule D for a disabled transition: the repairers of one unsatisfied arc.
    std::span<const std::uint32_t> repairers(std::uint32_t v) const {
        std::span<const std::uint32_t> best;
        std::uint32_t least = ~std::uint32_t{0};
        const auto offer = [&](std::span<const std::uint32_t> list) {
            if (least != 0) {
                const std::uint32_t p = price(list);
                if (p < least) {
                    least = p;
                    best = list;
                }
            }
        };
        for (const Rows<Weighted>* rows : {&t.net->takes, &t.net->reads}) {
            for (const Weighted& w : rows->row(v)) {
                if (marking[w.place] < w.weight) {
                    offer(t.producers.row(w.place));
                }
            }
        }
        for (const Weighted& w : t.net->unless.row(v)) {
            if (marking[w.place] >= w.weight) {
                offer(t.consumers.row(w.place));
            }
        }
        return best;
    }

    // Gives  false when more than `most` enabled transitions are in it.
    bool close(std::uint32_t most) {
        for (std::size_t i = 0; i < scratch.members.size(); ++i) {
            if (count > most) {
                return false;
            }
            const std::uint32_t v = scratch.members[i];
            add(is_enabled(v) ? t.disabled_by.row(v) : repairers(v));
        }
        return count <= most;
    }

    bool holds(const Predicate& goal, std::uint32_t node) const {
        const Predicate::Node& n = goal.nodes[node];
        const std::uint32_t* list = goal.list.data() + n.first;
        switch (n.op) {
            case Op::kFalse:
                return false;
            case Op::kTrue:
                return true;
            case Op::kAtMost:
            case Op::kAtLeast: {
                std::int64_t sum = 0;
                for (const LinearSum::Term& term : goal.sums[n.index].terms) {
                    sum += term.factor * std::int64_t{marking[term.place]};
                }
                return n.op == Op::kAtLeast ? sum >= n.limit : sum <= n.limit;
            }
            case Op::kEnabled:
            case Op::kNoneEnabled: {
                const bool any = std::any_of(list, list + n.count,
                                             [&](std::uint32_t v) { return is_enabled(v); });
                return any == (n.op == Op::kEnabled);
            }
            case Op::kAnd:
                return std::all_of(list, list + n.count,
                                   [&](std::uint32_t child) { return holds(goal, child); });
            case Op::kOr:
                return std::any_of(list, list + n.count,
                                   [&](std::uint32_t child) { return holds(goal, child); });
        }
        return false;
    }

    // Rule W for a node that is false: everything that can make it true, one of the first steps on
    // every way. `pick` numbers the choices. Gives  how many choices there are at this node.
    std::uint32_t seed(std::size_t g, std::uint32_t node, std::uint32_t pick) {
        const Predicate& goal = t.goals[g];
        const Predicate::Node& n = goal.nodes[node];
        const std::span<const std::uint32_t> list{goal.list.data() + n.first, n.count};
        switch (n.op) {
            case Op::kAtMost:
            case Op::kAtLeast:
                add(t.changers[g].row(node));
                return 1;
            case Op::kEnabled:
                for (const std::uint32_t v : list) {
                    add(repairers(v));
                }
                return 1;
            case Op::kNoneEnabled:
                return choose(
                    list, pick, [&](std::uint32_t v) { return is_enabled(v); },
                    [&](std::uint32_t v) { add(t.disablers.row(v)); });
            case Op::kAnd: {
                // The number picks a conjunct; what is left of it a choice within.
                std::uint32_t open = 0, choices = 0;
                for (const std::uint32_t child : list) {
                    open += holds(goal, child) ? 0 : 1;
                }
                choose(
                    list, pick % open, [&](std::uint32_t c) { return !holds(goal, c); },
                    [&](std::uint32_t c) { choices = seed(g, c, pick / open); });
                return open * choices;
            }
            case Op::kOr:
                for (const std::uint32_t child : list) {
                    seed(g, child, 0);
                }
                return 1;
            default:
                return 1;
        }
    }

    template <class Fits, class Use>
    static std::uint32_t choose(std::span<const std::uint32_t> list, std::uint32_t pick,
                                Fits&& fits, Use&& use) {
        std::uint32_t number = 0, first = ~std::uint32_t{0};
        bool used = false;
        for (const std::uint32_t v : list) {
            if (!fits(v)) {
                continue;
            }
            if (first == ~std::uint32_t{0}) {
                first = v;
            }
            if (number++ == pick) {
                use(v);
                used = true;
            }
        }
        if (!used && number != 0) {
            use(first);
        }
        return number;
    }
};

Stubborn::Stubborn(const PlainNet& net, std::span<const Predicate> goals, bool dead,
                   const Predicate* final)
    : tables_(std::make_unique<const Tables>(net, goals, dead, final)) {}

Stubborn::~Stubborn() = default;

void Stubborn::reduce(std::span<const std::uint32_t> marking, std::span<std::uint64_t> enabled,
                      Scratch& scratch) const {
    std::uint32_t all = 0;
    for (const std::uint64_t word : enabled) {
        all += static_cast<std::uint32_t>(std::popcount(word));
    }
    scratch.in_set.resize(tables_->net->transition_count(), 0);
    Closure closure{*tables_, marking, enabled, scratch};
    std::uint32_t least = all, tries = 1;
    bool better = false;
    for (std::uint32_t pick = 0; pick < tries && pick < kTries && least > 1; ++pick) {
        closure.begin();
        for (std::size_t g = 0; g < tables_->goals.size(); ++g) {
            const auto root = static_cast<std::uint32_t>(tables_->goals[g].nodes.size() - 1);
            if (!closure.holds(tables_->goals[g], root)) {
                tries = std::max(tries, closure.seed(g, root, pick));
            }
        }
        if (closure.close(least - 1)) {
            least = closure.count;
            scratch.best = scratch.members;
            better = true;
        }
    }
    if (!better) {
        return;
    }
    std::vector<std::uint64_t>& kept = scratch.kept;
    kept.assign(enabled.size(), 0);
    for (const std::uint32_t v : scratch.best) {
        kept[v / 64] |= std::uint64_t{1} << (v & 63);
    }
    for (std::size_t w = 0; w < enabled.size(); ++w) {
        enabled[w] &= kept[w];
    }
}

}  // namespace puppetri::proof
