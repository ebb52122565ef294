// SPDX-License-Identifier: MIT
#include "symbolic_levels.h"

#include <algorithm>

#include "puppetri/base/hash.h"

namespace puppetri::proof {
namespace {

std::uint64_t hash_of(std::span<const std::uint32_t> local) {
    std::uint64_t h = local.size();
    for (const std::uint32_t tokens : local) {
        h = mix64(h ^ tokens) + 0x9E3779B97F4A7C15u;
    }
    return h;
}

}  // namespace

SymbolicLevels::SymbolicLevels(const PlainNet& net, const PlaceGroups& groups) {
    const auto levels = static_cast<std::uint32_t>(groups.size());
    levels_.resize(levels + 1);
    functions_of_level_.resize(levels + 1);
    level_of_.resize(net.place_count());
    slot_of_.resize(net.place_count());
    std::vector<std::uint32_t> local;
    for (std::uint32_t g = 0; g < levels; ++g) {
        Level& level = levels_[levels - g];
        level.places = groups[g];
        level.buckets.resize(4, 0);
        local.clear();
        for (std::uint32_t slot = 0; slot < groups[g].size(); ++slot) {
            level_of_[groups[g][slot]] = levels - g;
            slot_of_[groups[g][slot]] = slot;
            local.push_back(net.initial[groups[g][slot]]);
        }
        number(levels - g, local);
    }

    struct PlacedArc {
        std::uint32_t level;
        LocalArc arc;
    };
    std::vector<PlacedArc> placed;
    events_.resize(net.transition_count());
    for (std::uint32_t t = 0; t < net.transition_count(); ++t) {
        placed.clear();
        const auto at = [&](std::uint32_t place) -> LocalArc& {
            for (PlacedArc& p : placed) {
                if (p.level == level_of_[place] && p.arc.slot == slot_of_[place]) {
                    return p.arc;
                }
            }
            placed.push_back({level_of_[place], {.slot = slot_of_[place]}});
            return placed.back().arc;
        };
        for (const net::Weighted& w : net.takes.row(t)) {
            LocalArc& arc = at(w.place);
            arc.take += w.weight;
            arc.low = std::max(arc.low, arc.take);
        }
        for (const net::Weighted& w : net.reads.row(t)) {
            LocalArc& arc = at(w.place);
            arc.low = std::max(arc.low, w.weight);
        }
        for (const net::Weighted& w : net.unless.row(t)) {
            LocalArc& arc = at(w.place);
            arc.high = std::min(arc.high, w.weight);
        }
        for (const net::Weighted& w : net.gives.row(t)) {
            at(w.place).give += w.weight;
        }
        std::sort(placed.begin(), placed.end(), [](const PlacedArc& a, const PlacedArc& b) {
            return a.level != b.level ? a.level > b.level : a.arc.slot < b.arc.slot;
        });
        for (std::size_t i = 0; i < placed.size();) {
            const std::uint32_t level = placed[i].level;
            std::vector<LocalArc> arcs;
            for (; i < placed.size() && placed[i].level == level; ++i) {
                arcs.push_back(placed[i].arc);
            }
            events_[t].touches.push_back({level, function_of(level, std::move(arcs))});
        }
    }
}

bool SymbolicLevels::weigh(const LinearSum& sum,
                           std::vector<std::vector<std::int64_t>>& weights) const {
    weights.assign(levels_.size(), {});
    for (const LinearSum::Term& term : sum.terms) {
        const std::uint32_t level = level_of_[term.place];
        std::vector<std::int64_t>& row = weights[level];
        row.resize(value_count(level), 0);
        for (std::uint32_t v = 0; v < row.size(); ++v) {
            std::int64_t part = 0;
            if (__builtin_mul_overflow(term.factor, std::int64_t{tokens(term.place, v)}, &part) ||
                __builtin_add_overflow(row[v], part, &row[v])) {
                return false;
            }
        }
    }
    return true;
}

std::uint32_t SymbolicLevels::function_of(std::uint32_t level, std::vector<LocalArc>&& arcs) {
    for (const std::uint32_t f : functions_of_level_[level]) {
        if (functions_[f].arcs == arcs) {
            return f;
        }
    }
    const auto f = static_cast<std::uint32_t>(functions_.size());
    functions_.push_back({level, std::move(arcs), {}, {}});
    functions_of_level_[level].push_back(f);
    return f;
}

std::int32_t SymbolicLevels::find(std::uint32_t level,
                                  std::span<const std::uint32_t> wanted) const {
    const Level& l = levels_[level];
    const std::uint64_t mask = l.buckets.size() - 1;
    for (std::uint64_t b = hash_of(wanted) & mask; l.buckets[b] != 0; b = (b + 1) & mask) {
        const std::span<const std::uint32_t> have = local(level, l.buckets[b] - 1);
        if (std::equal(wanted.begin(), wanted.end(), have.begin())) {
            return static_cast<std::int32_t>(l.buckets[b] - 1);
        }
    }
    return kDisabled;
}

std::uint32_t SymbolicLevels::number(std::uint32_t level, std::span<const std::uint32_t> wanted) {
    if (const std::int32_t found = find(level, wanted); found >= 0) {
        return static_cast<std::uint32_t>(found);
    }
    Level& l = levels_[level];
    const std::uint32_t value = l.values++;
    l.counts.insert(l.counts.end(), wanted.begin(), wanted.end());
    bytes_ += wanted.size() * sizeof(std::uint32_t) + 2 * sizeof(std::uint32_t);
    const auto place = [&](std::uint32_t v) {
        const std::uint64_t mask = l.buckets.size() - 1;
        std::uint64_t b = hash_of(local(level, v)) & mask;
        while (l.buckets[b] != 0) {
            b = (b + 1) & mask;
        }
        l.buckets[b] = v + 1;
    };
    if (std::size_t{l.values} * 2 > l.buckets.size()) {
        l.buckets.assign(l.buckets.size() * 2, 0);
        for (std::uint32_t v = 0; v < value; ++v) {
            place(v);
        }
    }
    place(value);
    return value;
}

std::int32_t SymbolicLevels::value_of(std::uint32_t level,
                                      std::span<const std::uint32_t> marking) const {
    std::vector<std::uint32_t> wanted;
    for (const std::uint32_t place : levels_[level].places) {
        wanted.push_back(marking[place]);
    }
    return find(level, wanted);
}

bool SymbolicLevels::enabled(std::uint32_t function, std::uint32_t value) const {
    const Function& f = functions_[function];
    const std::span<const std::uint32_t> counts = local(f.level, value);
    return std::all_of(f.arcs.begin(), f.arcs.end(), [&](const LocalArc& arc) {
        return counts[arc.slot] >= arc.low && counts[arc.slot] < arc.high;
    });
}

bool SymbolicLevels::fire_into_scratch(const Function& f, std::uint32_t value) {
    const std::span<const std::uint32_t> counts = local(f.level, value);
    scratch_.assign(counts.begin(), counts.end());
    for (const LocalArc& arc : f.arcs) {
        const std::uint64_t now =
            std::uint64_t{scratch_[arc.slot]} - arc.take + std::uint64_t{arc.give};
        if (now > kLargestCount) {
            return false;
        }
        scratch_[arc.slot] = static_cast<std::uint32_t>(now);
    }
    return true;
}

std::int32_t SymbolicLevels::ask(std::uint32_t function, std::uint32_t value) {
    Function& f = functions_[function];
    if (f.next.size() <= value) {
        bytes_ += (value + 1 - f.next.size()) * sizeof(std::int32_t);
        f.next.resize(value + 1, kUnasked);
    }
    std::int32_t& target = f.next[value];
    if (!enabled(function, value)) {
        return target = kDisabled;
    }
    target = fire_into_scratch(f, value) ? find(f.level, scratch_) : kDisabled;
    // What has no number yet may get one later: do not settle it.
    return target >= 0 ? target : target = kUnnumbered;
}

std::int32_t SymbolicLevels::number_target(std::uint32_t function, std::uint32_t value) {
    Function& f = functions_[function];
    if (!fire_into_scratch(f, value)) {
        overflowed_ = true;
        return kDisabled;
    }
    return f.next[value] = static_cast<std::int32_t>(number(f.level, scratch_));
}

void SymbolicLevels::close() {
    for (std::uint32_t i = 0; i < functions_.size(); ++i) {
        Function& f = functions_[i];
        const std::uint32_t values = value_count(f.level);
        bytes_ += 2 * values * sizeof(std::int32_t);
        f.next.assign(values, kUnasked);
        f.previous.assign(values, kDisabled);
        for (std::uint32_t v = 0; v < values; ++v) {
            if (ask(i, v) == kUnnumbered) {
                f.next[v] = kDisabled;
            } else if (f.next[v] >= 0) {
                f.previous[static_cast<std::uint32_t>(f.next[v])] = static_cast<std::int32_t>(v);
            }
        }
    }
}

}  // namespace puppetri::proof
