// SPDX-License-Identifier: MIT
// Fixpoints of firing on decision diagrams by saturation: nodes are closed under the events of
// their level from the bottom up, so that work stays where events act and few nodes that are not
// part of the result are ever made.
//
// Source  G. Ciardo, R. Marmorstein, R. Siminiceanu, "Saturation Unbound" (TACAS 2003); with a
//         constraint and backwards: Y. Zhao, G. Ciardo (ATVA 2009), figure 4. Ours differs in
//         that events need no tables agreed on beforehand: a level's part is a function of its
//         values, asked as values are found.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "symbolic_levels.h"
#include "symbolic_store.h"

namespace puppetri::proof {

class Saturation {
 public:
    Saturation(DiagramStore& store, SymbolicLevels& levels);

    // All markings that are reached from the first values of all levels.
    NodeId reachable();

    // The rest needs levels.close().
    // Markings that are in `from` or reach (backward: are reached ... and so on) through markings
    // of `within` alone. backward: what can get into `from` along markings of `within`; forward:
    // what `from` gets to along such.
    NodeId closure(NodeId from, NodeId within, bool backward);
    // Markings of `within` one firing (backward: one firing earlier) away from `from`.
    NodeId step(NodeId from, NodeId within, bool backward);
    // The same by one transition.
    NodeId step_by(std::uint32_t event, NodeId from, NodeId within, bool backward);
    // Markings of `within` that enable the transition.
    NodeId enabled(std::uint32_t event, NodeId within) { return enabled_from(event, 0, within); }
    // Markings of `within` that enable one of them at least.
    NodeId enabled_any(std::span<const std::uint32_t> events, NodeId within);

 private:
    struct Candidate {
        std::uint32_t event = 0;
        std::uint32_t function = 0;
    };
    // Values whose child has grown, first come first served.
    struct Queue {
        std::vector<std::uint32_t> waiting;
        std::vector<std::uint8_t> in;
        std::uint32_t head = 0;
        bool empty() const { return head == waiting.size(); }
        void add(std::uint32_t value) {
            if (value >= in.size()) {
                in.resize(value + 1, 0);
            }
            if (!in[value]) {
                in[value] = 1;
                waiting.push_back(value);
            }
        }
        std::uint32_t take() {
            const std::uint32_t value = waiting[head++];
            in[value] = 0;
            if (head * 2 > waiting.size() && head > 64) {
                waiting.erase(waiting.begin(), waiting.begin() + head);
                head = 0;
            }
            return value;
        }
        void clear() {
            while (!empty()) {
                take();
            }
            waiting.clear();
            head = 0;
        }
    };

    void charge();
    // Events whose top is this level and that are enabled there at this value.
    const std::vector<Candidate>& row(std::uint32_t level, std::uint32_t value);
    void saturate_frame(std::uint32_t level, std::uint32_t base);
    NodeId fire(std::uint32_t event, std::uint32_t position, NodeId node);

    std::int32_t target(std::uint32_t function, std::uint32_t value, bool backward) const {
        return backward ? levels_.before(function, value) : levels_.after(function, value);
    }
    NodeId close_node(NodeId node, NodeId within, bool backward);
    void close_frame(std::uint32_t level, std::uint32_t base, NodeId within, bool backward);
    NodeId fire_within(std::uint32_t event, std::uint32_t position, NodeId node, NodeId within,
                       bool backward);
    NodeId step_from(std::uint32_t event, std::uint32_t position, NodeId node, NodeId within,
                     bool backward);
    // Numbers of operations in the store's cache.
    enum Kind : std::uint32_t {
        kFire,
        kStep,
        kFireWithin = kStep + 2,
        kEnabled = kFireWithin + 2,
        kKinds
    };
    std::uint32_t op(std::uint32_t kind, std::uint32_t event) const {
        return first_op_ + kind * event_count_ + event;
    }
    enum Whole : std::uint32_t { kClose, kStepAll = kClose + 2, kWholes = kStepAll + 2 };
    std::uint32_t op_all(std::uint32_t whole, bool backward) const {
        return first_op_ + kKinds * event_count_ + whole + backward;
    }
    using ByTop = std::vector<std::vector<std::uint32_t>>;
    NodeId any_from(const ByTop& by_top, std::uint32_t op, NodeId node);
    struct Move {
        std::uint32_t event = 0, to = 0;
    };
    // Of events whose top is this level: where they lead from this value. After levels.close().
    const std::vector<Move>& moves(std::uint32_t level, std::uint32_t value, bool backward);
    NodeId step_all(NodeId node, NodeId within, bool backward);
    bool add_to(std::uint32_t position, NodeId more);
    NodeId enabled_from(std::uint32_t event, std::uint32_t position, NodeId node);

    DiagramStore& store_;
    SymbolicLevels& levels_;
    std::uint32_t event_count_, first_op_;
    std::vector<std::vector<std::uint32_t>> by_top_;         // per level: events
    std::vector<std::vector<std::vector<Candidate>>> rows_;  // per level and value
    std::vector<std::vector<std::uint8_t>> have_row_;
    using ByLevel = std::vector<std::vector<std::vector<Move>>>;
    std::vector<Queue> queues_;  // per level: only one frame of a level works at a time
    std::uint64_t bytes_ = 0;    // of the rows
    ByLevel moves_[2];           // forward, backward; per level and value
};

}  // namespace puppetri::proof
