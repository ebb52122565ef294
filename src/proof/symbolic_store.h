// SPDX-License-Identifier: MIT
// Nodes of multi-valued decision diagrams, each kept once. A node of level k has children of level
// k - 1 (no level is skipped: the domains of the variables are not known while they are explored),
// stored sparsely as (value, child) in order of values. Node kEmpty is the empty set on every
// level, kTop the one word of length zero.
//
// Reclaiming: a node is alive if it can be reached from a kept root or from the stack of frames.
// Collection runs only inside make(); so whatever an operation holds across a call that may make
// nodes has to lie on the stack, or below something that does. Ids never move.
//
// Running out of memory or time sets failed(): from then on make() gives kEmpty, operations return
// at once, and no result may be believed.
#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "puppetri/proof/budget.h"

namespace puppetri::proof {

using NodeId = std::uint32_t;

struct DiagramEntry {
    std::uint32_t value = 0;
    NodeId child = 0;
};

class DiagramStore {
 public:
    static constexpr NodeId kEmpty = 0, kTop = 1;
    // Keys of the operation cache: an operation, or an operation of a number (event, function).
    enum Op : std::uint32_t { kUnion, kIntersect, kDifference, kOwn };

    struct View {
        const DiagramEntry* first;
        std::uint32_t count;
        const DiagramEntry* begin() const { return first; }
        const DiagramEntry* end() const { return first + count; }
        NodeId child_of(std::uint32_t value) const;
    };

    DiagramStore(const Budget& budget, const char* method);

    View entries(NodeId id) const {
        const Node& n = node(id);
        return {cell(n.offset), n.count};
    }
    std::uint32_t level(NodeId id) const { return node(id).level; }

    // The frame stack. A frame is everything above its base.
    std::uint32_t frame() const { return static_cast<std::uint32_t>(stack_.size()); }
    void push(std::uint32_t value, NodeId child) { stack_.push_back({value, child}); }
    void pop_to(std::uint32_t base) { stack_.resize(base); }
    DiagramEntry& at(std::uint32_t position) { return stack_[position]; }
    // A frame with one slot per value below `count`, all empty.
    void extend_full(std::uint32_t base, std::uint32_t count);

    // The frame in order of values.
    void sort_frame(std::uint32_t base);
    // The frame, in order of values, with a slot for every value below `count`.
    void spread(std::uint32_t base, std::uint32_t count);

    // The node with the nonempty children of the frame above base, in order of values; pops it.
    NodeId make(std::uint32_t level, std::uint32_t base);

    NodeId unite(NodeId a, NodeId b);
    NodeId intersect(NodeId a, NodeId b);
    NodeId subtract(NodeId a, NodeId b);

    bool cached(std::uint32_t op, NodeId a, NodeId b, NodeId& result);
    void remember(std::uint32_t op, NodeId a, NodeId b, NodeId result);

    // Numbers for operations of one's own in the cache, never given twice.
    std::uint32_t new_op(std::uint32_t count = 1) {
        next_op_ += count;
        if (next_op_ < count) {
            fail(Ended::kMemory);
        }
        return next_op_ - count;
    }

    void keep(NodeId id);     // one more root
    void release(NodeId id);  // one less

    bool failed() const { return ended_ != Ended::kDone; }
    Ended ended() const { return ended_; }
    void fail(Ended why) {
        if (!failed()) {
            ended_ = why;
        }
    }
    // A new budget, and a new chance after a failure.
    void renew(const Budget& budget, const char* method);
    // Looks at the budget now and then; call it wherever work is done without making nodes.
    void tick() {
        if (--patience_ == 0) {
            look();
        }
    }

    // Fails with kStates after so much work, counted in nodes looked for: the same on every
    // machine.
    void limit_work(std::uint64_t work) { work_left_ = work; }
    // No limit any more.
    // Gives  whether the limit was what had failed; then all is well again.
    bool end_limit() {
        work_left_ = ~std::uint64_t{0};
        const bool over = ended_ == Ended::kStates;
        ended_ = over ? Ended::kDone : ended_;
        return over;
    }
    std::uint32_t live_nodes() const { return used_; }
    std::uint32_t id_bound() const { return next_id_; }  // all ids are below
    std::uint64_t bytes() const {
        return bytes_ + charged_ + stack_.capacity() * sizeof(DiagramEntry);
    }
    // What others hold for the diagram's sake counts against the same budget.
    void charge(std::uint64_t bytes) { charged_ = bytes; }
    std::uint64_t peak_bytes() const { return peak_bytes_; }

 private:
    struct Node {
        std::uint32_t offset = 0;
        std::uint32_t count = 0;
        NodeId next = 0;
        std::uint32_t level : 31 = 0;
        std::uint32_t marked : 1 = 0;
    };
    struct Cached {
        std::uint32_t op = ~0u;
        NodeId a = 0, b = 0, result = 0;
    };
    static constexpr std::uint32_t kNodeBits = 14, kCellBits = 16;

    Node& node(NodeId id) { return node_chunks_[id >> kNodeBits][id & ((1u << kNodeBits) - 1)]; }
    const Node& node(NodeId id) const {
        return node_chunks_[id >> kNodeBits][id & ((1u << kNodeBits) - 1)];
    }
    DiagramEntry* cell(std::uint32_t offset) const {
        return cell_chunks_[offset >> kCellBits].get() + (offset & ((1u << kCellBits) - 1));
    }
    static std::uint32_t class_of(std::uint32_t count);
    static std::uint32_t capacity_of(std::uint32_t count);
    static std::uint64_t hash_of(std::uint32_t level, const DiagramEntry* first,
                                 std::uint32_t count);
    bool allocate(std::uint32_t count, std::uint32_t& offset);
    void give_back(std::uint32_t offset, std::uint32_t capacity);
    bool affordable(std::uint64_t more) const;
    bool new_node(NodeId& id);
    void grow_buckets();
    void grow_cache();
    void mark_from(NodeId root);
    void collect();
    void look();
    void account(std::uint64_t bytes);

    Budget budget_;
    std::unique_ptr<Meter> meter_;
    Ended ended_ = Ended::kDone;
    std::uint32_t patience_ = 1;
    std::uint32_t next_op_ = kOwn;
    std::uint64_t work_left_ = ~std::uint64_t{0};

    std::vector<std::unique_ptr<Node[]>> node_chunks_;
    std::vector<std::unique_ptr<DiagramEntry[]>> cell_chunks_;
    std::vector<std::uint32_t> free_cells_;  // per capacity: offset of the first free block + 1
    std::uint32_t cell_end_ = 0;             // where the last chunk is free
    NodeId free_nodes_ = 0, next_id_ = 0;
    std::uint32_t used_ = 0, collect_at_ = 1u << 18;
    std::vector<NodeId> buckets_;
    std::vector<Cached> cache_;
    std::uint64_t overwritten_ = 0;  // results lost since the cache last grew
    std::vector<DiagramEntry> stack_;
    std::vector<NodeId> marking_;  // of collect()
    std::vector<NodeId> kept_;     // an element per keep()
    std::uint64_t bytes_ = 0, charged_ = 0, peak_bytes_ = 0;
};

}  // namespace puppetri::proof
