// SPDX-License-Identifier: MIT
// Which place gets which bits. Groups are chosen greedily by the bits that they save; invariants
// replace places only where that makes states shorter than the word that they would fill anyway.
#include "packing.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <optional>

#include "puppetri/base/require.h"
#include "puppetri/proof/semiflows.h"

namespace puppetri::proof {

namespace {

constexpr std::uint32_t kMostForBasis = 2000;  // places: elimination is cubic
constexpr double kBasis_s = 0.3;
constexpr std::uint32_t kGoodEnough = 56;  // bits: shorter states are not worth computed places

std::uint32_t bits_for(std::uint64_t largest) {
    return static_cast<std::uint32_t>(std::bit_width(largest));
}

class Planner {
 public:
    Planner(const PlainNet& net, std::span<const Semiflow> semiflows,
            std::span<const std::uint32_t> guessed)
        : net_(net), semiflows_(semiflows), bound_(bounds_of(net, semiflows)) {
        const std::uint32_t places = net.place_count();
        out_.bits_of.assign(places, 0);
        out_.item_of.assign(places, Packing::kNone);
        may_grow_.assign(places, false);
        taken_.assign(places, false);
        find_changing();
        for (std::uint32_t p = 0; p < places; ++p) {
            if (!changes_[p]) {
                bound_[p] = net.initial[p];
                if (bound_[p] > 0) {
                    taken_[p] = true;
                    out_.implied.push_back({p, net.initial[p], {}, bits_for(bound_[p])});
                }
            } else if (bound_[p] > std::numeric_limits<std::uint32_t>::max()) {
                may_grow_[p] = true;
                bound_[p] = std::max({guessed[p], net.initial[p], 1u});
            }
            out_.bits_of[p] = bits_for(bound_[p]);
        }
    }

    Packing run() {
        choose_groups();
        imply();
        lay_out();
        return std::move(out_);
    }

 private:
    // Places that some transition fills or empties.
    void find_changing() {
        changes_.assign(net_.place_count(), false);
        std::vector<std::int64_t> effect(net_.place_count(), 0);
        for (std::uint32_t t = 0; t < net_.transition_count(); ++t) {
            const auto gives = net_.gives.row(t), takes = net_.takes.row(t);
            for (const net::Weighted& w : gives) {
                effect[w.place] += w.weight;
            }
            for (const net::Weighted& w : takes) {
                effect[w.place] -= w.weight;
            }
            for (const auto& row : {gives, takes}) {
                for (const net::Weighted& w : row) {
                    changes_[w.place] = changes_[w.place] || effect[w.place] != 0;
                }
            }
            for (const auto& row : {gives, takes}) {
                for (const net::Weighted& w : row) {
                    effect[w.place] = 0;
                }
            }
        }
    }

    bool free_for_group(std::uint32_t p) const { return !taken_[p] && bound_[p] == 1; }

    // Members of a total-1 semiflow that no group has yet, and whether they are all that can be
    // marked.
    std::vector<std::uint32_t> members(const Semiflow& flow, bool& all) const {
        std::vector<std::uint32_t> list;
        all = true;
        for (const auto& [p, weight] : flow.terms) {
            if (free_for_group(p)) {
                list.push_back(p);
            } else {
                all = all && bound_[p] == 0;
            }
        }
        return list;
    }

    void choose_groups() {
        std::vector<const Semiflow*> candidates;
        for (const Semiflow& flow : semiflows_) {
            if (flow.total == 1) {
                candidates.push_back(&flow);
            }
        }
        while (true) {
            std::int64_t best = 0;
            std::vector<std::uint32_t> chosen;
            bool chosen_all = false;
            std::erase_if(candidates, [&](const Semiflow* flow) {
                bool all = false;
                std::vector<std::uint32_t> list = members(*flow, all);
                const auto count = static_cast<std::uint32_t>(list.size());
                const std::int64_t saved =
                    count < 2 ? 0 : std::int64_t{count} - bits_for(all ? count - 1 : count);
                if (saved > best) {
                    best = saved;
                    chosen = std::move(list);
                    chosen_all = all;
                }
                return saved <= 0;  // can only become less
            });
            if (best == 0) {
                return;
            }
            Packing::Item item;
            item.group = true;
            item.first_code = chosen_all ? 0 : 1;
            item.bits = bits_for(chosen.size() - (chosen_all ? 1 : 0));
            for (const std::uint32_t p : chosen) {
                taken_[p] = true;
            }
            item.places = std::move(chosen);
            out_.items.push_back(std::move(item));
        }
    }

    std::uint32_t total_bits() const {
        std::uint32_t total = 0;
        for (const Packing::Item& item : out_.items) {
            total += item.bits;
        }
        for (std::uint32_t p = 0; p < net_.place_count(); ++p) {
            total += taken_[p] ? 0 : out_.bits_of[p];
        }
        return total;
    }

    // Gaussian elimination with invariants as rows: each makes one place, of weight 1 or -1 there,
    // a linear function of the rest. First the semiflows, then, if that is not enough, invariants
    // with signs, which say nothing of bounds but compute places as well.
    void imply() {
        total_ = total_bits();
        implied_at_.assign(net_.place_count(), Packing::kNone);
        for (std::uint32_t i = 0; i < out_.implied.size(); ++i) {
            implied_at_[out_.implied[i].place] = i;
        }
        for (const Semiflow& flow : semiflows_) {
            imply_by(flow.terms, static_cast<std::int64_t>(flow.total));
        }
        if (total_ <= kGoodEnough || net_.place_count() > kMostForBasis) {
            return;
        }
        Budget budget;
        budget.seconds = kBasis_s;
        for (const Flow& flow : place_flow_basis(net_, budget).flows) {
            const std::optional<std::int64_t> constant = weighted_tokens(flow, net_.initial);
            Terms terms;
            for (const Flow::Term& t : flow.terms) {
                terms.emplace_back(t.index, t.factor);
            }
            if (constant && std::all_of(terms.begin(), terms.end(),
                                        [](const auto& t) { return small(t.second); })) {
                imply_by(terms, *constant);
            }
        }
    }

    void imply_by(std::span<const std::pair<std::uint32_t, std::int64_t>> terms,
                  std::int64_t constant) {
        if (total_ <= kGoodEnough) {
            return;
        }
        const std::optional<Terms> rest = substituted(terms, constant);
        if (!rest) {
            return;
        }
        std::uint32_t best = Packing::kNone;
        std::int64_t factor = 0;
        for (const auto& [p, f] : *rest) {
            if ((f == 1 || f == -1) && !taken_[p] && out_.bits_of[p] > 0 &&
                (best == Packing::kNone || out_.bits_of[p] > out_.bits_of[best])) {
                best = p;
                factor = f;
            }
        }
        if (best == Packing::kNone) {
            return;
        }
        Packing::Implied made;
        made.place = best;
        made.constant = constant * factor;
        made.bits = out_.bits_of[best];
        made.may_grow = may_grow_[best];
        for (const auto& [p, f] : *rest) {
            if (p != best) {
                made.terms.emplace_back(p, f * factor);
            }
        }
        if (!substitute_into_earlier(made)) {
            return;
        }
        taken_[best] = true;
        total_ -= out_.bits_of[best];
        implied_at_[best] = static_cast<std::uint32_t>(out_.implied.size());
        out_.implied.push_back(std::move(made));
    }

    using Terms = std::vector<std::pair<std::uint32_t, std::int64_t>>;
    static constexpr std::int64_t kLargest = std::int64_t{1} << 30;

    static void add(Terms& terms, std::uint32_t place, std::int64_t factor) {
        const auto it = std::lower_bound(terms.begin(), terms.end(), std::pair{place, INT64_MIN});
        if (it != terms.end() && it->first == place) {
            it->second += factor;
            if (it->second == 0) {
                terms.erase(it);
            }
        } else if (factor != 0) {
            terms.insert(it, {place, factor});
        }
    }

    static bool small(std::int64_t x) { return x <= kLargest && x >= -kLargest; }

    // The invariant over places that are not implied, without those that are never marked.
    std::optional<Terms> substituted(std::span<const std::pair<std::uint32_t, std::int64_t>> terms,
                                     std::int64_t& constant) const {
        Terms rest;
        if (!small(constant)) {
            return std::nullopt;
        }
        for (const auto& [p, weight] : terms) {
            if (bound_[p] == 0) {
                continue;
            }
            if (implied_at_[p] == Packing::kNone) {
                add(rest, p, weight);
                continue;
            }
            const Packing::Implied& known = out_.implied[implied_at_[p]];
            constant -= weight * known.constant;
            for (const auto& [q, f] : known.terms) {
                add(rest, q, -weight * f);
            }
            if (!small(constant) || !std::all_of(rest.begin(), rest.end(),
                                                 [](const auto& t) { return small(t.second); })) {
                return std::nullopt;
            }
        }
        return rest;
    }

    // Gives  false, and nothing is changed, if a number would become too large.
    bool substitute_into_earlier(const Packing::Implied& made) {
        std::vector<Packing::Implied> changed = out_.implied;
        for (Packing::Implied& known : changed) {
            const auto it = std::lower_bound(known.terms.begin(), known.terms.end(),
                                             std::pair{made.place, INT64_MIN});
            if (it == known.terms.end() || it->first != made.place) {
                continue;
            }
            const std::int64_t f = it->second;
            known.terms.erase(it);
            known.constant -= f * made.constant;
            for (const auto& [q, g] : made.terms) {
                add(known.terms, q, -f * g);
            }
            if (!small(known.constant) ||
                !std::all_of(known.terms.begin(), known.terms.end(),
                             [](const auto& t) { return small(t.second); })) {
                return false;
            }
        }
        out_.implied = std::move(changed);
        return true;
    }

    void lay_out() {
        for (std::uint32_t p = 0; p < net_.place_count(); ++p) {
            if (!taken_[p] && out_.bits_of[p] > 0) {
                Packing::Item item;
                item.bits = out_.bits_of[p];
                item.places = {p};
                item.may_grow = may_grow_[p];
                out_.items.push_back(std::move(item));
            }
        }
        out_.room.assign(net_.place_count(), kUnknownBound);
        for (std::uint32_t p = 0; p < net_.place_count(); ++p) {
            if (may_grow_[p]) {
                out_.room[p] = (std::uint64_t{1} << out_.bits_of[p]) - 1;
                out_.grows = true;
            }
        }
        // Few gaps: the widest first into the first word with room.
        std::stable_sort(out_.items.begin(), out_.items.end(),
                         [](const auto& a, const auto& b) { return a.bits > b.bits; });
        std::vector<std::uint32_t> used;
        std::uint32_t first_open = 0;
        for (Packing::Item& item : out_.items) {
            while (first_open < used.size() && used[first_open] == 64) {
                ++first_open;
            }
            std::uint32_t word = first_open;
            while (word < used.size() && used[word] + item.bits > 64) {
                ++word;
            }
            if (word == used.size()) {
                used.push_back(0);
            }
            item.word = word;
            item.shift = used[word];
            used[word] += item.bits;
        }
        std::stable_sort(out_.items.begin(), out_.items.end(), [](const auto& a, const auto& b) {
            return a.word != b.word ? a.word < b.word : a.shift < b.shift;
        });
        for (std::uint32_t i = 0; i < out_.items.size(); ++i) {
            for (const std::uint32_t p : out_.items[i].places) {
                out_.item_of[p] = i;
            }
        }
        if (!used.empty()) {
            out_.words = static_cast<std::uint32_t>(used.size());
            out_.bits = 64 * (out_.words - 1) + used.back();
            out_.bytes = std::max(1u, (out_.bits + 7) / 8);
        }
    }

    const PlainNet& net_;
    std::span<const Semiflow> semiflows_;
    std::vector<std::uint64_t> bound_;
    std::vector<bool> may_grow_, taken_, changes_;
    std::vector<std::uint32_t> implied_at_;
    std::uint32_t total_ = 0;
    Packing out_;
};

// What one token of a place adds to the item's bits.
std::uint64_t weight_of(const Packing::Item& item, std::uint32_t place) {
    if (!item.group) {
        return std::uint64_t{1} << item.shift;
    }
    const auto it = std::find(item.places.begin(), item.places.end(), place);
    const auto code = static_cast<std::uint64_t>(it - item.places.begin()) + item.first_code;
    return code << item.shift;
}

}  // namespace

std::vector<std::uint64_t> bounds_of(const PlainNet& net, std::span<const Semiflow> semiflows) {
    std::vector<std::uint64_t> bounds(net.place_count(), kUnknownBound);
    for (const Semiflow& flow : semiflows) {
        for (const auto& [p, weight] : flow.terms) {
            bounds[p] = std::min(bounds[p], flow.total / static_cast<std::uint64_t>(weight));
        }
    }
    return bounds;
}

Packing make_packing(const PlainNet& net, std::span<const Semiflow> semiflows,
                     std::span<const std::uint32_t> guessed) {
    PUP_REQUIRE(guessed.size() == net.place_count());
    return Planner(net, semiflows, guessed).run();
}

void Packing::encode(std::span<const std::uint32_t> marking,
                     std::span<std::uint64_t> packed) const {
    std::fill(packed.begin(), packed.end(), 0);
    for (const Item& item : items) {
        if (!item.group) {
            packed[item.word] |= std::uint64_t{marking[item.places[0]]} << item.shift;
            continue;
        }
        for (std::size_t i = 0; i < item.places.size(); ++i) {
            if (marking[item.places[i]] != 0) {
                packed[item.word] |= (std::uint64_t{i} + item.first_code) << item.shift;
            }
        }
    }
}

void Packing::decode(std::span<const std::uint64_t> packed,
                     std::span<std::uint32_t> marking) const {
    std::fill(marking.begin(), marking.end(), 0);
    for (const Item& item : items) {
        const std::uint64_t value = (packed[item.word] >> item.shift) & item.mask();
        if (!item.group) {
            marking[item.places[0]] = static_cast<std::uint32_t>(value);
        } else if (value >= item.first_code && value - item.first_code < item.places.size()) {
            marking[item.places[value - item.first_code]] = 1;
        }
    }
    for (const Implied& i : implied) {
        std::int64_t value = i.constant;
        for (const auto& [p, factor] : i.terms) {
            value -= factor * std::int64_t{marking[p]};
        }
        marking[i.place] = static_cast<std::uint32_t>(value);
    }
}

std::vector<std::uint64_t> Packing::change(const PlainNet& net, std::uint32_t transition) const {
    std::vector<std::uint64_t> delta(words, 0);
    const auto add = [&](const net::Weighted& w, bool gives) {
        const std::uint32_t i = item_of[w.place];
        if (i != kNone) {
            const std::uint64_t by = weight_of(items[i], w.place) * w.weight;
            delta[items[i].word] += gives ? by : ~by + 1;
        }
    };
    for (const net::Weighted& w : net.gives.row(transition)) {
        add(w, true);
    }
    for (const net::Weighted& w : net.takes.row(transition)) {
        add(w, false);
    }
    return delta;
}

}  // namespace puppetri::proof
