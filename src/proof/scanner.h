// SPDX-License-Identifier: MIT
// What a packed marking enables, without unpacking it. Each condition of a transition speaks of one
// place, so a few bits of the state (some places at a time) decide which transitions they forbid:
// a table says so for every value of these bits, and the enabled set is the conjunction of one row
// per piece of the state. Weights, read arcs, inhibitors and the room that a growing field has left
// cost nothing more.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "packing.h"
#include "puppetri/proof/plain_net.h"

namespace puppetri::proof {

class Scanner {
 public:
    Scanner(const PlainNet& net, const Packing& packing);

    // What scan() fills; one per thread.
    struct Sight {
        // A bit per transition: enabled by its arcs. Then, with may_grow(), as many words again:
        // the successor fits into the fields.
        std::vector<std::uint64_t> enabled;
        std::vector<std::uint64_t> sums;  // [0]: all tokens; then what implied places hold
        std::vector<std::uint8_t> seen;   // per piece and value: occurred
        std::vector<std::uint64_t> most;  // per wide field
        std::uint64_t most_tokens = 0;
    };
    Sight make_sight() const;
    std::uint32_t words() const { return words_; }  // of a set of transitions
    bool may_grow() const { return rows_per_set_ == 2; }

    void scan(const std::uint64_t* state, Sight& sight) const {
        switch (rows_per_set_ * words_) {
            case 1:
                return scan_by<1>(state, sight);
            case 2:
                return scan_by<2>(state, sight);
            case 3:
                return scan_by<3>(state, sight);
            case 4:
                return scan_by<4>(state, sight);
            default:
                return scan_by<0>(state, sight);
        }
    }
    // Needs  the sight of the same state.
    std::uint32_t tokens(const std::uint64_t* state, const Sight& sight, std::uint32_t place) const;
    // The most tokens seen in each place; to be raised by this sight.
    void raise_bounds(const Sight& sight, std::span<std::uint32_t> bounds) const;
    std::uint64_t bytes() const;

 private:
    // Some neighbouring bits of a word of the state, or of a sum.
    struct Piece {
        std::uint32_t word = 0, shift = 0;
        std::uint64_t mask = 0;
        std::uint32_t rows = 0;              // where its rows begin, in rows
        std::uint32_t seen = 0;              // in Sight::seen; of wide ones in Sight::most
        std::uint32_t first = 0, count = 0;  // of holders_
        // Wide: a field with too many values for a table; the row is that of the number of
        // thresholds (ascending) up to the value.
        bool wide = false;
        std::uint32_t thresholds = 0, threshold_count = 0;
    };
    // A place whose tokens a piece knows.
    struct Holder {
        std::uint32_t place = 0;
        std::uint32_t shift = 0;
        std::uint64_t mask = 0;
        bool coded = false;  // one token if the bits are `code`, else none
        std::uint64_t code = 0;
        std::uint32_t tokens(std::uint64_t value) const {
            const std::uint64_t bits = (value >> shift) & mask;
            return coded ? (bits == code ? 1u : 0u) : static_cast<std::uint32_t>(bits);
        }
    };
    struct Demand;  // of one transition, of one place
    struct Where {
        enum class Kind : std::uint8_t { kConstant, kState, kSum } kind = Kind::kConstant;
        std::uint32_t word = 0;
        Holder holder;  // with the shift within the word
        std::uint32_t constant = 0;
    };

    template <unsigned kWords>
    void scan_by(const std::uint64_t* state, Sight& sight) const;
    std::uint32_t row_of(const Piece& piece, std::uint64_t value) const {
        std::uint32_t row = 0;
        const std::uint64_t* t = thresholds_.data() + piece.thresholds;
        while (row < piece.threshold_count && t[row] <= value) {
            ++row;
        }
        return row;
    }

    void collect_demands(const PlainNet& net, const Packing& packing);
    void place_implied(const Packing& packing);
    void weigh_sums(const Packing& packing);
    void make_pieces(const Packing& packing);
    void add_piece(std::vector<Piece>& pieces, std::span<const Holder> holders, std::uint32_t word,
                   std::uint32_t shift, std::uint32_t bits, bool wide, bool adds);
    void fill_row(const Piece& piece, std::uint64_t value, bool adds);

    std::uint32_t words_ = 1;         // of a set
    std::uint32_t rows_per_set_ = 1;  // enabled; with growth also: fits
    std::uint32_t sums_ = 1;
    std::uint32_t stride_ = 0;  // of rows_: sets, then what is added to the sums
    bool sparse_ = false;       // sets are in lists_ instead
    std::vector<std::uint64_t> base_, sum_base_;
    std::vector<Piece> pieces_;          // of state words
    std::vector<Piece> implied_pieces_;  // of sums
    std::vector<Holder> holders_;
    std::vector<std::uint64_t> rows_;
    std::vector<std::uint64_t> thresholds_;
    std::vector<std::uint64_t> factors_;  // of wide pieces: what a token adds to each sum
    struct Entry {
        std::uint32_t word = 0;
        std::uint64_t mask = 0;
    };
    std::vector<std::uint32_t> list_starts_;
    std::vector<Entry> lists_;
    std::uint32_t seen_ = 0, wide_ = 0;
    std::vector<Where> where_;                        // per place
    std::vector<std::vector<std::uint64_t>> weight_;  // per place that has an item: of each sum
    std::vector<std::vector<Demand>> demands_;        // per place; only while building
};

// What a transition wants of a place.
struct Scanner::Demand {
    std::uint32_t transition = 0;
    std::uint64_t at_least = 0;
    std::uint64_t below = ~std::uint64_t{0};
    std::uint64_t room_up_to = ~std::uint64_t{0};  // the successor fits up to so many tokens
};

template <unsigned kWords>
inline void Scanner::scan_by(const std::uint64_t* state, Sight& sight) const {
    const std::uint32_t words = kWords != 0 ? kWords : rows_per_set_ * words_;
    const std::uint32_t sums = sums_;
    std::uint64_t* const enabled = sight.enabled.data();
    std::uint64_t* const sum = sight.sums.data();
    std::uint64_t set[kWords != 0 ? kWords : 1];
    if constexpr (kWords != 0) {
        for (unsigned w = 0; w < kWords; ++w) {
            set[w] = base_[w];
        }
    } else {
        for (std::uint32_t w = 0; w < words; ++w) {
            enabled[w] = base_[w];
        }
    }
    for (std::uint32_t s = 0; s < sums; ++s) {
        sum[s] = sum_base_[s];
    }
    const auto apply = [&](const Piece& piece, std::uint64_t value, bool adds) {
        std::uint32_t number = 0;
        if (piece.wide) {
            number = row_of(piece, value);
            if (value > sight.most[piece.seen]) {
                sight.most[piece.seen] = value;
            }
        } else {
            number = static_cast<std::uint32_t>(value);
            sight.seen[piece.seen + number] = 1;
        }
        const std::uint64_t* row = rows_.data() + std::uint64_t{piece.rows + number} * stride_;
        if constexpr (kWords != 0) {
            for (unsigned w = 0; w < kWords; ++w) {
                set[w] &= row[w];
            }
            row += kWords;
        } else if (!sparse_) {
            for (std::uint32_t w = 0; w < words; ++w) {
                enabled[w] &= row[w];
            }
            row += words;
        } else {
            const std::uint32_t r = piece.rows + number;
            for (std::uint32_t i = list_starts_[r]; i < list_starts_[r + 1]; ++i) {
                enabled[lists_[i].word] &= lists_[i].mask;
            }
        }
        if (!adds) {
            return;
        }
        if (piece.wide) {
            const std::uint64_t* factor = factors_.data() + std::uint64_t{piece.seen} * sums;
            for (std::uint32_t s = 0; s < sums; ++s) {
                sum[s] += factor[s] * value;
            }
        } else {
            for (std::uint32_t s = 0; s < sums; ++s) {
                sum[s] += row[s];
            }
        }
    };
    for (const Piece& piece : pieces_) {
        apply(piece, (state[piece.word] >> piece.shift) & piece.mask, true);
    }
    for (const Piece& piece : implied_pieces_) {
        apply(piece, (sum[piece.word] >> piece.shift) & piece.mask, false);
    }
    if constexpr (kWords != 0) {
        for (unsigned w = 0; w < kWords; ++w) {
            enabled[w] = set[w];
        }
    }
    if (sum[0] > sight.most_tokens) {
        sight.most_tokens = sum[0];
    }
}

}  // namespace puppetri::proof
