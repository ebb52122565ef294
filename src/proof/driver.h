// SPDX-License-Identifier: MIT
// Drives net::Engine in the smallest visible steps: one firing, one event, or the passing to the
// next instant; asks a Branching for everything that is open, also for what the outside does. With
// clocks the engine lets time pass itself; without, what waits becomes ready set by set.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "branching.h"
#include "puppetri/net/engine.h"
#include "puppetri/proof/timed_graph.h"
#include "state_codec.h"

namespace puppetri::proof {

// What an explorer may assume of the world, as values that outlive the request.
struct World {
    const net::Net* net = nullptr;
    std::vector<TickRange> actions;
    std::uint32_t outside_events = 0;
    std::int64_t beat = 0;
    // That may occur at any time, and matter: from outside, so often; of movements, as often as
    // they like, because nobody here knows the movement.
    std::vector<std::uint32_t> outer_events, movement_events;
    std::vector<std::uint32_t> free_sensors;  // that no event sets
};

// How long a token in the place may last, as far as its movement declares it; of others 0 .. never.
TickRange movement_range(const World& world, std::uint32_t place);

class Driver final : private net::Timekeeper, private net::MovementHost {
    const World* world_;
    ClockForm form_;

 public:
    Driver(const World& world, ClockForm form);

    struct Step {
        std::uint32_t label = Edge::kPass;
        std::int64_t ticks = 0;  // exact: that have passed
    };
    enum class Did : std::uint8_t { kStep, kDead, kFault };

    Branching chooser;
    net::Engine engine;
    // How often the outside has acted; to be set together with the engine's state.
    std::uint32_t outside = 0;

    void start();
    void restore(net::State state, std::uint32_t outside_so_far);
    Did step(Step& out);
    // Some event may come at any time.
    bool may_come() const { return outer_events() + world_->movement_events.size() != 0; }
    // Of the last step: time could have passed instead; all that is free to happen or not.
    bool settled() const { return settled_; }
    // Nothing makes the next step necessary but the outside.
    bool idle() const { return idle_; }
    // The last step was an event that came from outside, or a sensor's change.
    bool from_outside() const { return from_outside_; }
    // What has begun since start() or restore(), with its number, and what was over in the pass.
    struct Begun {
        Kind kind = Kind::kToken;
        std::uint32_t element = 0;
        std::int64_t number = 0;  // 0: over at once
        std::int64_t low = 0, high = 0;
    };
    const std::vector<Begun>& begun() const { return begun_; }
    const std::vector<std::int64_t>& passed() const { return passed_; }
    // Called between settling and passing, with all that waits: chooses who is over.
    using Chooses = bool (*)(void* context, Driver& driver, std::vector<std::int64_t>& over);
    void choose_with(Chooses chooses, void* context) {
        chooses_ = chooses;
        context_ = context;
    }
    // What may last no time does last some: durations are drawn from a continuum.
    void waits_always() { waits_always_ = true; }
    const World& world() const { return *world_; }
    // How long movements took, in the order in which they began.
    std::vector<SimTime> movements;

 private:
    std::int64_t begin(Kind kind, std::uint32_t element, SimTime low, SimTime high) override;
    SimTime begin(net::ActionIndex action, net::ActivityIndex activity, SimTime at,
                  SimTime duration, std::span<const std::int64_t> attributes) override;
    std::span<const net::RaisedEvent> raised(net::ActivityIndex) override { return {}; }
    void cut(net::ActivityIndex, SimTime) override {}
    void left(net::ActivityIndex, SimTime) override {}
    net::EngineOptions options();
    std::uint32_t outer_events() const {
        return outside < world_->outside_events
                   ? static_cast<std::uint32_t>(world_->outer_events.size())
                   : 0;
    }
    bool ask_outside(Step& out);
    bool raised_is_next() const;

    bool settled_ = false, idle_ = false, from_outside_ = false, waits_always_ = false;
    std::int64_t next_number_ = 1;
    std::vector<Begun> begun_;
    std::vector<std::int64_t> passed_;
    Chooses chooses_ = nullptr;
    void* context_ = nullptr;
};

}  // namespace puppetri::proof
