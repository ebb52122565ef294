// SPDX-License-Identifier: MIT
// One player per replication, one meter per thread.
#include "puppetri/sim/net_experiment.h"

#include "puppetri/sim/meter.h"

namespace puppetri::sim {
namespace {

class NetRunner final : public Runner {
 public:
    NetRunner(const net::Net& net, const std::vector<Metric>& metrics,
              const NetExperiment::Options& options)
        : net_(net), options_(options), meter_(net, metrics, {.from = options.warm_up}) {}

    bool run(const Replication& replication, std::span<double> values, Diagnostic& fault) override {
        run::Options options;
        options.seed = replication.seed;
        options.antithetic = replication.antithetic;
        options.beat = options_.beat;
        std::unique_ptr<net::MovementHost> host;
        if (options_.host != nullptr) {
            host = options_.host(options_.context);
            options.host = host.get();
            if (options_.coupled != nullptr) {
                options.coupled = options_.coupled(*host);
            }
        }
        options.observer = &meter_;
        run::Player player(net_, options);
        const run::Stop stop = player.run(options_.limits);
        if (stop == run::Stop::kFault) {
            fault = player.fault();
            return false;
        }
        if (meter_.fault()) {
            fault = *meter_.fault();
            return false;
        }
        // A net that rests goes on resting up to the horizon
        const bool rests = stop == run::Stop::kDead || stop == run::Stop::kFinal;
        const SimTime end = rests && options_.limits.until != SimTime::never()
                                ? options_.limits.until
                                : player.now();
        if (end < options_.warm_up) {
            fault.code = "over-before-warm-up";
            fault.message = "the run ends before the warm-up is over";
            fault.remedy = "give a longer horizon or a shorter warm-up";
            return false;
        }
        meter_.finish(end, values);
        if (meter_.fault()) {  // of what goes on beside the net
            fault = *meter_.fault();
            return false;
        }
        return true;
    }

 private:
    const net::Net& net_;
    const NetExperiment::Options& options_;
    Meter meter_;
};

}  // namespace

std::unique_ptr<Runner> NetExperiment::runner() const {
    return std::make_unique<NetRunner>(*net_, metrics_, options_);
}

}  // namespace puppetri::sim
