// SPDX-License-Identifier: MIT
// The experiment on a net by itself: each replication plays it up to a horizon and reads its
// metrics.
#pragma once
#include <memory>
#include <vector>

#include "puppetri/net/host.h"
#include "puppetri/run/player.h"
#include "puppetri/sim/metric.h"
#include "puppetri/sim/replicate.h"

namespace puppetri::sim {

class NetExperiment final : public Experiment {
 public:
    struct Options {
        run::Limits limits;    // where a run ends; one of the two must be finite, or the net stop
        SimTime warm_up = {};  // nothing before it counts
        SimTime beat = {kTicksPerSecond};
        // Makes the one who performs the movements of a run, for nets that ask how long they take;
        // called from several threads. Left out: the net has no such places.
        std::unique_ptr<net::MovementHost> (*host)(const void* context) = nullptr;
        const void* context = nullptr;
        // What goes on continuously beside the net, by the performer that `host` has made, which
        // owns it.
        std::vector<run::Coupled*> (*coupled)(net::MovementHost& host) = nullptr;
    };

    // The net outlives the experiment.
    NetExperiment(const net::Net& net, std::vector<Metric> metrics, const Options& options)
        : net_(&net), metrics_(std::move(metrics)), options_(options) {}

    std::size_t width() const override { return metrics_.size(); }
    // A run that ends in a fault, or before the warm-up is over, is a failure.
    std::unique_ptr<Runner> runner() const override;

 private:
    const net::Net* net_;
    std::vector<Metric> metrics_;
    Options options_;
};

}  // namespace puppetri::sim
