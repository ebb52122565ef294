// SPDX-License-Identifier: MIT
// A rule watched on one concrete run: the same monitor as on graphs, fed by run::Player. Nothing is
// unknown here but what figures do between two firings, which the stage tells afterwards.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "puppetri/run/player.h"
#include "puppetri/verdict/monitor.h"

namespace puppetri::verdict {

// Judges state formulas in the present state of a player.
class AtomReader {
 public:
    // The net outlives it. Formulas without firings, events, temporal operators; of the host
    // nothing is known (it may and need not hold).
    AtomReader(const net::Net& net, std::span<const net::Formula> formulas);
    ~AtomReader();
    AtomReader(AtomReader&&) noexcept;
    // Rows of bits as proof::AtomBits has them; (formulas + 63) / 64 words each.
    void read(const run::Player& player, std::vector<std::uint64_t>& may,
              std::vector<std::uint64_t>& must) const;
    // Of one formula.
    Truth read(const run::Player& player, std::uint32_t formula) const;

 private:
    struct Data;
    std::unique_ptr<Data> data_;
};

class RunWatch {
 public:
    enum class Says : std::uint8_t {
        kGood,    // so far
        kBroken,  // the rule is broken, by what is known
        kMaybe,   // it may be broken: figures decide
    };

    // All outlive it; the obligation was made for this net with atoms that `reader` reads.
    RunWatch(const Obligation& obligation, const AtomReader& reader, const run::Player& player);

    // Before any firing.
    Says begin();
    // What occurred since the last firing, and no firing has followed.
    Says occurred(std::span<const std::uint32_t> events);
    // After a firing; `events`: what occurred since the last moment.
    Says fired(std::span<const std::uint32_t> events);
    // Of rules read when settled, which need it: nothing more fires in this instant, and time goes
    // on (step() with the present time as limit has come back without a firing).
    Says time_passes();
    // Nothing more happens by itself: `rests` says for good.
    Says ended(SimTime now, bool rests);
    // Something is owed now, and since when.
    std::optional<SimTime> owes_since() const;
    // The state of the monitor, for telling where a run repeats itself.
    const std::vector<std::uint32_t>& states() const { return states_; }

 private:
    Says moment(std::uint32_t label, bool start, SimTime now);
    void defer(std::uint32_t label, bool start);
    Says late(SimTime now) const;

    const Obligation& o_;
    const AtomReader& reader_;
    const run::Player& player_;
    std::optional<Monitor> monitor_;
    std::vector<std::uint32_t> states_, next_;
    std::vector<std::uint64_t> before_may_, before_must_, may_, must_;
    std::optional<SimTime> owes_since_;
    // Of rules read when settled: the last moment, until time passes.
    bool deferred_ = false, deferred_start_ = false;
    std::uint32_t deferred_label_ = 0;
    SimTime deferred_at_;
};

}  // namespace puppetri::verdict
