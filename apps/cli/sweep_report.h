// SPDX-License-Identifier: MIT
// What a sweep has found, as a table for people, CSV, JSON, and a page with plots.
#pragma once
#include <string>
#include <vector>

#include "puppetri/scene/settings.h"
#include "puppetri/sim/metric.h"
#include "puppetri/sim/replicate.h"

namespace puppetri::cli {

struct MeasureName {
    std::string name;          // "queue.stay"
    std::string unit;          // "s", or empty
    std::string caption = {};  // what people read beside the name, or empty
};

struct SweepPoint {
    std::vector<scene::Setting> settings;
    sim::Outcome outcome;
};

struct SweepResult {
    std::string title;
    std::string scene;
    std::uint64_t seed = 1;
    double level = 0.95;
    double horizon_s = 0, warm_up_s = 0;  // 0: none
    double batch_s = 0;                   // above 0: replications are batches of one run
    std::vector<MeasureName> measures;
    std::vector<SweepPoint> points;
};

// The number with as many digits as its interval is worth; "-" for none.
std::string with_precision(double x, double half_width);

// One line per point and measure: the parameters, then
// measure,unit,replications,failed,mean,half_width,deviation,least,most.
std::string sweep_csv(const SweepResult& result);
std::string sweep_json(const SweepResult& result);
// `all`: also measures that are 0 in every run.
std::string sweep_table(const SweepResult& result, bool all);
// One file with everything in it: a table, and for each measure its mean and interval by point, or
// a histogram of its runs where there is one point.
std::string sweep_page(const SweepResult& result);

}  // namespace puppetri::cli
