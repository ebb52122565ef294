// SPDX-License-Identifier: MIT
#include "symbolic_store.h"

#include <algorithm>
#include <bit>

#include "puppetri/base/hash.h"

namespace puppetri::proof {
namespace {

constexpr std::uint32_t kExactClasses = 64;  // blocks up to here are kept by their exact size
constexpr std::uint32_t kCacheAtFirst = 1u << 14;
constexpr std::uint32_t kPatience = 2048;

std::uint64_t hash_of(std::uint32_t op, NodeId a, NodeId b) {
    return mix64((std::uint64_t{a} << 32 | b) + std::uint64_t{op} * 0x9E3779B97F4A7C15u);
}

}  // namespace

NodeId DiagramStore::View::child_of(std::uint32_t value) const {
    std::uint32_t low = 0, high = count;
    while (low < high) {
        const std::uint32_t middle = (low + high) / 2;
        if (first[middle].value < value) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    return low < count && first[low].value == value ? first[low].child : kEmpty;
}

DiagramStore::DiagramStore(const Budget& budget, const char* method)
    : budget_(budget), meter_(std::make_unique<Meter>(budget_, method)) {
    buckets_.resize(1u << 12, kEmpty);
    cache_.resize(kCacheAtFirst);
    // Small budgets are swept often: what they cannot afford is garbage.
    collect_at_ = static_cast<std::uint32_t>(
        std::clamp<std::uint64_t>(budget.bytes >> 11, 1u << 9, 1u << 18));
    free_cells_.resize(kExactClasses + 1 + 4 * 32, 0);
    account(buckets_.size() * sizeof(NodeId) + cache_.size() * sizeof(Cached));
    NodeId id = 0;
    new_node(id);  // kEmpty
    new_node(id);  // kTop
}

void DiagramStore::renew(const Budget& budget, const char* method) {
    budget_ = budget;
    meter_ = std::make_unique<Meter>(budget_, method);
    ended_ = Ended::kDone;
    patience_ = 1;
    work_left_ = ~std::uint64_t{0};
    pop_to(0);
}

void DiagramStore::account(std::uint64_t bytes) {
    bytes_ += bytes;
    peak_bytes_ = std::max(peak_bytes_, this->bytes());
}

bool DiagramStore::affordable(std::uint64_t more) const { return bytes() + more <= budget_.bytes; }

void DiagramStore::look() {
    patience_ = kPatience;
    if (work_left_ < kPatience) {
        fail(Ended::kStates);
    }
    work_left_ -= kPatience;
    if (!affordable(0)) {
        fail(Ended::kMemory);
    }
    const Ended said = meter_->look(used_, 0, 0, bytes());
    if (said != Ended::kDone && said != Ended::kStates) {  // nodes are no states
        fail(said);
    }
    peak_bytes_ = std::max(peak_bytes_, bytes());
}

void DiagramStore::extend_full(std::uint32_t base, std::uint32_t count) {
    const auto wanted = std::size_t{base} + count;
    while (stack_.size() < wanted) {
        stack_.push_back({static_cast<std::uint32_t>(stack_.size() - base), kEmpty});
    }
}

void DiagramStore::sort_frame(std::uint32_t base) {
    const auto less = [](const DiagramEntry& a, const DiagramEntry& b) {
        return a.value < b.value;
    };
    const auto first = stack_.begin() + static_cast<std::ptrdiff_t>(base);
    if (!std::is_sorted(first, stack_.end(), less)) {
        std::sort(first, stack_.end(), less);
    }
}

void DiagramStore::spread(std::uint32_t base, std::uint32_t count) {
    std::uint32_t from = frame();
    extend_full(base, count);
    // From the back: no entry is further than its slot.
    for (std::uint32_t to = base + count; from > base;) {
        const DiagramEntry entry = stack_[--from];
        while (to > base + entry.value + 1) {
            --to;
            stack_[to] = {to - base, kEmpty};
        }
        stack_[--to] = entry;
        if (from == base) {
            while (to > base) {
                --to;
                stack_[to] = {to - base, kEmpty};
            }
        }
    }
}

// Blocks above kExactClasses come in four sizes per power of two.
std::uint32_t DiagramStore::class_of(std::uint32_t count) {
    if (count <= kExactClasses) {
        return count;
    }
    const auto log = static_cast<std::uint32_t>(std::bit_width(count - 1)) - 1;  // count > 2^log
    const std::uint32_t quarter = ((count - 1) >> (log - 2)) & 3;
    return kExactClasses + 1 + 4 * log + quarter;
}

std::uint32_t DiagramStore::capacity_of(std::uint32_t count) {
    if (count <= kExactClasses) {
        return count;
    }
    const auto log = static_cast<std::uint32_t>(std::bit_width(count - 1)) - 1;
    const std::uint32_t quarter = ((count - 1) >> (log - 2)) & 3;
    return (4 + quarter + 1) << (log - 2);
}

void DiagramStore::give_back(std::uint32_t offset, std::uint32_t capacity) {
    const std::uint32_t which = class_of(capacity);
    cell(offset)->value = free_cells_[which];
    free_cells_[which] = offset + 1;
}

bool DiagramStore::allocate(std::uint32_t count, std::uint32_t& offset) {
    const std::uint32_t capacity = capacity_of(count);
    const auto take = [&](std::uint32_t which) {
        offset = free_cells_[which] - 1;
        free_cells_[which] = cell(offset)->value;
    };
    if (free_cells_[class_of(count)] != 0) {
        take(class_of(count));
        return true;
    }
    constexpr std::uint32_t kChunk = 1u << kCellBits;
    const std::uint32_t room = (kChunk - (cell_end_ & (kChunk - 1))) & (kChunk - 1);
    if (capacity <= room) {
        offset = cell_end_;
        cell_end_ += capacity;
        return true;
    }
    const std::uint64_t size = std::max(kChunk, capacity);
    if (affordable(size * sizeof(DiagramEntry)) && cell_chunks_.size() + size / kChunk < kChunk) {
        const auto start = static_cast<std::uint32_t>(cell_chunks_.size()) << kCellBits;
        cell_chunks_.emplace_back(new DiagramEntry[size]);
        // A block larger than a chunk takes the numbers of several.
        cell_chunks_.resize(cell_chunks_.size() + (size + kChunk - 1) / kChunk - 1);
        account(size * sizeof(DiagramEntry));
        offset = start;
        cell_end_ = capacity < kChunk ? start + capacity : 0;
        return true;
    }
    for (std::uint32_t larger = capacity + 1; larger <= kExactClasses; ++larger) {
        if (free_cells_[larger] != 0) {
            take(larger);
            give_back(offset + capacity, larger - capacity);
            return true;
        }
    }
    return false;
}

bool DiagramStore::new_node(NodeId& id) {
    if (free_nodes_ != 0) {
        id = free_nodes_;
        free_nodes_ = node(id).next;
        return true;
    }
    constexpr std::uint32_t kChunk = 1u << kNodeBits;
    if (next_id_ >> kNodeBits == node_chunks_.size()) {
        if (next_id_ > ~kChunk || (next_id_ != 0 && !affordable(kChunk * sizeof(Node)))) {
            return false;
        }
        node_chunks_.emplace_back(new Node[kChunk]);
        account(kChunk * sizeof(Node));
    }
    id = next_id_++;
    return true;
}

std::uint64_t DiagramStore::hash_of(std::uint32_t level, const DiagramEntry* first,
                                    std::uint32_t count) {
    std::uint64_t h = level;
    for (std::uint32_t i = 0; i < count; ++i) {
        h = (h ^ (std::uint64_t{first[i].value} << 32 | first[i].child)) * 0x9E3779B97F4A7C15u;
        h ^= h >> 29;
    }
    return mix64(h);
}

NodeId DiagramStore::make(std::uint32_t level, std::uint32_t base) {
    std::uint32_t end = base;
    for (std::uint32_t i = base; i < stack_.size(); ++i) {
        if (stack_[i].child != kEmpty) {
            stack_[end++] = stack_[i];
        }
    }
    stack_.resize(end);
    const std::uint32_t count = end - base;
    tick();
    if (count == 0 || failed()) {
        pop_to(base);
        return kEmpty;
    }
    const std::uint64_t hash = hash_of(level, &stack_[base], count);
    for (NodeId id = buckets_[hash & (buckets_.size() - 1)]; id != kEmpty; id = node(id).next) {
        const Node& n = node(id);
        if (n.level == level && n.count == count &&
            std::equal(cell(n.offset), cell(n.offset) + count, &stack_[base],
                       [](const DiagramEntry& x, const DiagramEntry& y) {
                           return x.value == y.value && x.child == y.child;
                       })) {
            pop_to(base);
            return id;
        }
    }
    if (used_ >= collect_at_) {
        collect();
        collect_at_ = std::max(collect_at_, 2 * used_);
    }
    std::uint32_t offset = 0;
    NodeId id = 0;
    bool have_cells = allocate(count, offset);
    bool have_node = have_cells && new_node(id);
    if (!have_node) {
        if (have_cells) {
            give_back(offset, capacity_of(count));
        }
        const std::uint32_t before = used_;
        collect();
        // Almost nothing came back: the next collection would be due at once.
        have_cells = used_ < before - before / 4 && allocate(count, offset);
        have_node = have_cells && new_node(id);
        if (!have_node) {
            fail(Ended::kMemory);
            pop_to(base);
            return kEmpty;
        }
    }
    std::copy(&stack_[base], &stack_[base] + count, cell(offset));
    pop_to(base);
    if (++used_ > buckets_.size()) {
        grow_buckets();
    }
    Node& n = node(id);
    NodeId& bucket = buckets_[hash & (buckets_.size() - 1)];
    n.offset = offset;
    n.count = count;
    n.level = level;
    n.marked = 0;
    n.next = bucket;
    bucket = id;
    return id;
}

void DiagramStore::grow_buckets() {
    const std::uint64_t more = buckets_.size() * sizeof(NodeId);
    if (!affordable(more)) {
        return;  // longer chains
    }
    std::vector<NodeId> old(buckets_.size() * 2, kEmpty);
    old.swap(buckets_);
    account(more);
    for (NodeId id : old) {
        while (id != kEmpty) {
            Node& n = node(id);
            const NodeId next = n.next;
            NodeId& bucket =
                buckets_[hash_of(n.level, cell(n.offset), n.count) & (buckets_.size() - 1)];
            n.next = bucket;
            bucket = id;
            id = next;
        }
    }
}

void DiagramStore::grow_cache() {
    const std::uint64_t more = cache_.size() * sizeof(Cached);
    if (2 * more > budget_.bytes / 4 || !affordable(more)) {
        return;
    }
    std::vector<Cached> old(cache_.size() * 2);
    old.swap(cache_);
    account(more);
    for (const Cached& c : old) {
        if (c.op != ~0u) {
            cache_[proof::hash_of(c.op, c.a, c.b) & (cache_.size() - 1)] = c;
        }
    }
}

bool DiagramStore::cached(std::uint32_t op, NodeId a, NodeId b, NodeId& result) {
    const Cached& c = cache_[proof::hash_of(op, a, b) & (cache_.size() - 1)];
    if (c.op == op && c.a == a && c.b == b) {
        result = c.result;
        return true;
    }
    tick();
    return failed() ? (result = kEmpty, true) : false;
}

void DiagramStore::remember(std::uint32_t op, NodeId a, NodeId b, NodeId result) {
    if (failed()) {
        return;
    }
    Cached& c = cache_[proof::hash_of(op, a, b) & (cache_.size() - 1)];
    overwritten_ += c.op != ~0u ? 1 : 0;
    c = {op, a, b, result};
    if (overwritten_ > cache_.size()) {
        overwritten_ = 0;
        grow_cache();
    }
}

void DiagramStore::keep(NodeId id) {
    if (id > kTop) {
        kept_.push_back(id);
    }
}

void DiagramStore::release(NodeId id) {
    for (std::size_t i = kept_.size(); id > kTop && i-- > 0;) {
        if (kept_[i] == id) {
            kept_[i] = kept_.back();
            kept_.pop_back();
            return;
        }
    }
}

void DiagramStore::mark_from(NodeId root) {
    if (root <= kTop || node(root).marked) {
        return;
    }
    node(root).marked = 1;
    marking_.push_back(root);
    while (!marking_.empty()) {
        const NodeId id = marking_.back();
        marking_.pop_back();
        for (const DiagramEntry& e : entries(id)) {
            if (e.child > kTop && !node(e.child).marked) {
                node(e.child).marked = 1;
                marking_.push_back(e.child);
            }
        }
    }
}

void DiagramStore::collect() {
    for (const NodeId id : kept_) {
        mark_from(id);
    }
    for (const DiagramEntry& e : stack_) {
        mark_from(e.child);
    }
    const auto alive = [&](NodeId id) { return id <= kTop || node(id).marked; };
    for (Cached& c : cache_) {
        if (c.op != ~0u && !(alive(c.a) && alive(c.b) && alive(c.result))) {
            c.op = ~0u;
        }
    }
    for (NodeId& bucket : buckets_) {
        NodeId kept = kEmpty;
        for (NodeId id = bucket; id != kEmpty;) {
            Node& n = node(id);
            const NodeId next = n.next;
            if (n.marked) {
                n.marked = 0;
                n.next = kept;
                kept = id;
            } else {
                give_back(n.offset, capacity_of(n.count));
                n.next = free_nodes_;
                free_nodes_ = id;
                --used_;
            }
            id = next;
        }
        bucket = kept;
    }
}

namespace {

// Merges two sorted rows; `pair` is asked for the child of a value in both.
template <class Left, class Right, class Pair>
void merge(DiagramStore::View a, DiagramStore::View b, Left left, Right right, Pair pair) {
    const DiagramEntry *x = a.begin(), *y = b.begin();
    while (x != a.end() || y != b.end()) {
        if (y == b.end() || (x != a.end() && x->value < y->value)) {
            left(*x++);
        } else if (x == a.end() || y->value < x->value) {
            right(*y++);
        } else {
            pair(x->value, x->child, y->child);
            ++x;
            ++y;
        }
    }
}

}  // namespace

NodeId DiagramStore::unite(NodeId a, NodeId b) {
    if (a == b || b == kEmpty) {
        return a;
    }
    if (a == kEmpty) {
        return b;
    }
    if (a > b) {
        std::swap(a, b);
    }
    NodeId result = kEmpty;
    if (cached(kUnion, a, b, result)) {
        return result;
    }
    const std::uint32_t base = frame();
    merge(
        entries(a), entries(b), [&](const DiagramEntry& e) { push(e.value, e.child); },
        [&](const DiagramEntry& e) { push(e.value, e.child); },
        [&](std::uint32_t value, NodeId x, NodeId y) { push(value, unite(x, y)); });
    result = make(level(a), base);
    remember(kUnion, a, b, result);
    return result;
}

NodeId DiagramStore::intersect(NodeId a, NodeId b) {
    if (a == b || a == kEmpty || b == kEmpty) {
        return a == b ? a : kEmpty;
    }
    if (a > b) {
        std::swap(a, b);
    }
    NodeId result = kEmpty;
    if (cached(kIntersect, a, b, result)) {
        return result;
    }
    const std::uint32_t base = frame();
    merge(
        entries(a), entries(b), [](const DiagramEntry&) {}, [](const DiagramEntry&) {},
        [&](std::uint32_t value, NodeId x, NodeId y) { push(value, intersect(x, y)); });
    result = make(level(a), base);
    remember(kIntersect, a, b, result);
    return result;
}

NodeId DiagramStore::subtract(NodeId a, NodeId b) {
    if (a == b || a == kEmpty || b == kEmpty) {
        return a == b ? kEmpty : a;
    }
    NodeId result = kEmpty;
    if (cached(kDifference, a, b, result)) {
        return result;
    }
    const std::uint32_t base = frame();
    merge(
        entries(a), entries(b), [&](const DiagramEntry& e) { push(e.value, e.child); },
        [](const DiagramEntry&) {},
        [&](std::uint32_t value, NodeId x, NodeId y) { push(value, subtract(x, y)); });
    result = make(level(a), base);
    remember(kDifference, a, b, result);
    return result;
}

}  // namespace puppetri::proof
