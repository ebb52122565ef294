// SPDX-License-Identifier: MIT
// A marking in few bits. Three forms: a field of its own; one code for a group of places of which
// at most one is marked (a semiflow of total 1 says so); nothing at all for a place that an
// invariant computes from the others. All three are linear in the marking: a firing is one addition
// per 64-bit word, without looking at fields.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "few_semiflows.h"
#include "puppetri/proof/plain_net.h"

namespace puppetri::proof {

inline constexpr std::uint64_t kUnknownBound = ~std::uint64_t{0};

struct Packing {
    // Some bits of a word: a field with the tokens of one place, or the code of a group.
    struct Item {
        std::uint32_t word = 0;
        std::uint32_t shift = 0, bits = 0;
        // Of a field: one place. Of a group: members in order of their codes, which begin at
        // `first_code`; code 0 below it means that none is marked.
        std::vector<std::uint32_t> places;
        bool group = false;
        std::uint32_t first_code = 0;
        // No invariant bounds the field: it may have to grow.
        bool may_grow = false;
        std::uint64_t mask() const { return (std::uint64_t{1} << bits) - 1; }
    };
    // sign * (constant - sum of factor * tokens(place)); places that have an item.
    struct Implied {
        std::uint32_t place = 0;
        std::int64_t constant = 0;
        std::vector<std::pair<std::uint32_t, std::int64_t>> terms;
        std::uint32_t bits = 0;  // that its tokens need in a computation
        bool may_grow = false;
    };
    std::vector<Item> items;  // in order of words and shifts
    std::vector<Implied> implied;
    std::vector<std::uint32_t> bits_of;  // per place, of its counts
    std::vector<std::uint32_t> item_of;  // per place; kNone: implied or never marked
    static constexpr std::uint32_t kNone = ~std::uint32_t{0};
    std::uint32_t bits = 0;   // of a state
    std::uint32_t words = 1;  // of 64 bits, in computing
    std::uint32_t bytes = 1;  // in storing
    bool grows = false;       // something may grow
    // The most tokens that fit where a place may grow; kUnknownBound where that cannot happen.
    std::vector<std::uint64_t> room;

    // Needs  a marking within the bounds. Implied places are not looked at.
    void encode(std::span<const std::uint32_t> marking, std::span<std::uint64_t> packed) const;
    void decode(std::span<const std::uint64_t> packed, std::span<std::uint32_t> marking) const;
    // What firing a transition adds to each word, modulo 2^64.
    std::vector<std::uint64_t> change(const PlainNet& net, std::uint32_t transition) const;
};

// Needs  semiflows of the net; for places that none bounds, `guessed` tokens are provided for at
//        least. (Others get what the invariants say.)
Packing make_packing(const PlainNet& net, std::span<const Semiflow> semiflows,
                     std::span<const std::uint32_t> guessed);

// The most tokens of each place that the semiflows allow; kUnknownBound where they say nothing.
std::vector<std::uint64_t> bounds_of(const PlainNet& net, std::span<const Semiflow> semiflows);

}  // namespace puppetri::proof
