// SPDX-License-Identifier: MIT
#include "sweep_pilot.h"

#include <algorithm>

namespace puppetri::cli {
namespace {

// Welch's way: some runs are averaged, so that what they share, the settling, stands out.
constexpr std::uint64_t kPilots = 10;
constexpr std::size_t kStretches = 400;
constexpr std::size_t kFinest = 1024;

Diagnostics one(std::string code, std::string message, std::string remedy) {
    Diagnostic d;
    d.code = std::move(code);
    d.message = std::move(message);
    d.remedy = std::move(remedy);
    return {d};
}

}  // namespace

Checked<SimTime> find_warm_up(const std::vector<PilotPoint>& points, std::uint64_t seed,
                              SimTime until) {
    std::size_t rows = 0;
    for (const PilotPoint& p : points) {
        std::vector<sim::Series> runs(kPilots);
        for (std::uint64_t k = 0; k < kPilots; ++k) {
            Diagnostic fault;
            if (!sim::play_series(*p.net, *p.metrics, p.options,
                                  sim::replication(seed, k, false).seed, {}, until, kStretches,
                                  runs[k], fault)) {
                return Unexpected(Diagnostics{fault});
            }
        }
        const auto after = sim::settled_after(sim::mean_of(runs));
        if (!after) {
            return Unexpected(one("not-settled",
                                  "some measure has not settled in the first half of a run",
                                  "make the run longer (--for), or give the warm-up yourself; a "
                                  "queue that grows without bound never settles"));
        }
        rows = std::max(rows, *after);
    }
    return SimTime{until.ticks / static_cast<std::int64_t>(kStretches) *
                   static_cast<std::int64_t>(rows)};
}

Checked<std::uint32_t> find_batches(const std::vector<PilotPoint>& points, std::uint64_t seed,
                                    SimTime warm_up, SimTime until) {
    auto fewest = static_cast<std::uint32_t>(kFinest);
    for (const PilotPoint& p : points) {
        sim::Series series;
        Diagnostic fault;
        if (!sim::play_series(*p.net, *p.metrics, p.options, seed, warm_up, until, kFinest, series,
                              fault)) {
            return Unexpected(Diagnostics{fault});
        }
        const std::uint32_t count = sim::batches_apart(series);
        if (count == 0) {
            return Unexpected(one("batches-depend",
                                  "stretches of the run still depend on each other when they are "
                                  "1/128 of it: 16 batches of eight would not be independent",
                                  "make the run longer: --for"));
        }
        fewest = std::min(fewest, count);
    }
    return fewest;
}

}  // namespace puppetri::cli
