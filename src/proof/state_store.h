// SPDX-License-Identifier: MIT
// The states found so far: packed markings one after another in segments that never move, and a
// table of 4-byte entries (number of the state, and bits of its hash where there is room) that
// finds them. Lossless: equal hashes are told apart by comparing the states. Numbers are dense
// within segments; a thread fills segments of its own, so that only the table is shared.
#pragma once
#include <atomic>
#include <bit>
#include <cstdint>
#include <cstring>
#include <memory>
#include <vector>

#include "puppetri/base/hash.h"

namespace puppetri::proof {

// Raw memory for tables that are read all over: huge pages where the system offers them, since
// address translation costs as much as the memory itself.
class PageBuffer {
 public:
    PageBuffer() = default;
    // Zeroed if asked for. Gives  an empty buffer when there is no memory.
    PageBuffer(std::uint64_t bytes, bool huge, bool zeroed);
    ~PageBuffer();
    PageBuffer(PageBuffer&& other) noexcept { swap(other); }
    PageBuffer& operator=(PageBuffer&& other) noexcept {
        swap(other);
        return *this;
    }
    std::uint8_t* data() const { return data_; }
    std::uint64_t size() const { return size_; }

 private:
    void swap(PageBuffer& other) noexcept {
        std::swap(data_, other.data_);
        std::swap(size_, other.size_);
    }
    std::uint8_t* data_ = nullptr;
    std::uint64_t size_ = 0;
};

class StateStore {
 public:
    static constexpr std::uint32_t kSegmentBits = 10, kSegment = 1u << kSegmentBits;
    static constexpr std::uint32_t kNoState = ~std::uint32_t{0};

    // States of `bytes` bytes, kept in words of 64 bits while computed with.
    StateStore(std::uint32_t bytes, std::uint32_t words, bool parents);

    // A segment to fill. To be called by one thread at a time.
    // Gives  kNoState when numbers or memory have run out.
    std::uint32_t add_segment();
    std::uint32_t segments() const { return segments_; }
    std::uint64_t bytes() const;
    std::uint32_t state_bytes() const { return bytes_; }

    // kWords: 1, 2, or 0: as many as the store was made for. Reads and writes lie within the own
    // segment, so that neighbours may be written by others at the same time.
    template <unsigned kWords>
    void load(std::uint32_t id, std::uint64_t* out) const {
        const std::uint8_t* at = address(id);
        const std::uint32_t words = kWords != 0 ? kWords : words_;
        for (std::uint32_t w = 0; w + 1 < words; ++w) {
            std::memcpy(out + w, at + 8 * w, 8);
        }
        std::uint64_t last = 0;
        std::memcpy(&last, at + bytes_ - 8, 8);
        out[words - 1] = last >> last_shift_;
    }
    template <unsigned kWords>
    bool equal(std::uint32_t id, const std::uint64_t* state) const {
        const std::uint8_t* at = address(id);
        const std::uint32_t words = kWords != 0 ? kWords : words_;
        std::uint64_t last = 0;
        std::memcpy(&last, at + bytes_ - 8, 8);
        std::uint64_t difference = (last >> last_shift_) ^ state[words - 1];
        for (std::uint32_t w = 0; w + 1 < words; ++w) {
            std::uint64_t word = 0;
            std::memcpy(&word, at + 8 * w, 8);
            difference |= word ^ state[w];
        }
        return difference == 0;
    }
    // Also writes over the states after it, which are to be written later.
    template <unsigned kWords>
    void write(std::uint32_t id, const std::uint64_t* state) {
        std::uint8_t* at = address(id);
        const std::uint32_t words = kWords != 0 ? kWords : words_;
        for (std::uint32_t w = 0; w < words; ++w) {
            std::memcpy(at + 8 * w, state + w, 8);
        }
    }
    void prefetch(std::uint32_t id) const { __builtin_prefetch(address(id)); }
    std::uint32_t& parent(std::uint32_t id) const {
        return parents_at_[id >> kBlockBits][id & (kBlock - 1)];
    }
    bool has_parents() const { return with_parents_; }
    // Gives back the memory of whole blocks before this state: who moves states calls it.
    void drop_before(std::uint32_t id);

 private:
    static constexpr std::uint32_t kBlockBits = 20, kBlock = 1u << kBlockBits;
    static constexpr std::uint32_t kSegmentsPerBlock = kBlock / kSegment;
    static constexpr std::uint32_t kPad = 8;

    std::uint8_t* address(std::uint32_t id) const {
        const std::uint32_t segment = (id >> kSegmentBits) & (kSegmentsPerBlock - 1);
        return at_[id >> kBlockBits] + std::uint64_t{segment} * segment_bytes_ +
               std::uint64_t{id & (kSegment - 1)} * bytes_;
    }

    std::uint32_t bytes_, words_, last_shift_;
    std::uint64_t segment_bytes_;
    bool with_parents_;
    std::uint32_t segments_ = 0;
    std::vector<PageBuffer> blocks_, parents_;
    // First states, and parents, of the blocks; these arrays never move.
    std::unique_ptr<std::uint8_t*[]> at_;
    std::unique_ptr<std::uint32_t*[]> parents_at_;
};

// Open addressing, linear probing, any number of entries.
class StateIndex {
 public:
    explicit StateIndex(std::uint32_t entries = 4096) { make(entries); }

    // So many states may be in it.
    std::uint32_t limit() const { return limit_; }
    std::uint32_t entries() const { return entries_; }
    std::uint64_t bytes() const { return std::uint64_t{entries_} * 4; }
    // For a larger table: the next size. Then everything is to be inserted again.
    static std::uint32_t entries_for(std::uint32_t entries, std::uint64_t states);
    // Gives  false when there is no memory; then the table is empty.
    bool make(std::uint32_t entries) { return make(entries, true); }
    // The same but for clear_slice(i) of all slices, which several threads may share.
    bool make_unclear(std::uint32_t entries) { return make(entries, false); }
    static constexpr std::uint32_t kSlice = 1u << 18;  // entries
    std::uint32_t slices() const { return (entries_ + kSlice - 1) / kSlice; }
    void clear_slice(std::uint32_t slice);

    std::uint32_t home(std::uint64_t hash) const {
        return static_cast<std::uint32_t>(((hash >> 32) * entries_) >> 32);
    }
    std::uint32_t tag(std::uint64_t hash) const {
        return static_cast<std::uint32_t>(hash) & ~id_mask_;
    }
    std::uint32_t id_mask() const { return id_mask_; }
    std::uint32_t next(std::uint32_t at) const { return at + 1 == entries_ ? 0 : at + 1; }
    std::atomic<std::uint32_t>& slot(std::uint32_t at) const { return slots_[at]; }
    void prefetch(std::uint64_t hash) const { __builtin_prefetch(&slots_[home(hash)]); }

    // Inserts a state that is not there. With kShared several threads may do so.
    template <bool kShared>
    void add(std::uint64_t hash, std::uint32_t id) {
        const std::uint32_t entry = tag(hash) | (id + 1);
        for (std::uint32_t at = home(hash);; at = next(at)) {
            std::uint32_t empty = 0;
            if constexpr (kShared) {
                if (slots_[at].compare_exchange_strong(empty, entry, std::memory_order_relaxed)) {
                    return;
                }
            } else if (slots_[at].load(std::memory_order_relaxed) == empty) {
                slots_[at].store(entry, std::memory_order_relaxed);
                return;
            }
        }
    }

 private:
    bool make(std::uint32_t entries, bool clear);
    PageBuffer memory_;
    std::atomic<std::uint32_t>* slots_ = nullptr;
    std::uint32_t entries_ = 0, limit_ = 0, id_mask_ = 0;
};

template <unsigned kWords>
inline std::uint64_t hash_of(const std::uint64_t* state, std::uint32_t words) {
    if (kWords == 1 || (kWords == 0 && words == 1)) {
        return mix64(state[0] + 0x9E3779B97F4A7C15u);
    }
    std::uint64_t h = 0x9E3779B97F4A7C15u;
    const std::uint32_t count = kWords != 0 ? kWords : words;
    for (std::uint32_t w = 0; w < count; ++w) {
        h = (std::rotl(h, 23) ^ state[w]) * 0xBF58476D1CE4E5B9u;
        h ^= h >> 32;
    }
    return mix64(h);
}

}  // namespace puppetri::proof
