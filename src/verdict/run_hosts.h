// SPDX-License-Identifier: MIT
// Who performs while rules are watched: the stage of a scene, or nobody.
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "puppetri/run/player.h"
#include "puppetri/scene/beside.h"
#include "puppetri/stage/stage.h"
#include "puppetri/verdict/pursue.h"

namespace puppetri::verdict {

// Movements that nobody performs: as short as they are allowed to be.
class ShortestHost final : public net::MovementHost {
 public:
    explicit ShortestHost(const std::vector<proof::TickRange>& actions) : actions_(actions) {}
    SimTime begin(net::ActionIndex action, net::ActivityIndex, SimTime, SimTime duration,
                  std::span<const std::int64_t>) override {
        if (duration.ticks >= 0) {
            return duration;
        }
        return {action.value < actions_.size() ? actions_[action.value].low : 0};
    }
    std::span<const net::RaisedEvent> raised(net::ActivityIndex) override { return {}; }
    void cut(net::ActivityIndex, SimTime) override {}
    void left(net::ActivityIndex, SimTime) override {}

 private:
    const std::vector<proof::TickRange>& actions_;
};

// Passes everything on, and counts what the performance decides: durations and events that only it
// knows.
class CountingHost final : public net::MovementHost {
 public:
    net::MovementHost* performer = nullptr;
    std::uint64_t decided = 0;

    SimTime begin(net::ActionIndex action, net::ActivityIndex activity, SimTime at,
                  SimTime duration, std::span<const std::int64_t> attributes) override {
        decided += duration.ticks < 0 ? 1 : 0;
        return performer->begin(action, activity, at, duration, attributes);
    }
    std::span<const net::RaisedEvent> raised(net::ActivityIndex activity) override {
        const std::span<const net::RaisedEvent> events = performer->raised(activity);
        decided += events.empty() ? 0 : 1;
        return events;
    }
    void cut(net::ActivityIndex activity, SimTime at) override { performer->cut(activity, at); }
    void left(net::ActivityIndex activity, SimTime at) override { performer->left(activity, at); }
};

class EventListener final : public run::LogSink {
 public:
    void fired(SimTime, net::TransitionIndex) override {}
    void occurs(SimTime, net::EventIndex e) override { occurred.push_back(e.value); }
    std::vector<std::uint32_t> occurred;
};

// A player with whoever performs. The theatre and the chooser outlive it.
struct Performers {
    Performers(const Theatre& theatre, net::Chooser& chooser) : shortest(theatre.actions) {
        run::Options options;
        options.seed = theatre.seed;
        options.beat = theatre.beat;
        options.chooser = &chooser;
        options.sink = &listener;
        options.record = true;
        options.firings_per_instant = theatre.firings_per_instant;
        counting.performer = &shortest;
        if (theatre.scene != nullptr) {
            beside.emplace(*theatre.scene);
            stage.emplace(theatre.scene->play, beside->quantities());
            counting.performer = &*stage;
            options.coupled = beside->coupled(*stage);
        }
        options.host = &counting;
        player.emplace(*theatre.net, options);
    }
    Performers(const Performers&) = delete;
    Performers& operator=(const Performers&) = delete;

    EventListener listener;
    ShortestHost shortest;
    std::optional<scene::Beside> beside;
    std::optional<stage::Stage> stage;
    CountingHost counting;
    std::optional<run::Player> player;
};

}  // namespace puppetri::verdict
