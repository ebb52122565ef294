// SPDX-License-Identifier: MIT
// Numbers about sets, each by one pass over the nodes from the bottom up.
#include <algorithm>

#include "puppetri/base/require.h"
#include "puppetri/proof/symbolic.h"
#include "symbolic_reading.h"
#include "symbolic_tables.h"

namespace puppetri::proof {
namespace {

// 64 bits while they last: most sets are counted without a large number.
struct Short {
    std::uint64_t value = 0;
    bool passed = false;
    Short& operator+=(const Short& other) {
        passed = __builtin_add_overflow(value, other.value, &value) || passed || other.passed;
        return *this;
    }
};

template <class Number>
std::vector<Number> count_nodes(const DiagramStore& store, const Reading& reading) {
    std::vector<Number> counts(reading.size());
    counts[0] = Number{1};
    for (std::uint32_t i = 1; i < reading.size(); ++i) {
        for (const DiagramEntry& e : store.entries(reading.node(i))) {
            counts[i] += counts[reading.position_of(e.child)];
        }
    }
    return counts;
}

// The sum over all events of the words that enable them. An event's share of a node at its top
// level is counted between its top and its bottom only; from there on shares of all events go up
// together.
template <class Number>
Number count_firings(DiagramStore& store, const SymbolicLevels& levels, const Reading& reading) {
    const std::vector<Number> counts = count_nodes<Number>(store, reading);
    std::vector<Number> firings(reading.size()), shares(reading.size());
    Number always{};  // of events that touch nothing
    for (const SymbolicLevels::Event& event : levels.events()) {
        if (event.touches.empty()) {
            always += counts[reading.root()];
            continue;
        }
        std::size_t touch = event.touches.size();
        for (std::uint32_t level = event.bottom(); level <= event.top(); ++level) {
            const bool touched = touch > 0 && event.touches[touch - 1].level == level;
            touch -= touched ? 1 : 0;
            const std::vector<Number>& below = level == event.bottom() ? counts : shares;
            for (std::uint32_t i = reading.begin_of(level);
                 i < reading.end_of(level) && !store.failed(); ++i) {
                store.tick();
                Number share{};
                for (const DiagramEntry& e : store.entries(reading.node(i))) {
                    if (!touched || levels.enabled(event.touches[touch].function, e.value)) {
                        share += below[reading.position_of(e.child)];
                    }
                }
                if (level == event.top()) {
                    firings[i] += share;
                } else {
                    shares[i] = share;
                }
            }
        }
    }
    for (std::uint32_t i = 1; i < reading.size(); ++i) {
        for (const DiagramEntry& e : store.entries(reading.node(i))) {
            firings[i] += firings[reading.position_of(e.child)];
        }
    }
    firings[reading.root()] += always;
    return firings[reading.root()];
}

}  // namespace

std::optional<bool> SymbolicSpace::empty(const StateSet& a) const {
    if (!a.known()) {
        return std::nullopt;
    }
    return a.root_ == DiagramStore::kEmpty;
}

std::optional<bool> SymbolicSpace::equal(const StateSet& a, const StateSet& b) const {
    if (!a.known() || !b.known()) {
        return std::nullopt;
    }
    return a.root_ == b.root_;
}

std::optional<bool> SymbolicSpace::contains(const StateSet& a,
                                            std::span<const std::uint32_t> marking) const {
    PUP_REQUIRE(marking.size() == net().place_count());
    if (!a.known()) {
        return std::nullopt;
    }
    NodeId node = a.root_;
    for (std::uint32_t level = tables_->levels->count(); level >= 1 && node != 0; --level) {
        const std::int32_t value = tables_->levels->value_of(level, marking);
        node = value < 0
                   ? DiagramStore::kEmpty
                   : tables_->store->entries(node).child_of(static_cast<std::uint32_t>(value));
    }
    return node != DiagramStore::kEmpty;
}

std::optional<bool> SymbolicSpace::holds_initially(const StateSet& a) const {
    return contains(a, net().initial);
}

std::optional<Natural> SymbolicSpace::count(const StateSet& a) {
    if (!a.known() || a.root_ == DiagramStore::kEmpty) {
        return a.known() ? std::optional<Natural>(0) : std::nullopt;
    }
    const Reading reading(*tables_->store, a.root_, tables_->levels->count());
    const Short few = count_nodes<Short>(*tables_->store, reading).back();
    return few.passed ? count_nodes<Natural>(*tables_->store, reading).back() : Natural(few.value);
}

std::optional<Natural> SymbolicSpace::edges(const StateSet& a) {
    if (!a.known() || a.root_ == DiagramStore::kEmpty) {
        return a.known() ? std::optional<Natural>(0) : std::nullopt;
    }
    const Reading reading(*tables_->store, a.root_, tables_->levels->count());
    DiagramStore& store = *tables_->store;
    const Short few = count_firings<Short>(store, *tables_->levels, reading);
    const Natural firings =
        few.passed ? count_firings<Natural>(store, *tables_->levels, reading) : Natural(few.value);
    return store.failed() ? std::nullopt : std::optional<Natural>(firings);
}

std::optional<std::vector<std::uint32_t>> SymbolicSpace::max_tokens(const StateSet& a) {
    if (!a.known()) {
        return std::nullopt;
    }
    std::vector<std::uint32_t> most(net().place_count(), 0);
    if (a.root_ == DiagramStore::kEmpty) {
        return most;
    }
    const SymbolicLevels& levels = *tables_->levels;
    const Reading reading(*tables_->store, a.root_, levels.count());
    for (std::uint32_t level = 1; level <= levels.count(); ++level) {
        std::vector<std::uint8_t> seen(levels.value_count(level), 0);
        for (std::uint32_t i = reading.begin_of(level); i < reading.end_of(level); ++i) {
            for (const DiagramEntry& e : tables_->store->entries(reading.node(i))) {
                seen[e.value] = 1;
            }
        }
        for (std::uint32_t value = 0; value < seen.size(); ++value) {
            for (const std::uint32_t place : levels.places(level)) {
                if (seen[value]) {
                    most[place] = std::max(most[place], levels.tokens(place, value));
                }
            }
        }
    }
    return most;
}

std::optional<std::int64_t> SymbolicSpace::max_of(const LinearSum& sum, const StateSet& a) {
    LinearSum negative = sum;
    for (LinearSum::Term& term : negative.terms) {
        if (__builtin_sub_overflow(std::int64_t{0}, term.factor, &term.factor)) {
            return std::nullopt;
        }
    }
    const std::optional<std::int64_t> least = min_of(negative, a);
    if (!least.has_value() || *least == INT64_MIN) {
        return std::nullopt;
    }
    return -*least;
}

std::optional<std::int64_t> SymbolicSpace::min_of(const LinearSum& sum, const StateSet& a) {
    if (!a.known() || a.root_ == DiagramStore::kEmpty) {
        return std::nullopt;
    }
    for (const LinearSum::Term& term : sum.terms) {
        PUP_REQUIRE(term.place < net().place_count());
    }
    const SymbolicLevels& levels = *tables_->levels;
    std::vector<std::vector<std::int64_t>> weights;
    if (!levels.weigh(sum, weights)) {
        return std::nullopt;
    }
    const Reading reading(*tables_->store, a.root_, levels.count());
    std::vector<std::int64_t> least(reading.size(), 0);
    for (std::uint32_t level = 1; level <= levels.count(); ++level) {
        for (std::uint32_t i = reading.begin_of(level); i < reading.end_of(level); ++i) {
            bool first = true;
            for (const DiagramEntry& e : tables_->store->entries(reading.node(i))) {
                std::int64_t here = least[reading.position_of(e.child)];
                if (!weights[level].empty() &&
                    __builtin_add_overflow(here, weights[level][e.value], &here)) {
                    return std::nullopt;
                }
                least[i] = first ? here : std::min(least[i], here);
                first = false;
            }
        }
    }
    return least[reading.root()];
}

std::optional<SymbolicFacts> SymbolicSpace::facts() {
    const StateSet states = all();
    const std::optional<Natural> count_all = count(states), firings = edges(states);
    const auto most = max_tokens(states);
    LinearSum everything;
    for (std::uint32_t p = 0; p < net().place_count(); ++p) {
        everything.terms.push_back({p, 1});
    }
    const std::optional<std::int64_t> together = max_of(everything, states);
    const std::optional<bool> no_death = empty(dead());
    if (!count_all || !firings || !most || !together || !no_death) {
        return std::nullopt;
    }
    SymbolicFacts facts;
    facts.states = *count_all;
    facts.edges = *firings;
    for (const std::uint32_t tokens : *most) {
        facts.max_in_place = std::max(facts.max_in_place, tokens);
    }
    facts.max_in_marking = static_cast<std::uint64_t>(*together);
    facts.dead_reachable = !*no_death;
    return facts;
}

std::optional<Marking> SymbolicSpace::some_marking(const StateSet& a) {
    if (!a.known() || a.root_ == DiagramStore::kEmpty) {
        return std::nullopt;
    }
    Marking marking(net().place_count());
    NodeId node = a.root_;
    const SymbolicLevels& levels = *tables_->levels;
    for (std::uint32_t level = levels.count(); level >= 1; --level) {
        const DiagramEntry entry = *tables_->store->entries(node).begin();
        for (const std::uint32_t place : levels.places(level)) {
            marking[place] = levels.tokens(place, entry.value);
        }
        node = entry.child;
    }
    return marking;
}

}  // namespace puppetri::proof
