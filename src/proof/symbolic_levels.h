// SPDX-License-Identifier: MIT
// A net cut into the variables of a decision diagram. A variable (level) is a group of places; its
// values number the local markings of the group in the order in which they are found, so nothing
// has to be known about bounds beforehand. A transition acts on each level it touches by a partial
// function of values, and not at all on the others. All these functions are injective: a firing
// adds constants.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "puppetri/proof/plain_net.h"
#include "puppetri/proof/predicate.h"

namespace puppetri::proof {

// Groups of places from the top of the diagram down: groups[0] is its root's variable.
using PlaceGroups = std::vector<std::vector<std::uint32_t>>;

class SymbolicLevels {
 public:
    static constexpr std::int32_t kDisabled = -1, kUnasked = -2, kUnnumbered = -3;
    static constexpr std::uint32_t kLargestCount = 1u << 31;

    struct Touch {
        std::uint32_t level = 0, function = 0;
    };
    struct Event {
        std::vector<Touch> touches;  // from the top down
        // Nothing happens below this level; 0: the event touches no place at all.
        std::uint32_t bottom() const { return touches.empty() ? 0 : touches.back().level; }
        std::uint32_t top() const { return touches.empty() ? 0 : touches.front().level; }
    };

    SymbolicLevels(const PlainNet& net, const PlaceGroups& groups);

    std::uint32_t count() const { return static_cast<std::uint32_t>(levels_.size()) - 1; }
    const std::vector<Event>& events() const { return events_; }
    std::span<const std::uint32_t> places(std::uint32_t level) const {
        return levels_[level].places;
    }
    std::uint32_t level_of(std::uint32_t place) const { return level_of_[place]; }
    std::uint32_t value_count(std::uint32_t level) const { return levels_[level].values; }
    std::span<const std::uint32_t> local(std::uint32_t level, std::uint32_t value) const {
        const Level& l = levels_[level];
        return {&l.counts[value * l.places.size()], l.places.size()};
    }
    std::uint32_t tokens(std::uint32_t place, std::uint32_t value) const {
        return local(level_of_[place], value)[slot_of_[place]];
    }
    // The value of the marking's part at this level.
    // Gives  kDisabled if no such local marking was ever met.
    std::int32_t value_of(std::uint32_t level, std::span<const std::uint32_t> marking) const;

    // Where a function leads from a value: kDisabled, kUnnumbered (enabled, but the target has no
    // number yet) or a value.
    std::int32_t next(std::uint32_t function, std::uint32_t value) {
        std::vector<std::int32_t>& table = functions_[function].next;
        if (value < table.size() && table[value] != kUnasked) {
            return table[value];
        }
        return ask(function, value);
    }
    // As next() >= 0, numbering the target. Needs  the function is enabled.
    // Gives  kDisabled if a count would pass kLargestCount; then overflowed() is true.
    std::int32_t reach(std::uint32_t function, std::uint32_t value) {
        const std::int32_t target = next(function, value);
        return target == kUnnumbered ? number_target(function, value) : target;
    }
    // Numbers the marking's part.
    std::uint32_t number(std::uint32_t level, std::span<const std::uint32_t> local);
    bool overflowed() const { return overflowed_; }

    // After exploration: fills all tables; targets that were never numbered are never reached.
    void close();
    // After close().
    std::int32_t after(std::uint32_t function, std::uint32_t value) const {
        return functions_[function].next[value];
    }
    std::int32_t before(std::uint32_t function, std::uint32_t value) const {
        return functions_[function].previous[value];
    }
    // Enabled as far as this level goes, whether or not the target was ever met.
    bool enabled(std::uint32_t function, std::uint32_t value) const;
    // What each value of each level adds to the sum; empty rows where the level has no part in it.
    // Gives  false where 64 bits do not hold it.
    bool weigh(const LinearSum& sum, std::vector<std::vector<std::int64_t>>& weights) const;
    std::uint64_t bytes() const { return bytes_; }

 private:
    struct Level {
        std::vector<std::uint32_t> places;
        std::uint32_t values = 0;
        std::vector<std::uint32_t> counts;   // values x places
        std::vector<std::uint32_t> buckets;  // open addressing: value + 1
    };
    struct LocalArc {
        std::uint32_t slot = 0;
        std::uint32_t low = 0, high = ~0u;  // enabled at low <= tokens < high
        std::uint32_t take = 0, give = 0;
        bool operator==(const LocalArc&) const = default;
    };
    struct Function {
        std::uint32_t level = 0;
        std::vector<LocalArc> arcs;
        std::vector<std::int32_t> next, previous;
    };
    std::uint32_t function_of(std::uint32_t level, std::vector<LocalArc>&& arcs);
    std::int32_t ask(std::uint32_t function, std::uint32_t value);
    std::int32_t number_target(std::uint32_t function, std::uint32_t value);
    // Gives  false on overflow.
    bool fire_into_scratch(const Function& f, std::uint32_t value);
    std::int32_t find(std::uint32_t level, std::span<const std::uint32_t> local) const;

    std::vector<Level> levels_;  // 1 .. count
    std::vector<std::uint32_t> level_of_, slot_of_;
    std::vector<Event> events_;
    std::vector<Function> functions_;
    std::vector<std::vector<std::uint32_t>> functions_of_level_;
    std::vector<std::uint32_t> scratch_;
    bool overflowed_ = false;
    std::uint64_t bytes_ = 0;
};

}  // namespace puppetri::proof
