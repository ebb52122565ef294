// SPDX-License-Identifier: MIT
// One long run instead of many: cut into batches that stand for replications, and looked at for how
// long it takes to settle.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "puppetri/sim/net_experiment.h"

namespace puppetri::sim {

// Replication k is the k-th stretch of `length` after the warm-up, all of the run of replication 0:
// one after the other, in one thread and one process (Plan::threads, Plan::owner). Batches are
// taken for independent, which long ones nearly are: see batches_apart.
class BatchExperiment final : public Experiment {
 public:
    // `options.limits` is not looked at: the run goes on as long as there are batches to play. The
    // net outlives the experiment.
    BatchExperiment(const net::Net& net, std::vector<Metric> metrics,
                    const NetExperiment::Options& options, SimTime length, std::uint64_t seed)
        : net_(&net),
          metrics_(std::move(metrics)),
          options_(options),
          length_(length),
          seed_(seed) {}

    std::size_t width() const override { return metrics_.size(); }
    std::unique_ptr<Runner> runner() const override;

 private:
    const net::Net* net_;
    std::vector<Metric> metrics_;
    NetExperiment::Options options_;
    SimTime length_;
    std::uint64_t seed_;
};

// A series of `count` rows of `width` numbers, cut finely.
struct Series {
    std::uint64_t width = 0, count = 0;
    std::vector<double> values;
    double at(std::size_t row, std::size_t column) const { return values[row * width + column]; }
};

// The correlation of each number of a column with the next one; 0 where nothing varies.
double lag_one(const Series& series, std::size_t column);

// How many batches the series may be cut into. The means are joined two by two until no column's
// still go with their neighbours (lag-1 correlation below 1.645 / sqrt(n), the one-sided bound of
// 5 %), and then eight by eight: what the test cannot see any more, a correlation as large as its
// bound, would make intervals cover 90 % instead of 95 %. Columns with numbers that are missing
// (NaN) are left out.
// Gives   0 if that leaves fewer than 16: the run is too short.
// Source  G. S. Fishman, "Grouping observations in digital simulation", Management Science 24
//         (1978): batches are doubled until the correlation is gone. B. Schmeiser, "Batch size
//         effects in the analysis of simulation output", Operations Research 30 (1982): few long
//         batches lose next to nothing. That a test which does not reject is no proof, and what
//         that costs: N. M. Steiger et al., "ASAP3", ACM TOMACS 15 (2005).
std::uint32_t batches_apart(const Series& series);

// After how many rows the series has settled, by the marginal standard error rule: the d that
// minimizes sum (x_i - mean)^2 / (n - d)^2 over the rows i > d; of several columns the largest.
// Gives   none if it is not in the first half: the run is too short to tell.
// Source  K. P. White, "An effective truncation heuristic for bias reduction in simulation output",
//         Simulation 69 (1997); MSER-5 of White, Cobb, Spratt, Winter Simulation Conference 2000,
//         takes means of five, as these rows are means of stretches of time.
std::optional<std::size_t> settled_after(const Series& series);

// Plays replication `number` and cuts it into `rows` equal stretches of from .. until.
// Fails   as a replication does; `fault` says why.
bool play_series(const net::Net& net, std::span<const Metric> metrics,
                 const NetExperiment::Options& options, std::uint64_t seed, SimTime from,
                 SimTime until, std::size_t rows, Series& out, Diagnostic& fault);

// Means of several series of one shape, row by row and column by column.
Series mean_of(std::span<const Series> series);

}  // namespace puppetri::sim
