// SPDX-License-Identifier: MIT
// Speed of simulation with statistics: a queue whose customers have identity and are measured, by
// the player with a meter and by a hand-written loop that keeps the same customers and the same
// sums; and many short runs, as a sweep makes them. Logs and statistics must agree, else there is
// no time.
#include <benchmark/benchmark.h>
#include <time.h>

#include <cmath>
#include <thread>

#include "floor.h"
#include "models.h"
#include "puppetri/net/net.h"
#include "puppetri/run/player.h"
#include "puppetri/sim/meter.h"
#include "puppetri/sim/net_experiment.h"

namespace {

using namespace puppetri;

constexpr std::uint64_t kSeed = 7;

double seconds_of(clockid_t clock, auto&& work) {
    const auto now = [clock] {
        timespec t{};
        clock_gettime(clock, &t);
        return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
    };
    const double start = now();
    work();
    return now() - start;
}

void queue_with_identity(benchmark::State& state, bool engine) {
    constexpr std::uint64_t kFirings = 1'000'000;
    const auto net = net::compile(bench::mm1_customers());
    if (!net) {
        state.SkipWithError(net.error()[0].message.c_str());
        return;
    }
    const bench::QueueSums floor = bench::mm1_customers_floor(kSeed, kFirings);
    sim::Meter meter(*net, sim::declared_metrics(*net));
    for (auto _ : state) {
        std::uint64_t hash = 0;
        std::vector<double> values(3);
        if (engine) {
            run::Player player(*net, {.seed = kSeed, .observer = &meter});
            state.SetIterationTime(seconds_of(CLOCK_THREAD_CPUTIME_ID, [&] {
                player.run({.firings = kFirings});
                meter.finish(player.now(), values);
            }));
            hash = player.log_hash();
        } else {
            bench::QueueSums sums;
            state.SetIterationTime(seconds_of(CLOCK_THREAD_CPUTIME_ID, [&] {
                sums = bench::mm1_customers_floor(kSeed, kFirings);
            }));
            hash = sums.log_hash;
            values = {sums.mean_length, sums.mean_stay_s, sums.longest_stay_s};
        }
        const auto near = [](double a, double b) { return std::abs(a - b) <= 1e-9 * std::abs(b); };
        if (hash != floor.log_hash || !near(values[0], floor.mean_length) ||
            !near(values[1], floor.mean_stay_s) || !near(values[2], floor.longest_stay_s)) {
            state.SkipWithError("the log or the statistics differ from the floor's");
            return;
        }
    }
    state.SetItemsProcessed(static_cast<std::int64_t>(kFirings) * state.iterations());
}

// A day of a barber shop, a thousand times: compiled once, played by one thread.
void thousand_days(benchmark::State& state, unsigned threads) {
    const auto net = net::compile(bench::barber_day());
    if (!net) {
        state.SkipWithError(net.error()[0].message.c_str());
        return;
    }
    std::vector<sim::Metric> metrics;
    metrics.push_back({sim::MetricKind::kTokens, net->find_place("waiting").value});
    metrics.push_back({sim::MetricKind::kStay, net->find_place("waiting").value});
    metrics.push_back({sim::MetricKind::kBusy, net->find_place("chair").value});
    const sim::NetExperiment experiment(*net, metrics,
                                        {.limits = {.until = {8 * 3600 * kTicksPerSecond}}});
    double mean = 0;
    for (auto _ : state) {
        state.SetIterationTime(seconds_of(CLOCK_MONOTONIC, [&] {
            mean = sim::replicate(experiment,
                                  {.seed = kSeed, .replications = 1000, .threads = threads})
                       .means[1]
                       .mean;
        }));
    }
    state.counters["mean_wait_s"] = mean;  // the same for every number of threads
    state.SetItemsProcessed(1000 * state.iterations());
}

// Two sweeps side by side in threads of their own, which know nothing of each other.
void two_alone(benchmark::State& state) {
    const auto net = net::compile(bench::barber_day());
    const std::vector<sim::Metric> metrics = {
        {sim::MetricKind::kStay, net->find_place("waiting").value}};
    const sim::NetExperiment experiment(*net, metrics,
                                        {.limits = {.until = {8 * 3600 * kTicksPerSecond}}});
    for (auto _ : state) {
        state.SetIterationTime(seconds_of(CLOCK_MONOTONIC, [&] {
            const auto half = [&] {
                benchmark::DoNotOptimize(
                    sim::replicate(experiment, {.seed = kSeed, .replications = 500}).means[0].mean);
            };
            std::thread other(half);
            half();
            other.join();
        }));
    }
    state.SetItemsProcessed(1000 * state.iterations());
}

}  // namespace

BENCHMARK_CAPTURE(queue_with_identity, floor, false)->UseManualTime();
BENCHMARK_CAPTURE(queue_with_identity, engine, true)->UseManualTime();
BENCHMARK_CAPTURE(thousand_days, one_thread, 1)->UseManualTime();
BENCHMARK_CAPTURE(thousand_days, two_threads, 2)->UseManualTime();
BENCHMARK(two_alone)->UseManualTime();
BENCHMARK_MAIN();
