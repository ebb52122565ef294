// SPDX-License-Identifier: MIT
// States as strings of bytes, each once, numbered as they come: one stretch of memory and an open
// hash table of numbers. Lossless: equal is equal byte for byte.
#pragma once
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "puppetri/base/hash.h"

namespace puppetri::proof {

class ByteStore {
 public:
    // The string's number, and whether it is new.
    std::pair<std::uint32_t, bool> insert(std::span<const std::uint8_t> bytes) {
        if (2 * (size() + 1) > table_.size()) {
            grow();
        }
        const std::uint64_t hash = hash_of(bytes);
        std::size_t at = hash & (table_.size() - 1);
        for (; table_[at].number != kNone; at = (at + 1) & (table_.size() - 1)) {
            if (table_[at].tag == static_cast<std::uint32_t>(hash >> 32)) {
                const auto known = (*this)[table_[at].number];
                if (known.size() == bytes.size() &&
                    (bytes.empty() || std::memcmp(known.data(), bytes.data(), bytes.size()) == 0)) {
                    return {table_[at].number, false};
                }
            }
        }
        const std::uint32_t number = size();
        table_[at] = {number, static_cast<std::uint32_t>(hash >> 32)};
        bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
        starts_.push_back(bytes_.size());
        return {number, true};
    }
    std::uint32_t size() const { return static_cast<std::uint32_t>(starts_.size()) - 1; }
    // Good until the next insert.
    std::span<const std::uint8_t> operator[](std::uint32_t number) const {
        return {bytes_.data() + starts_[number],
                static_cast<std::size_t>(starts_[number + 1] - starts_[number])};
    }
    std::uint64_t held() const {
        return bytes_.capacity() + 8 * starts_.capacity() + 8 * table_.capacity();
    }

 private:
    static constexpr std::uint32_t kNone = ~std::uint32_t{0};
    struct Entry {
        std::uint32_t number = kNone, tag = 0;
    };
    static std::uint64_t hash_of(std::span<const std::uint8_t> bytes) {
        return Hash64()
            .add_text({reinterpret_cast<const char*>(bytes.data()), bytes.size()})
            .value();
    }
    void grow() {
        table_.assign(table_.empty() ? 64 : 2 * table_.size(), Entry{});
        for (std::uint32_t i = 0; i < size(); ++i) {
            const std::uint64_t hash = hash_of((*this)[i]);
            std::size_t at = hash & (table_.size() - 1);
            while (table_[at].number != kNone) {
                at = (at + 1) & (table_.size() - 1);
            }
            table_[at] = {i, static_cast<std::uint32_t>(hash >> 32)};
        }
    }

    std::vector<std::uint8_t> bytes_;
    std::vector<std::uint64_t> starts_ = {0};
    std::vector<Entry> table_;
};

}  // namespace puppetri::proof
