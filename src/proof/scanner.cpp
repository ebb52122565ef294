// SPDX-License-Identifier: MIT
// Builds the tables of the scanner: cuts the state into pieces of a few bits, and says for each
// value of a piece which transitions it lets through.
#include "scanner.h"

#include <algorithm>

namespace puppetri::proof {

namespace {

constexpr std::uint64_t kHotBytes = 40'000;  // tables that stay in a first-level cache
constexpr std::uint32_t kMostWordsInRows = 16;
constexpr std::uint64_t kNoRoom = kUnknownBound - 1;          // not even where the place is empty
constexpr std::uint32_t kWidestPiece = 8, kWidestField = 10;  // bits

std::uint64_t mask_of(std::uint32_t bits) { return (std::uint64_t{1} << bits) - 1; }

}  // namespace

Scanner::Scanner(const PlainNet& net, const Packing& packing) {
    words_ = std::max(1u, (net.transition_count() + 63) / 64);
    rows_per_set_ = packing.grows ? 2 : 1;
    sparse_ = words_ * rows_per_set_ > kMostWordsInRows;
    collect_demands(net, packing);
    place_implied(packing);
    weigh_sums(packing);
    stride_ = (sparse_ ? 0 : words_ * rows_per_set_) + sums_;
    base_.assign(words_ * rows_per_set_, 0);
    for (std::uint32_t set = 0; set < rows_per_set_; ++set) {
        for (std::uint32_t t = 0; t < net.transition_count(); ++t) {
            base_[set * words_ + t / 64] |= std::uint64_t{1} << (t & 63);
        }
    }
    for (std::uint32_t p = 0; p < net.place_count(); ++p) {
        if (where_[p].kind != Where::Kind::kConstant) {
            continue;
        }
        for (const Demand& d : demands_[p]) {
            if (where_[p].constant < d.at_least || where_[p].constant >= d.below) {
                base_[d.transition / 64] &= ~(std::uint64_t{1} << (d.transition & 63));
            }
        }
    }
    list_starts_ = {0};
    make_pieces(packing);
    demands_.clear();
    weight_.clear();
}

void Scanner::collect_demands(const PlainNet& net, const Packing& packing) {
    demands_.resize(net.place_count());
    for (std::uint32_t t = 0; t < net.transition_count(); ++t) {
        const auto of = [&](std::uint32_t p) -> Demand& {
            std::vector<Demand>& list = demands_[p];
            if (list.empty() || list.back().transition != t) {
                list.push_back({});
                list.back().transition = t;
            }
            return list.back();
        };
        for (const net::Rows<net::Weighted>* rows : {&net.takes, &net.reads}) {
            for (const net::Weighted& w : rows->row(t)) {
                Demand& d = of(w.place);
                d.at_least = std::max<std::uint64_t>(d.at_least, w.weight);
            }
        }
        for (const net::Weighted& w : net.unless.row(t)) {
            Demand& d = of(w.place);
            d.below = std::min<std::uint64_t>(d.below, w.weight);
        }
        for (const net::Weighted& w : net.gives.row(t)) {
            const std::uint64_t most = packing.room[w.place];
            if (most == kUnknownBound) {
                continue;
            }
            std::uint64_t taken = 0;
            for (const net::Weighted& v : net.takes.row(t)) {
                taken = v.place == w.place ? v.weight : taken;
            }
            if (w.weight > taken) {
                const std::uint64_t gain = w.weight - taken;
                of(w.place).room_up_to = most >= gain ? most - gain : kNoRoom;
            }
        }
    }
}

// Implied places lie side by side in sums of their own.
void Scanner::place_implied(const Packing& packing) {
    where_.resize(packing.item_of.size());
    std::uint32_t word = 0, used = 64;
    for (const Packing::Implied& i : packing.implied) {
        Where& w = where_[i.place];
        if (i.terms.empty()) {
            w.constant = static_cast<std::uint32_t>(i.constant);
            continue;
        }
        if (used + i.bits > 64) {
            ++word;
            used = 0;
        }
        w.kind = Where::Kind::kSum;
        w.word = word;
        w.holder = {i.place, used, mask_of(i.bits), false, 0};
        used += i.bits;
    }
    sums_ = word + 1;
    for (const Packing::Item& item : packing.items) {
        for (std::size_t m = 0; m < item.places.size(); ++m) {
            Where& w = where_[item.places[m]];
            w.kind = Where::Kind::kState;
            w.word = item.word;
            w.holder = {item.places[m], item.shift, item.mask(), item.group,
                        item.group ? m + item.first_code : 0};
        }
    }
}

// What one token of a place with an item adds to each sum, modulo 2^64. The fields of a sum end as
// the counts of implied places, which are in range: what wraps on the way does not matter.
void Scanner::weigh_sums(const Packing& packing) {
    sum_base_.assign(sums_, 0);
    weight_.assign(where_.size(), {});
    for (std::uint32_t p = 0; p < where_.size(); ++p) {
        if (where_[p].kind == Where::Kind::kState) {
            weight_[p].assign(sums_, 0);
            weight_[p][0] = 1;
        } else if (where_[p].kind == Where::Kind::kConstant) {
            sum_base_[0] += where_[p].constant;
        }
    }
    for (const Packing::Implied& i : packing.implied) {
        const Where& w = where_[i.place];
        if (w.kind != Where::Kind::kSum) {
            continue;
        }
        const std::uint64_t unit = std::uint64_t{1} << w.holder.shift;
        const auto constant = static_cast<std::uint64_t>(i.constant);
        sum_base_[w.word] += constant * unit;
        sum_base_[0] += constant;
        for (const auto& [q, factor] : i.terms) {
            const auto f = static_cast<std::uint64_t>(factor);
            weight_[q][w.word] -= f * unit;
            weight_[q][0] -= f;
        }
    }
}

void Scanner::make_pieces(const Packing& packing) {
    struct Run {
        std::uint32_t word, shift, bits;
        std::vector<Holder> holders;
        bool wide;
    };
    const auto cut = [&](std::uint32_t widest) {
        std::vector<Run> runs;
        for (const Packing::Item& item : packing.items) {
            const bool wide = !item.group && item.bits > kWidestField;
            Run* last = runs.empty() ? nullptr : &runs.back();
            if (last == nullptr || wide || last->wide || last->word != item.word ||
                last->shift + last->bits != item.shift || last->bits + item.bits > widest) {
                runs.push_back({item.word, item.shift, 0, {}, wide});
                last = &runs.back();
            }
            for (const std::uint32_t p : item.places) {
                Holder h = where_[p].holder;
                h.shift -= last->shift;
                last->holders.push_back(h);
            }
            last->bits += item.bits;
        }
        return runs;
    };
    std::vector<Run> runs;
    for (std::uint32_t widest = kWidestPiece; widest >= 1; --widest) {
        runs = cut(widest);
        std::uint64_t rows = 0;
        for (const Run& run : runs) {
            rows += run.wide ? 4 : std::uint64_t{1} << run.bits;
        }
        if (rows * stride_ * sizeof(std::uint64_t) <= kHotBytes) {
            break;
        }
    }
    for (const Run& run : runs) {
        add_piece(pieces_, run.holders, run.word, run.shift, run.bits, run.wide, true);
    }
    for (const Packing::Implied& i : packing.implied) {
        const Where& w = where_[i.place];
        if (w.kind == Where::Kind::kSum) {
            Holder h = w.holder;
            h.shift = 0;
            add_piece(implied_pieces_, {&h, 1}, w.word, w.holder.shift, i.bits,
                      i.bits > kWidestField, false);
        }
    }
}

void Scanner::add_piece(std::vector<Piece>& pieces, std::span<const Holder> holders,
                        std::uint32_t word, std::uint32_t shift, std::uint32_t bits, bool wide,
                        bool adds) {
    Piece piece;
    piece.word = word;
    piece.shift = shift;
    piece.mask = mask_of(bits);
    piece.rows = static_cast<std::uint32_t>(rows_.size() / stride_);
    piece.first = static_cast<std::uint32_t>(holders_.size());
    piece.count = static_cast<std::uint32_t>(holders.size());
    piece.wide = wide;
    holders_.insert(holders_.end(), holders.begin(), holders.end());
    if (!wide) {
        piece.seen = seen_;
        seen_ += 1u << bits;
        for (std::uint64_t value = 0; value <= piece.mask; ++value) {
            fill_row(piece, value, adds);
        }
        pieces.push_back(piece);
        return;
    }
    piece.seen = wide_++;
    const std::uint32_t place = holders[0].place;
    factors_.resize(std::uint64_t{wide_} * sums_, 0);
    if (adds) {
        std::copy(weight_[place].begin(), weight_[place].end(),
                  factors_.end() - static_cast<std::ptrdiff_t>(sums_));
    }
    std::vector<std::uint64_t> limits;
    for (const Demand& d : demands_[place]) {
        limits.insert(limits.end(), {d.at_least, d.below});
        if (d.room_up_to < kNoRoom) {
            limits.push_back(d.room_up_to + 1);
        }
    }
    std::sort(limits.begin(), limits.end());
    limits.erase(std::unique(limits.begin(), limits.end()), limits.end());
    std::erase_if(limits, [&](std::uint64_t l) { return l == 0 || l > piece.mask; });
    piece.thresholds = static_cast<std::uint32_t>(thresholds_.size());
    piece.threshold_count = static_cast<std::uint32_t>(limits.size());
    thresholds_.insert(thresholds_.end(), limits.begin(), limits.end());
    fill_row(piece, 0, false);
    for (const std::uint64_t l : limits) {
        fill_row(piece, l, false);
    }
    pieces.push_back(piece);
}

void Scanner::fill_row(const Piece& piece, std::uint64_t value, bool adds) {
    const std::uint32_t words = words_ * rows_per_set_;
    std::vector<std::uint64_t> set(words, ~std::uint64_t{0});
    std::vector<std::uint64_t> sum(sums_, 0);
    for (std::uint32_t i = piece.first; i < piece.first + piece.count; ++i) {
        const Holder& h = holders_[i];
        const std::uint64_t tokens = piece.wide ? value : h.tokens(value);
        for (const Demand& d : demands_[h.place]) {
            const std::uint64_t bit = std::uint64_t{1} << (d.transition & 63);
            if (tokens < d.at_least || tokens >= d.below) {
                set[d.transition / 64] &= ~bit;
            }
            // Not at all, or not with so many here.
            if (d.room_up_to == kNoRoom || tokens > d.room_up_to) {
                set[words_ + d.transition / 64] &= ~bit;
            }
        }
        if (adds) {
            for (std::uint32_t s = 0; s < sums_; ++s) {
                sum[s] += tokens * weight_[h.place][s];
            }
        }
    }
    if (sparse_) {
        for (std::uint32_t w = 0; w < words; ++w) {
            if (set[w] != ~std::uint64_t{0}) {
                lists_.push_back({w, set[w]});
            }
        }
        list_starts_.push_back(static_cast<std::uint32_t>(lists_.size()));
    } else {
        rows_.insert(rows_.end(), set.begin(), set.end());
    }
    rows_.insert(rows_.end(), sum.begin(), sum.end());
}

Scanner::Sight Scanner::make_sight() const {
    Sight sight;
    sight.enabled.assign(words_ * rows_per_set_, 0);
    sight.sums.assign(sums_, 0);
    sight.seen.assign(seen_, 0);
    sight.most.assign(wide_, 0);
    return sight;
}

std::uint32_t Scanner::tokens(const std::uint64_t* state, const Sight& sight,
                              std::uint32_t place) const {
    const Where& w = where_[place];
    switch (w.kind) {
        case Where::Kind::kState:
            return w.holder.tokens(state[w.word]);
        case Where::Kind::kSum:
            return w.holder.tokens(sight.sums[w.word]);
        case Where::Kind::kConstant:
            break;
    }
    return w.constant;
}

void Scanner::raise_bounds(const Sight& sight, std::span<std::uint32_t> bounds) const {
    for (std::uint32_t p = 0; p < where_.size(); ++p) {
        if (where_[p].kind == Where::Kind::kConstant) {
            bounds[p] = std::max(bounds[p], where_[p].constant);
        }
    }
    for (const std::vector<Piece>* pieces : {&pieces_, &implied_pieces_}) {
        for (const Piece& piece : *pieces) {
            for (std::uint32_t i = piece.first; i < piece.first + piece.count; ++i) {
                const Holder& h = holders_[i];
                std::uint32_t& bound = bounds[h.place];
                if (piece.wide) {
                    bound = std::max(bound, static_cast<std::uint32_t>(sight.most[piece.seen]));
                    continue;
                }
                for (std::uint64_t value = 0; value <= piece.mask; ++value) {
                    if (sight.seen[piece.seen + value] != 0) {
                        bound = std::max(bound, h.tokens(value));
                    }
                }
            }
        }
    }
}

std::uint64_t Scanner::bytes() const {
    return rows_.size() * sizeof(std::uint64_t) + lists_.size() * sizeof(Entry) +
           list_starts_.size() * sizeof(std::uint32_t);
}

}  // namespace puppetri::proof
