// SPDX-License-Identifier: MIT
// Queue blocks beside the same models written as bare nets, in one process: M/M/1, a tandem of
// three stations, three classes with priorities; and 1 000 days of the stochastic barber shop as
// `puppetri sweep` plays them on one thread.
//
// Prints CSV: name, million firings per second as a block, as a net, block time over net time, hash
// of the block's log. The two logs must have the same times (their names differ). Exits 1 when the
// ratio is above 1.5, or logs differ.
#include <time.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "puppetri/base/hash.h"
#include "puppetri/run/player.h"
#include "puppetri/scene/scene.h"
#include "puppetri/sim/net_experiment.h"

namespace {

using namespace puppetri;

constexpr std::uint64_t kFirings = 600'000;
constexpr int kRounds = 5;

double now_s() {
    timespec t{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

scene::Scene load(const std::string& body) {
    scene::MemoryFiles files;
    files.add("scene.pup", body);
    auto loaded = scene::load(files, "scene.pup");
    if (!loaded) {
        for (const Diagnostic& d : loaded.error()) {
            std::fprintf(stderr, "%s\n", d.message.c_str());
        }
        std::exit(2);
    }
    return std::move(*loaded);
}

// The times of all firings: what a block and a net have in common.
struct Times final : run::LogSink {
    Hash64 hash;
    void fired(SimTime at, net::TransitionIndex) override {
        hash.add_u64(static_cast<std::uint64_t>(at.ticks));
    }
};

double seconds_of(const scene::Scene& scene, std::uint64_t& hash) {
    double best = 1e9;
    for (int i = 0; i < kRounds; ++i) {
        run::Player player(scene.net, {.seed = 1});
        const double start = now_s();
        player.run({.until = SimTime::never(), .firings = kFirings});
        best = std::min(best, now_s() - start);
    }
    Times times;
    run::Player player(scene.net, {.seed = 1, .sink = &times});
    player.run({.until = SimTime::never(), .firings = kFirings});
    hash = times.hash.value();
    return best;
}

struct Model {
    const char* name;
    const char* block;
    const char* net;
};

// The names are those that the blocks give, so that the random streams are the same.
const Model kModels[] = {
    {"mm1", R"(scene "x"
use shop
queue shop {
  source door every exponential(10 s)
  station chair serves exponential(8 s)
  sink home
  door -> chair
  chair -> home
}
)",
     R"(scene "x"
use shop
net shop {
  place door takes exponential(10 s) tokens 1
  place chair_queue
  place chair_free tokens 1
  place chair takes exponential(8 s)
  door_to_chair: door -> door + chair_queue
  chair_start: chair_queue + chair_free -> chair
  chair_to_home: chair -> chair_free
}
)"},
    {"tandem", R"(scene "x"
use shop
queue shop {
  source door every exponential(10 s)
  station a serves exponential(8 s)
  station b servers 2 serves exponential(15 s)
  station c serves 2 .. 9 s
  sink home
  door -> a
  a -> b probability 0.75
  a -> home
  b -> c
  c -> home
}
)",
     R"(scene "x"
use shop
net shop {
  place door takes exponential(10 s) tokens 1
  place a_queue
  place a_free tokens 1
  place a takes exponential(8 s)
  place b_queue
  place b_free tokens 2
  place b takes exponential(15 s)
  place c_queue
  place c_free tokens 1
  place c takes 2 .. 9 s
  door_to_a: door -> door + a_queue
  a_start: a_queue + a_free -> a
  a_to_b: a -> a_free + b_queue odds 0.75
  a_to_home: a -> a_free odds 0.25
  b_start: b_queue + b_free -> b
  b_to_c: b -> b_free + c_queue
  c_start: c_queue + c_free -> c
  c_to_home: c -> c_free
}
)"},
    {"classes", R"(scene "x"
use shop
queue shop {
  customer Client(rank: 0 .. 2 = 0)
  source door every exponential(10 s)
  station chair serves exponential(8 s) order most rank
  sink home
  door -> chair probability 0.2 { rank := 2 }
  door -> chair probability 0.3 { rank := 1 }
  door -> chair
  chair -> home
}
)",
     R"(scene "x"
use shop
net shop {
  token Client(rank: 0 .. 2)
  place door takes exponential(10 s) tokens 1
  place chair_queue of Client discipline most rank
  place chair_free tokens 1
  place chair of Client takes exponential(8 s)
  door_to_chair: door -> door + chair_queue(rank = 2) odds 0.2
  door_to_chair_2: door -> door + chair_queue(rank = 1) odds 0.3
  door_to_chair_3: door -> door + chair_queue(rank = 0) odds 0.5
  chair_start: chair_queue(rank = r) + chair_free -> chair(rank = r)
  chair_to_home: chair(rank = r) -> chair_free
}
)"},
};

int days() {
    std::ifstream in(PUP_SOURCE_DIR "/examples/11_barber_shop/day.pup", std::ios::binary);
    const scene::Scene scene = load({std::istreambuf_iterator<char>(in), {}});
    sim::NetExperiment::Options options;
    options.limits.until = scene.horizon.time.value_or(SimTime{0});
    const sim::NetExperiment experiment(scene.net, sim::all_metrics(scene.net), options);
    double best = 1e9;
    Hash64 hash;
    for (int i = 0; i < kRounds; ++i) {
        const double start = now_s();
        const sim::Outcome out = sim::replicate(experiment, {.seed = 1, .replications = 1000});
        best = std::min(best, now_s() - start);
        Hash64 h;
        for (const double x : out.values) {
            h.add_f64(x);
        }
        hash = h;
    }
    std::printf("barber_shop_1000_days,%.4f s,,,%016llx\n", best,
                static_cast<unsigned long long>(hash.value()));
    return 0;
}

}  // namespace

int main() {
    int bad = 0;
    std::puts("name,block,net,ratio,hash");
    for (const Model& m : kModels) {
        std::uint64_t block_hash = 0, net_hash = 0;
        const double block = seconds_of(load(m.block), block_hash);
        const double net = seconds_of(load(m.net), net_hash);
        const bool good = block_hash == net_hash && block <= 1.5 * net;
        bad += good ? 0 : 1;
        std::printf("%s,%.2f,%.2f,%.2f,%016llx%s\n", m.name, 1e-6 * kFirings / block,
                    1e-6 * kFirings / net, block / net, static_cast<unsigned long long>(block_hash),
                    block_hash == net_hash ? "" : ",logs differ");
    }
    return days() + (bad > 0 ? 1 : 0);
}
