// SPDX-License-Identifier: MIT
#include "saturation.h"

namespace puppetri::proof {

Saturation::Saturation(DiagramStore& store, SymbolicLevels& levels)
    : store_(store),
      levels_(levels),
      event_count_(static_cast<std::uint32_t>(levels.events().size())),
      first_op_(store.new_op(kKinds * event_count_ + kWholes)),
      by_top_(levels.count() + 1),
      rows_(levels.count() + 1),
      have_row_(levels.count() + 1),
      queues_(levels.count() + 1),
      moves_{ByLevel(levels.count() + 1), ByLevel(levels.count() + 1)} {
    for (std::uint32_t e = 0; e < event_count_; ++e) {
        by_top_[levels.events()[e].top()].push_back(e);
    }
}

// Twice, because vectors grow by doubling.
void Saturation::charge() { store_.charge(2 * (levels_.bytes() + bytes_)); }

const std::vector<Saturation::Candidate>& Saturation::row(std::uint32_t level,
                                                          std::uint32_t value) {
    std::vector<std::vector<Candidate>>& rows = rows_[level];
    if (rows.size() <= value) {
        rows.resize(value + 1);
        have_row_[level].resize(value + 1, 0);
        bytes_ += sizeof(std::vector<Candidate>) + 6;  // with the queue's share
    }
    if (!have_row_[level][value]) {
        have_row_[level][value] = 1;
        for (const std::uint32_t e : by_top_[level]) {
            const std::uint32_t f = levels_.events()[e].touches[0].function;
            if (levels_.enabled(f, value)) {
                rows[value].push_back({e, f});
                bytes_ += sizeof(Candidate);
            }
        }
    }
    return rows[value];
}

NodeId Saturation::reachable() {
    NodeId node = DiagramStore::kTop;
    const std::uint32_t outer = store_.frame();
    for (std::uint32_t level = 1; level <= levels_.count() && !store_.failed(); ++level) {
        const std::uint32_t base = store_.frame();
        store_.push(0, node);
        saturate_frame(level, base);
        node = store_.make(level, base);
    }
    store_.pop_to(outer);
    return node;
}

// The frame above base has a slot per value of the level that was found so far; closes it under the
// events of this level. The children are closed under those of lower levels.
void Saturation::saturate_frame(std::uint32_t level, std::uint32_t base) {
    Queue& queue = queues_[level];
    for (std::uint32_t v = 0; base + v < store_.frame(); ++v) {
        if (store_.at(base + v).child != DiagramStore::kEmpty) {
            queue.add(v);
        }
    }
    while (!queue.empty() && !store_.failed()) {
        const std::uint32_t value = queue.take();
        charge();
        store_.tick();
        const std::vector<Candidate>& candidates = row(level, value);
        for (std::size_t c = 0; c < candidates.size() && !store_.failed(); ++c) {
            const Candidate candidate = candidates[c];
            const NodeId reached = fire(candidate.event, 1, store_.at(base + value).child);
            if (reached == DiagramStore::kEmpty) {
                continue;
            }
            const std::int32_t found = levels_.reach(candidate.function, value);
            if (found < 0) {
                store_.fail(Ended::kUnbounded);
                break;
            }
            const auto to = static_cast<std::uint32_t>(found);
            store_.extend_full(base, to + 1);
            if (add_to(base + to, reached)) {
                queue.add(to);
            }
        }
    }
    queue.clear();
}

// What the event's touches from `position` on make of a closed node: closed again.
NodeId Saturation::fire(std::uint32_t event, std::uint32_t position, NodeId node) {
    const std::vector<SymbolicLevels::Touch>& touches = levels_.events()[event].touches;
    if (node == DiagramStore::kEmpty || position == touches.size()) {
        return node;
    }
    NodeId result = DiagramStore::kEmpty;
    if (store_.cached(op(kFire, event), node, 0, result)) {
        return result;
    }
    const std::uint32_t level = store_.level(node);
    const std::uint32_t base = store_.frame();
    const bool touched = touches[position].level == level;
    const std::uint32_t function = touches[position].function;
    for (const DiagramEntry& e : store_.entries(node)) {
        if (touched && levels_.next(function, e.value) == SymbolicLevels::kDisabled) {
            continue;
        }
        const NodeId below = fire(event, position + (touched ? 1 : 0), e.child);
        if (below == DiagramStore::kEmpty) {
            continue;
        }
        const std::int32_t to =
            touched ? levels_.reach(function, e.value) : static_cast<std::int32_t>(e.value);
        if (to < 0) {
            store_.fail(Ended::kUnbounded);
            break;
        }
        store_.push(static_cast<std::uint32_t>(to), below);  // injective: nobody else goes there
    }
    if (store_.frame() != base && !store_.failed()) {
        store_.sort_frame(base);
        bool acts = false;
        for (std::uint32_t i = base; i < store_.frame() && !acts; ++i) {
            acts = !row(level, store_.at(i).value).empty();
        }
        if (acts) {
            store_.spread(base, levels_.value_count(level));
            saturate_frame(level, base);
        }
        result = store_.make(level, base);
    } else {
        store_.pop_to(base);
    }
    store_.remember(op(kFire, event), node, 0, result);
    return result;
}

NodeId Saturation::step_by(std::uint32_t event, NodeId from, NodeId within, bool backward) {
    return step_from(event, 0, from, within, backward);
}

NodeId Saturation::step(NodeId from, NodeId within, bool backward) {
    if (by_top_[0].empty()) {
        return step_all(from, within, backward);
    }
    const std::uint32_t base = store_.frame();  // events that touch nothing lead from here to here
    store_.push(0, store_.intersect(from, within));
    store_.push(0, step_all(from, within, backward));
    const NodeId all = store_.unite(store_.at(base).child, store_.at(base + 1).child);
    store_.pop_to(base);
    return all;
}

// By all events whose top is not above the node's level: those of this level, and what the lower
// ones do to each child.
NodeId Saturation::step_all(NodeId node, NodeId within, bool backward) {
    if (node <= DiagramStore::kTop || within == DiagramStore::kEmpty) {
        return DiagramStore::kEmpty;
    }
    NodeId result = DiagramStore::kEmpty;
    if (store_.cached(op_all(kStepAll, backward), node, within, result)) {
        return result;
    }
    const std::uint32_t level = store_.level(node);
    const std::uint32_t base = store_.frame();
    const DiagramStore::View allowed = store_.entries(within);
    if (by_top_[level].empty()) {
        for (const DiagramEntry& e : store_.entries(node)) {
            const NodeId below = step_all(e.child, allowed.child_of(e.value), backward);
            store_.push(e.value, below);
        }
    } else {
        store_.extend_full(base, levels_.value_count(level));
        for (const DiagramEntry& e : store_.entries(node)) {
            add_to(base + e.value, step_all(e.child, allowed.child_of(e.value), backward));
            for (const Move move : moves(level, e.value, backward)) {
                add_to(base + move.to,
                       step_from(move.event, 1, e.child, allowed.child_of(move.to), backward));
            }
        }
    }
    result = store_.make(level, base);
    store_.remember(op_all(kStepAll, backward), node, within, result);
    return result;
}

const std::vector<Saturation::Move>& Saturation::moves(std::uint32_t level, std::uint32_t value,
                                                       bool backward) {
    std::vector<std::vector<Move>>& rows = moves_[backward ? 1 : 0][level];
    if (rows.empty()) {
        rows.resize(levels_.value_count(level));
        bytes_ += rows.size() * sizeof(rows[0]);
        for (const std::uint32_t event : by_top_[level]) {
            const std::uint32_t function = levels_.events()[event].touches[0].function;
            for (std::uint32_t v = 0; v < rows.size(); ++v) {
                const std::int32_t to =
                    backward ? levels_.before(function, v) : levels_.after(function, v);
                if (to >= 0) {
                    rows[v].push_back({event, static_cast<std::uint32_t>(to)});
                    bytes_ += sizeof(Move);
                }
            }
        }
        charge();
    }
    return rows[value];
}

// Unites a slot of the frame with a node.
// Gives  whether the slot has grown.
bool Saturation::add_to(std::uint32_t position, NodeId more) {
    const NodeId old = store_.at(position).child;
    if (more == DiagramStore::kEmpty || more == old) {
        return false;
    }
    const std::uint32_t top = store_.frame();
    store_.push(0, more);
    const NodeId both = store_.unite(old, more);
    store_.pop_to(top);
    store_.at(position).child = both;
    return both != old;
}

NodeId Saturation::step_from(std::uint32_t event, std::uint32_t position, NodeId node,
                             NodeId within, bool backward) {
    const std::vector<SymbolicLevels::Touch>& touches = levels_.events()[event].touches;
    if (node == DiagramStore::kEmpty || within == DiagramStore::kEmpty) {
        return DiagramStore::kEmpty;
    }
    if (position == touches.size()) {
        return store_.intersect(node, within);
    }
    NodeId result = DiagramStore::kEmpty;
    if (store_.cached(op(kStep + backward, event), node, within, result)) {
        return result;
    }
    const std::uint32_t level = store_.level(node);
    const std::uint32_t base = store_.frame();
    const DiagramStore::View allowed = store_.entries(within);
    const bool touched = touches[position].level == level;
    for (const DiagramEntry& e : store_.entries(node)) {
        const std::int32_t to = touched ? target(touches[position].function, e.value, backward)
                                        : static_cast<std::int32_t>(e.value);
        if (to >= 0) {
            const NodeId below =
                step_from(event, position + (touched ? 1 : 0), e.child,
                          allowed.child_of(static_cast<std::uint32_t>(to)), backward);
            store_.push(static_cast<std::uint32_t>(to), below);
        }
    }
    store_.sort_frame(base);
    result = store_.make(level, base);
    store_.remember(op(kStep + backward, event), node, within, result);
    return result;
}

NodeId Saturation::enabled_from(std::uint32_t event, std::uint32_t position, NodeId node) {
    const std::vector<SymbolicLevels::Touch>& touches = levels_.events()[event].touches;
    if (node == DiagramStore::kEmpty || position == touches.size()) {
        return node;
    }
    NodeId result = DiagramStore::kEmpty;
    if (store_.cached(op(kEnabled, event), node, 0, result)) {
        return result;
    }
    const std::uint32_t level = store_.level(node);
    const std::uint32_t base = store_.frame();
    const bool touched = touches[position].level == level;
    for (const DiagramEntry& e : store_.entries(node)) {
        if (!touched || levels_.enabled(touches[position].function, e.value)) {
            const NodeId below = enabled_from(event, position + (touched ? 1 : 0), e.child);
            store_.push(e.value, below);
        }
    }
    result = store_.make(level, base);
    store_.remember(op(kEnabled, event), node, 0, result);
    return result;
}

NodeId Saturation::enabled_any(std::span<const std::uint32_t> events, NodeId within) {
    ByTop by_top(levels_.count() + 1);
    for (const std::uint32_t e : events) {
        by_top[levels_.events()[e].top()].push_back(e);
    }
    if (!by_top[0].empty()) {
        return within;  // nothing keeps an event that touches nothing
    }
    return any_from(by_top, store_.new_op(), within);
}

// Shares the work of all events below a node, and stops where they cover it.
NodeId Saturation::any_from(const ByTop& by_top, std::uint32_t op, NodeId node) {
    if (node <= DiagramStore::kTop) {
        return DiagramStore::kEmpty;
    }
    NodeId result = DiagramStore::kEmpty;
    if (store_.cached(op, node, 0, result)) {
        return result;
    }
    const std::uint32_t level = store_.level(node);
    const std::uint32_t base = store_.frame();
    for (const DiagramEntry& e : store_.entries(node)) {
        const NodeId below = any_from(by_top, op, e.child);
        store_.push(e.value, below);
        const std::uint32_t slot = store_.frame() - 1;
        for (const std::uint32_t event : by_top[level]) {
            if (store_.at(slot).child == e.child) {
                break;
            }
            if (levels_.enabled(levels_.events()[event].touches[0].function, e.value)) {
                const NodeId more = enabled_from(event, 1, e.child);
                add_to(slot, more);
            }
        }
    }
    result = store_.make(level, base);
    store_.remember(op, node, 0, result);
    return result;
}

NodeId Saturation::closure(NodeId from, NodeId within, bool backward) {
    return close_node(from, within, backward);
}

// from, and all that firings among `within` make of it at this level and below.
NodeId Saturation::close_node(NodeId node, NodeId within, bool backward) {
    if (node == DiagramStore::kEmpty || within == DiagramStore::kEmpty ||
        node == DiagramStore::kTop) {
        return node;
    }
    NodeId result = DiagramStore::kEmpty;
    if (store_.cached(op_all(kClose, backward), node, within, result)) {
        return result;
    }
    const std::uint32_t level = store_.level(node);
    const std::uint32_t base = store_.frame();
    const DiagramStore::View allowed = store_.entries(within);
    for (const DiagramEntry& e : store_.entries(node)) {
        const NodeId below = close_node(e.child, allowed.child_of(e.value), backward);
        store_.push(e.value, below);
    }
    close_frame(level, base, within, backward);
    result = store_.make(level, base);
    store_.remember(op_all(kClose, backward), node, within, result);
    return result;
}

// The frame holds some values in their order; spread out here if any event acts on them.
void Saturation::close_frame(std::uint32_t level, std::uint32_t base, NodeId within,
                             bool backward) {
    Queue& queue = queues_[level];
    if (by_top_[level].empty()) {
        return;
    }
    for (std::uint32_t i = base; i < store_.frame(); ++i) {
        const DiagramEntry entry = store_.at(i);
        if (entry.child != DiagramStore::kEmpty && !moves(level, entry.value, backward).empty()) {
            queue.add(entry.value);
        }
    }
    if (queue.empty()) {
        return;
    }
    store_.spread(base, levels_.value_count(level));
    const DiagramStore::View allowed = store_.entries(within);
    while (!queue.empty() && !store_.failed()) {
        const std::uint32_t value = queue.take();
        for (const Move move : moves(level, value, backward)) {
            const NodeId room = allowed.child_of(move.to);
            const NodeId reached =
                fire_within(move.event, 1, store_.at(base + value).child, room, backward);
            if (!store_.failed() && add_to(base + move.to, reached)) {
                queue.add(move.to);
            }
        }
    }
    queue.clear();
}

// Targets in `within` alone, closed under lower events among `within`.
NodeId Saturation::fire_within(std::uint32_t event, std::uint32_t position, NodeId node,
                               NodeId within, bool backward) {
    const std::vector<SymbolicLevels::Touch>& touches = levels_.events()[event].touches;
    if (node == DiagramStore::kEmpty || within == DiagramStore::kEmpty) {
        return DiagramStore::kEmpty;
    }
    if (position == touches.size()) {
        const std::uint32_t base = store_.frame();
        const NodeId inside = store_.intersect(node, within);
        store_.push(0, inside);
        const NodeId closed = close_node(inside, within, backward);
        store_.pop_to(base);
        return closed;
    }
    NodeId result = DiagramStore::kEmpty;
    if (store_.cached(op(kFireWithin + backward, event), node, within, result)) {
        return result;
    }
    const std::uint32_t level = store_.level(node);
    const std::uint32_t base = store_.frame();
    const DiagramStore::View allowed = store_.entries(within);
    const bool touched = touches[position].level == level;
    for (const DiagramEntry& e : store_.entries(node)) {
        const std::int32_t to = touched ? target(touches[position].function, e.value, backward)
                                        : static_cast<std::int32_t>(e.value);
        if (to < 0) {
            continue;
        }
        const NodeId below =
            fire_within(event, position + (touched ? 1 : 0), e.child,
                        allowed.child_of(static_cast<std::uint32_t>(to)), backward);
        if (below != DiagramStore::kEmpty) {
            store_.push(static_cast<std::uint32_t>(to), below);
        }
    }
    store_.sort_frame(base);
    close_frame(level, base, within, backward);
    result = store_.make(level, base);
    store_.remember(op(kFireWithin + backward, event), node, within, result);
    return result;
}

}  // namespace puppetri::proof
