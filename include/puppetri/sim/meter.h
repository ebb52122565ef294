// SPDX-License-Identifier: MIT
// The meter: reads metrics off a run while it is played.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "puppetri/base/time.h"
#include "puppetri/run/player.h"
#include "puppetri/sim/metric.h"

namespace puppetri::sim {

// Follows one run from its beginning:
//   Meter meter(net, metrics, {.from = warm_up});
//   meter.begin(player);
//   while (player.step(limits) == run::Stop::kNone) { meter.fired(player); }
//   meter.finish(player.now(), values);
// What happens before `from` (the warm-up) changes the state that is measured, but no number: means
// over time and rates are those of from .. end; a stay counts if it ends there, whole.
//
// Tokens of one place count as leaving in the order in which they came. Where they overtake each
// other the mean stay is the same, since it depends on the sums alone.
//
// Cost    per firing: its metered places; memory: one arrival per token that waits in a place whose
//         stay is measured.
class Meter {
 public:
    struct Options {
        SimTime from = {};
    };

    // The net outlives the meter.
    Meter(const net::Net& net, std::span<const Metric> metrics, const Options& options);
    Meter(const net::Net& net, std::span<const Metric> metrics) : Meter(net, metrics, Options{}) {}

    // The player has not fired yet. Forgets an earlier run.
    void begin(const run::Player& player);
    // The player has just made one firing.
    void fired(const run::Player& player);
    // The run is over. Writes one number per metric; of a run that ends before `from`, 0.
    void finish(SimTime end, std::span<double> values);

 private:
    struct Arc {                  // of a transition, on a metered place
        std::uint32_t place = 0;  // number in places_
        std::uint32_t takes = 0, gives = 0;
        bool takes_all = false;
    };
    // A queue of arrival times in a ring that grows.
    struct Arrivals {
        std::vector<std::int64_t> ring;  // size a power of two
        std::uint32_t first = 0, size = 0;
        void push(std::int64_t at);
        std::int64_t pop();
    };
    struct Place {
        net::PlaceIndex place;
        bool stays = false;
        std::uint32_t tokens = 0, most = 0;
        std::int64_t since = 0;  // the last change of `tokens`, not before `from`
        double token_ticks = 0;  // integral of tokens
        double busy_ticks = 0;   // time with a token
        double stay_ticks = 0;   // sum over those that left
        std::uint64_t left = 0;
        Arrivals arrivals;
    };

    void integrate(Place& place, std::int64_t now) const;

    const net::Net* net_;
    std::vector<Metric> metrics_;
    std::int64_t from_;
    std::vector<Place> places_;
    std::vector<std::uint32_t> number_;   // of a place of the net in places_
    net::Rows<Arc> arcs_;                 // by transition
    std::vector<std::uint64_t> firings_;  // by transition
};

}  // namespace puppetri::sim
