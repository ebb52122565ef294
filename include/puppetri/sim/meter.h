// SPDX-License-Identifier: MIT
// The meter: reads metrics off a run while it is played.
#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "puppetri/base/time.h"
#include "puppetri/run/player.h"
#include "puppetri/sim/metric.h"

namespace puppetri::sim {

// Follows one run after the other from their beginnings:
//   Meter meter(net, metrics, {.from = warm_up});
//   run::Player player(net, {.seed = 7, .observer = &meter});
//   player.run(limits);
//   meter.finish(player.now(), values);
// What happens before `from` (the warm-up) changes the state that is measured, but no number: means
// over time and rates are those of from .. end; a stay or a passage counts if it ends there, whole.
// A mean of nothing is NaN.
//
// PLACE.stay lets tokens of one place leave in the order in which they came: where they overtake
// each other the mean is the same up to those that are still there, since it depends on sums alone.
// Declared measures of stays follow each token, by its discipline.
//
// Cost    per firing: its metered places and measures; memory: one arrival per token that waits in
// a
//         place whose stay is measured, and all observations of a percentile.
class Meter final : public run::Observer {
 public:
    struct Options {
        SimTime from = {};
    };

    // The net outlives the meter.
    Meter(const net::Net& net, std::span<const Metric> metrics, const Options& options);
    Meter(const net::Net& net, std::span<const Metric> metrics) : Meter(net, metrics, Options{}) {}

    // The run is over, or a part of it: what follows counts anew from there. Writes one number per
    // metric, NaN where nothing was seen; of a run that ends before `from`, 0 or NaN. Where
    // equations are measured, what is coupled to the player must still be there.
    void finish(SimTime end, std::span<double> values);
    // A measure cannot be computed in some state of this run (a division by zero).
    const std::optional<Diagnostic>& fault() const { return fault_; }

    Wants wants() const override { return wants_; }
    void prepare() override;
    void begins(const run::Player& player) override;
    void fired(const run::Player& player) override;
    void passed(const run::Player& player) override;
    void fires(SimTime at, net::TransitionIndex t, const Code::Reader& before) override;
    void arrives(SimTime at, net::PlaceIndex p, SimTime ready) override;
    void leaves(SimTime at, net::PlaceIndex p, SimTime arrived) override;

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
    // What has been seen so far of something that happens now and then.
    struct Seen {
        const net::MeasureDraft* measure = nullptr;
        std::uint64_t count = 0, true_count = 0;
        double sum = 0, most = 0, least = 0, last = 0;
        std::vector<double> values;  // of a percentile

        void forget();
        void see(double x);
        double result(double passed_s);
    };
    // Something that is there all the time.
    struct Watched {
        const net::MeasureDraft* measure = nullptr;
        std::uint32_t number = 0;  // of the measure
        ProgramIndex program;
        double value = 0, most = 0, least = 0, sum = 0;  // sum: value times ticks
        std::int64_t since = 0;
    };
    struct Order {  // of a token that waits: the next to leave is the least
        std::int64_t ready = 0, arrived = 0;
        std::uint64_t serial = 0;
    };
    enum class Leaving : std::uint8_t { kInOrder, kByReadiness, kTold };
    struct Place {
        net::PlaceIndex place;
        bool stays = false;                   // some stay is measured, by the order of coming
        std::vector<std::uint32_t> seen;      // numbers in seen_ of declared measures of its stays
        Leaving leaving = Leaving::kInOrder;  // of these
        std::uint32_t tokens = 0, most = 0;
        std::int64_t since = 0;  // the last change of `tokens`, not before `from`
        double token_ticks = 0;  // integral of tokens
        double busy_ticks = 0;   // time with a token
        double stay_ticks = 0;   // sum over those that left
        std::uint64_t left = 0;
        Arrivals arrivals;
        std::vector<Order> waiting;  // a heap, of kByReadiness
        std::vector<Order> fresh;    // have come since the last firing
    };
    // From one firing to another; by key where they have one.
    struct Passage {
        Arrivals begun;
        std::map<Value, Arrivals> begun_by_key;
    };
    // What happens to a measure at a firing.
    struct Turn {
        enum Role : std::uint8_t { kSee, kEnd, kBegin } role = kSee;
        bool keyed = false;
        std::uint32_t seen = 0;  // also the number of its passage
        std::uint32_t measure = 0;
        ProgramIndex program;
        ValueKind kind = ValueKind::kInt;
    };

    // Something that goes on beside the net.
    struct Followed {
        const net::MeasureDraft* measure = nullptr;
        std::uint32_t metric = 0;
    };

    void follow(SimTime end, std::span<double> values);
    std::uint32_t place_number(std::uint32_t place);
    void lay_out_arcs();
    void lay_out_watched();
    void add_measure(std::uint32_t number);
    void integrate(Place& place, std::int64_t now) const;
    void watch(Watched& w, const run::Player& player);
    void stayed(const Place& place, std::int64_t now, std::int64_t arrived);
    void leave_by_readiness(Place& place, std::uint32_t leave, std::int64_t now);
    void turn(const Turn& turn, std::int64_t now, Value key);
    double measured(std::uint32_t measure, std::uint32_t slot, double passed);
    double number_of(ProgramIndex program, std::uint32_t measure, ValueKind kind,
                     const Code::Reader& reader, Value* raw = nullptr);
    void forget(std::int64_t from);

    const net::Net* net_;
    std::vector<Metric> metrics_;
    std::vector<std::uint32_t> slots_;  // by metric: number in places_, watched_ or seen_
    std::int64_t warm_up_, from_;
    Wants wants_;
    std::vector<Place> places_;
    std::vector<std::uint32_t> number_;  // of a place of the net in places_
    net::Rows<Arc> arcs_;                // by transition
    std::vector<Watched> watched_;
    std::vector<Seen> seen_;
    std::vector<Followed> followed_;
    std::vector<run::Coupled*> coupled_;                   // of the run that is followed
    std::vector<Passage> passages_;                        // by number in seen_
    net::Rows<std::uint32_t> watched_at_;                  // by transition
    std::vector<std::uint32_t> watched_always_;            // may change between firings
    std::vector<std::vector<Turn>> turns_, turns_inside_;  // by transition: after, and before
    std::vector<std::uint64_t> firings_;                   // by transition
    std::uint64_t serials_ = 0;
    std::optional<Diagnostic> fault_;
};

}  // namespace puppetri::sim
