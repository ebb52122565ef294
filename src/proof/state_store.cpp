// SPDX-License-Identifier: MIT
// Memory of the state store.
#include "state_store.h"

#include <algorithm>
#include <cstdlib>
#include <limits>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace puppetri::proof {

namespace {

constexpr std::uint64_t kHugePage = std::uint64_t{2} << 20;
constexpr std::uint64_t kHugeFrom = std::uint64_t{4} << 20;  // bytes worth huge pages
constexpr std::uint32_t kBlocks = 1u << 12;                  // of 2^20 states: all 32-bit numbers
// A table that is fuller makes long searches, one that is emptier costs memory: 4 bytes over the
// load of 0.58 to 0.82 are 4.9 to 6.9 bytes per state.
constexpr double kFullest = 0.82, kGrowth = 1.41;

}  // namespace

PageBuffer::PageBuffer(std::uint64_t bytes, bool huge, bool zeroed) {
    if (bytes > std::numeric_limits<std::size_t>::max() / 2) {
        return;
    }
    const bool large = huge && bytes >= kHugeFrom;
    const std::uint64_t align = large ? kHugePage : 64;
    const std::uint64_t rounded = (bytes + align - 1) / align * align;
    if (zeroed && !large) {
        data_ = static_cast<std::uint8_t*>(std::calloc(1, static_cast<std::size_t>(rounded)));
    } else {
        data_ = static_cast<std::uint8_t*>(
            std::aligned_alloc(static_cast<std::size_t>(align), static_cast<std::size_t>(rounded)));
    }
    if (data_ == nullptr) {
        return;
    }
    size_ = bytes;
#if defined(__linux__) && defined(MADV_HUGEPAGE)
    if (large) {
        madvise(data_, static_cast<std::size_t>(rounded), MADV_HUGEPAGE);
    }
#endif
    if (zeroed && large) {
        std::memset(data_, 0, static_cast<std::size_t>(bytes));
    }
}

PageBuffer::~PageBuffer() { std::free(data_); }

StateStore::StateStore(std::uint32_t bytes, std::uint32_t words, bool parents)
    : bytes_(bytes),
      words_(words),
      last_shift_(64 - 8 * (bytes - 8 * (words - 1))),
      segment_bytes_(std::uint64_t{kSegment} * bytes + 2 * kPad),
      with_parents_(parents),
      at_(std::make_unique<std::uint8_t*[]>(kBlocks)),
      parents_at_(std::make_unique<std::uint32_t*[]>(kBlocks)) {}

std::uint32_t StateStore::add_segment() {
    if (segments_ % kSegmentsPerBlock == 0) {
        const std::size_t block = segments_ / kSegmentsPerBlock;
        if (block + 1 >= kBlocks) {
            return kNoState;
        }
        // The first blocks of a small net are partly untouched, which huge pages would not leave.
        const bool huge = block > 1;
        PageBuffer buffer(segment_bytes_ * kSegmentsPerBlock, huge, false);
        PageBuffer parents;
        if (with_parents_) {
            parents = PageBuffer(std::uint64_t{kBlock} * 4, huge, false);
        }
        if (buffer.data() == nullptr || (with_parents_ && parents.data() == nullptr)) {
            return kNoState;
        }
        at_[block] = buffer.data() + kPad;
        if (with_parents_) {
            parents_at_[block] = reinterpret_cast<std::uint32_t*>(parents.data());
        }
        blocks_.push_back(std::move(buffer));
        parents_.push_back(std::move(parents));
    }
    return segments_++ << kSegmentBits;
}

std::uint64_t StateStore::bytes() const {
    return segments_ * (segment_bytes_ + (with_parents_ ? std::uint64_t{kSegment} * 4 : 0));
}

void StateStore::drop_before(std::uint32_t id) {
    for (std::uint32_t block = 0; block < id >> kBlockBits; ++block) {
        blocks_[block] = PageBuffer();
    }
}

void StateIndex::clear_slice(std::uint32_t slice) {
    const std::uint32_t first = slice * kSlice, count = std::min(kSlice, entries_ - first);
    std::memset(memory_.data() + std::uint64_t{first} * 4, 0, std::size_t{count} * 4);
}

bool StateIndex::make(std::uint32_t entries, bool clear) {
    memory_ = PageBuffer();  // first the old one, then the new one
    PageBuffer fresh(std::uint64_t{entries} * 4, true, clear);
    memory_ = std::move(fresh);
    slots_ = reinterpret_cast<std::atomic<std::uint32_t>*>(memory_.data());
    if (slots_ == nullptr) {
        entries_ = limit_ = 0;
        return false;
    }
    entries_ = entries;
    limit_ = static_cast<std::uint32_t>(entries * kFullest);
    id_mask_ = static_cast<std::uint32_t>((std::uint64_t{1} << std::bit_width(limit_)) - 1);
    return true;
}

std::uint32_t StateIndex::entries_for(std::uint32_t entries, std::uint64_t states) {
    double wanted = entries;
    while (wanted * kFullest < static_cast<double>(states)) {
        wanted *= kGrowth;
    }
    return static_cast<std::uint32_t>(
        std::min(wanted, static_cast<double>(std::numeric_limits<std::uint32_t>::max())));
}

}  // namespace puppetri::proof
