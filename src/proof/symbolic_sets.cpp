// SPDX-License-Identifier: MIT
// Sets of markings: algebra, predicates.
#include <algorithm>
#include <numeric>
#include <unordered_map>

#include "puppetri/base/require.h"
#include "puppetri/proof/symbolic.h"
#include "symbolic_reading.h"
#include "symbolic_tables.h"

namespace puppetri::proof {
namespace {

// Words of a set whose weights add up to at most a limit. A node is asked once per limit that its
// own least and largest sum do not decide.
class AtMost {
 public:
    AtMost(DiagramStore& store, const Reading& reading, std::uint32_t levels,
           const std::vector<std::vector<std::int64_t>>& weights)
        : store_(store), reading_(reading), weights_(weights) {
        least_.resize(reading.size(), 0);
        most_.resize(reading.size(), 0);
        for (std::uint32_t level = 1; level <= levels; ++level) {
            for (std::uint32_t i = reading.begin_of(level); i < reading.end_of(level); ++i) {
                bool first = true;
                for (const DiagramEntry& e : store.entries(reading.node(i))) {
                    const std::uint32_t below = reading.position_of(e.child);
                    std::int64_t low = 0, high = 0;
                    if (__builtin_add_overflow(least_[below], weight(level, e.value), &low) ||
                        __builtin_add_overflow(most_[below], weight(level, e.value), &high)) {
                        store.fail(Ended::kUnbounded);
                        return;
                    }
                    least_[i] = first ? low : std::min(least_[i], low);
                    most_[i] = first ? high : std::max(most_[i], high);
                    first = false;
                }
            }
        }
    }

    NodeId select(NodeId node, std::int64_t limit) {
        if (store_.failed()) {
            return DiagramStore::kEmpty;
        }
        const std::uint32_t position = reading_.position_of(node);
        if (most_[position] <= limit) {
            return node;
        }
        if (least_[position] > limit) {
            return DiagramStore::kEmpty;
        }
        const auto [place, fresh] = ops_.try_emplace(limit, 0);
        if (fresh) {
            place->second = store_.new_op();
        }
        const std::uint32_t op = place->second;
        NodeId result = DiagramStore::kEmpty;
        if (store_.cached(op, node, 0, result)) {
            return result;
        }
        const std::uint32_t level = store_.level(node);
        const std::uint32_t base = store_.frame();
        for (const DiagramEntry& e : store_.entries(node)) {
            // No overflow: the limit lies between sums that did not overflow.
            const NodeId below = select(e.child, limit - weight(level, e.value));
            store_.push(e.value, below);
        }
        result = store_.make(level, base);
        store_.remember(op, node, 0, result);
        return result;
    }

 private:
    std::int64_t weight(std::uint32_t level, std::uint32_t value) const {
        return weights_[level].empty() ? 0 : weights_[level][value];
    }
    DiagramStore& store_;
    const Reading& reading_;
    const std::vector<std::vector<std::int64_t>>& weights_;
    std::vector<std::int64_t> least_, most_;
    std::unordered_map<std::int64_t, std::uint32_t> ops_;
};

}  // namespace

StateSet SymbolicSpace::wrap(NodeId root) const {
    return tables_->usable() ? StateSet(tables_.get(), root) : StateSet();
}

StateSet SymbolicSpace::all() const { return wrap(tables_->all); }

StateSet SymbolicSpace::none() const { return wrap(DiagramStore::kEmpty); }

StateSet SymbolicSpace::initial() const { return wrap(tables_->initial); }

StateSet SymbolicSpace::singleton(std::span<const std::uint32_t> marking) const {
    PUP_REQUIRE(marking.size() == net().place_count());
    if (contains(all(), marking) != true) {
        return none();  // or unknown, as all is
    }
    return wrap(tables_->node_of(marking));
}

bool SymbolicSpace::ready(const StateSet& a) const {
    PUP_REQUIRE(!a.known() || a.tables_ == tables_.get());
    return a.known() && tables_->usable();
}

StateSet SymbolicSpace::both(const StateSet& a, const StateSet& b) {
    return ready(a) && ready(b) ? wrap(tables_->store->intersect(a.root_, b.root_)) : StateSet();
}

StateSet SymbolicSpace::either(const StateSet& a, const StateSet& b) {
    return ready(a) && ready(b) ? wrap(tables_->store->unite(a.root_, b.root_)) : StateSet();
}

StateSet SymbolicSpace::without(const StateSet& a, const StateSet& b) {
    return ready(a) && ready(b) ? wrap(tables_->store->subtract(a.root_, b.root_)) : StateSet();
}

StateSet SymbolicSpace::complement(const StateSet& a) { return without(all(), a); }

StateSet SymbolicSpace::enabled(std::uint32_t transition, const StateSet& within) {
    PUP_REQUIRE(transition < net().transition_count());
    return ready(within) ? wrap(tables_->saturation->enabled(transition, within.root_))
                         : StateSet();
}

StateSet SymbolicSpace::at_most(const LinearSum& sum, std::int64_t limit, const StateSet& within) {
    if (!ready(within) || within.root_ == DiagramStore::kEmpty) {
        return within;
    }
    for (const LinearSum::Term& term : sum.terms) {
        PUP_REQUIRE(term.place < net().place_count());
    }
    const SymbolicLevels& levels = *tables_->levels;
    std::vector<std::vector<std::int64_t>> weights;
    if (!levels.weigh(sum, weights)) {
        return {};
    }
    const Reading reading(*tables_->store, within.root_, levels.count());
    AtMost select(*tables_->store, reading, levels.count(), weights);
    return wrap(select.select(within.root_, limit));
}

StateSet SymbolicSpace::satisfying(const Predicate& predicate, const StateSet& within) {
    return satisfying(predicate, static_cast<std::uint32_t>(predicate.nodes.size()) - 1, within);
}

StateSet SymbolicSpace::satisfying(const Predicate& predicate, std::uint32_t index,
                                   const StateSet& within) {
    using Op = Predicate::Op;
    const Predicate::Node& node = predicate.nodes[index];
    const auto listed = [&](std::uint32_t i) { return predicate.list[node.first + i]; };
    switch (node.op) {
        case Op::kFalse:
            return without(within, within);
        case Op::kTrue:
            return within;
        case Op::kAtMost:
            return at_most(predicate.sums[node.index], node.limit, within);
        case Op::kAtLeast:
            if (node.limit == INT64_MIN) {
                return within;
            }
            return without(within, at_most(predicate.sums[node.index], node.limit - 1, within));
        case Op::kEnabled:
        case Op::kNoneEnabled: {
            const std::span<const std::uint32_t> events(predicate.list.data() + node.first,
                                                        node.count);
            const StateSet on = enabled_any(events, within);
            return node.op == Op::kEnabled ? on : without(within, on);
        }
        case Op::kAnd: {
            StateSet result = within;
            for (std::uint32_t i = 0; i < node.count; ++i) {
                result = satisfying(predicate, listed(i), result);
            }
            return result;
        }
        case Op::kOr: {
            StateSet rest = within;
            for (std::uint32_t i = 0; i < node.count; ++i) {
                rest = without(rest, satisfying(predicate, listed(i), rest));
            }
            return without(within, rest);
        }
    }
    return {};
}

StateSet SymbolicSpace::enabled_any(std::span<const std::uint32_t> transitions,
                                    const StateSet& within) {
    for (const std::uint32_t t : transitions) {
        PUP_REQUIRE(t < net().transition_count());
    }
    return ready(within) ? wrap(tables_->saturation->enabled_any(transitions, within.root_))
                         : StateSet();
}

StateSet SymbolicSpace::dead() {
    std::vector<std::uint32_t> transitions(net().transition_count());
    std::iota(transitions.begin(), transitions.end(), 0u);
    return without(all(), enabled_any(transitions, all()));
}

StateSet SymbolicSpace::stuck() {
    std::vector<std::uint32_t> transitions;
    for (std::uint32_t t = 0; t < net().transition_count(); ++t) {
        if (net().optional.empty() || net().optional[t] == 0) {
            transitions.push_back(t);
        }
    }
    return without(all(), enabled_any(transitions, all()));
}

}  // namespace puppetri::proof
