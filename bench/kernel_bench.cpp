// SPDX-License-Identifier: MIT
// Speed of the kernel: each model by the engine and by its hand-written floor, in one run. An
// engine whose log hash differs from the floor's reports an error and no time.
#include <benchmark/benchmark.h>
#include <time.h>

#include <algorithm>
#include <string>

#include "floor.h"
#include "models.h"
#include "puppetri/net/net.h"
#include "puppetri/run/player.h"

namespace {

using namespace puppetri;

constexpr std::uint64_t kSeed = 7;

// Time of the processor that this thread used: other programs on the machine do not count.
double seconds_of(auto&& work) {
    const auto now = [] {
        timespec t{};
        clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
        return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
    };
    const double start = now();
    work();
    return now() - start;
}

// So many firings from the start, the building of net and player not counted.
void measure_engine(benchmark::State& state, const net::NetDraft& draft, std::uint64_t firings,
                    std::uint64_t wanted) {
    const Checked<net::Net> net = net::compile(draft);
    if (!net.has_value()) {
        state.SkipWithError(net.error()[0].message.c_str());
        return;
    }
    for (auto _ : state) {
        // Large nets do more in one instant than the usual bound on endless ones allows.
        run::Player player(*net, {.seed = kSeed, .firings_per_instant = 1'000'000'000});
        state.SetIterationTime(seconds_of([&] { player.run({.firings = firings}); }));
        if (player.log_hash() != wanted || player.firings() != firings) {
            state.SkipWithError("the log differs from the floor's");
            return;
        }
    }
    state.SetItemsProcessed(static_cast<std::int64_t>(firings) * state.iterations());
    state.counters["places"] = static_cast<double>(draft.places.size());
}

template <class Floor>
void measure_floor(benchmark::State& state, Floor floor, std::uint64_t firings) {
    for (auto _ : state) {
        std::uint64_t hash = 0;
        state.SetIterationTime(seconds_of([&] { hash = floor(firings); }));
        benchmark::DoNotOptimize(hash);
    }
    state.SetItemsProcessed(static_cast<std::int64_t>(firings) * state.iterations());
}

template <class Draft, class Floor>
void add(const std::string& name, std::uint64_t firings, Draft draft, Floor floor) {
    benchmark::RegisterBenchmark((name + "/floor").c_str(), [=](benchmark::State& state) {
        measure_floor(state, floor, firings);
    })->UseManualTime();
    benchmark::RegisterBenchmark((name + "/engine").c_str(), [=](benchmark::State& state) {
        measure_engine(state, draft(), firings, floor(firings));
    })->UseManualTime();
}

void add_philosophers(std::uint32_t n, std::uint64_t firings) {
    add(
        "philosophers/" + std::to_string(n), firings, [n] { return bench::philosophers(n); },
        [n](std::uint64_t f) { return bench::philosophers_floor(n, kSeed, f); });
}

}  // namespace

int main(int argc, char** argv) {
    add_philosophers(5, 1'000'000);
    add_philosophers(1000, 1'000'000);
    add(
        "hold/1000", 500'000, [] { return bench::hold(1000); },
        [](std::uint64_t f) { return bench::hold_floor(1000, kSeed, f); });
    add(
        "mm1", 1'000'000, [] { return bench::mm1(); },
        [](std::uint64_t f) { return bench::mm1_floor(kSeed, f); });
    for (const std::uint32_t places : {1'000u, 10'000u, 100'000u, 1'000'000u}) {
        add_philosophers(places / 5, std::max<std::uint64_t>(200'000, 4 * places));
    }
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) {
        return 2;
    }
    benchmark::RunSpecifiedBenchmarks();
    benchmark::Shutdown();
    return 0;
}
