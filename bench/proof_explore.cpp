// SPDX-License-Identifier: MIT
// The explicit explorer on the five large nets of ../shared/nets/mcc, beside a naive loop in the
// same process: flat byte states, a table of numbers with linear probing, conditions tested arc by
// arc. Both must have the contest's states and edges, or there is an error and no time.
//   explore/MODEL  one thread; counter bytes_per_state: peak memory of a process that explores just
//                  this net, minus the peak of one that explores nothing
//   floor/MODEL    the naive loop
//   threads/MODEL  two threads, real time; counter efficiency: their rate over the rate of two
//                  processes that explore the net independently at the same time
#include <benchmark/benchmark.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <string>
#include <vector>

#include "puppetri/base/hash.h"
#include "puppetri/proof/explorer.h"
#include "support/tiny_pnml.h"

namespace {

using namespace puppetri;
using proof::PlainNet;

struct Model {
    const char* name;
    std::uint64_t states, edges;
};
constexpr Model kModels[] = {{"HouseConstruction-PT-00005", 1187984, 7191110},
                             {"Kanban-PT-00005", 2546432, 24460016},
                             {"FMS-PT-00005", 2895018, 23527185},
                             {"LamportFastMutEx-PT-4", 1914784, 9046048},
                             {"Dekker-PT-015", 278528, 16834575}};

std::string program;  // the path of this program
const std::string kNets = PUP_SOURCE_DIR "/../shared/nets/mcc/";

PlainNet read(const Model& model) { return test::tiny_pnml(kNets + model.name + "/model.pnml"); }

struct Counts {
    std::uint64_t states = 0, edges = 0;
};

// What one writes in an hour: places are bytes, states lie one after another, their order is the
// queue.
class Naive {
 public:
    explicit Naive(const PlainNet& net)
        : net_(net), width_((net.place_count() + 7) / 8 * 8), table_(1 << 16, 0) {}

    Counts explore() {
        std::vector<std::uint8_t> state(width_, 0), next(width_, 0);
        std::copy(net_.initial.begin(), net_.initial.end(), state.begin());
        insert(state.data());
        Counts counts;
        for (; counts.states < count_; ++counts.states) {
            std::memcpy(state.data(), states_.data() + counts.states * width_, width_);
            for (std::uint32_t t = 0; t < net_.transition_count(); ++t) {
                if (!enabled(state.data(), t)) {
                    continue;
                }
                next = state;
                for (const net::Weighted& w : net_.takes.row(t)) {
                    next[w.place] = static_cast<std::uint8_t>(next[w.place] - w.weight);
                }
                for (const net::Weighted& w : net_.gives.row(t)) {
                    next[w.place] = static_cast<std::uint8_t>(next[w.place] + w.weight);
                }
                ++counts.edges;
                insert(next.data());
            }
        }
        return counts;
    }

 private:
    bool enabled(const std::uint8_t* state, std::uint32_t t) const {
        for (const net::Weighted& w : net_.takes.row(t)) {
            if (state[w.place] < w.weight) {
                return false;
            }
        }
        return true;
    }
    std::uint64_t hash(const std::uint8_t* state) const {
        std::uint64_t h = 0;
        for (std::size_t i = 0; i < width_; i += 8) {
            std::uint64_t word = 0;
            std::memcpy(&word, state + i, 8);
            h = (h ^ word) * 0x9E3779B97F4A7C15u;
            h ^= h >> 32;
        }
        return h;
    }
    void insert(const std::uint8_t* state) {
        std::uint64_t at = hash(state) & (table_.size() - 1);
        for (; table_[at] != 0; at = (at + 1) & (table_.size() - 1)) {
            if (std::memcmp(states_.data() + (table_[at] - 1) * width_, state, width_) == 0) {
                return;
            }
        }
        states_.insert(states_.end(), state, state + width_);
        table_[at] = static_cast<std::uint32_t>(++count_);
        if (count_ * 2 > table_.size()) {
            std::vector<std::uint32_t> larger(table_.size() * 2, 0);
            for (std::uint32_t id = 0; id < count_; ++id) {
                std::uint64_t slot = hash(states_.data() + id * width_) & (larger.size() - 1);
                while (larger[slot] != 0) {
                    slot = (slot + 1) & (larger.size() - 1);
                }
                larger[slot] = id + 1;
            }
            table_ = std::move(larger);
        }
    }

    const PlainNet& net_;
    std::size_t width_;
    std::vector<std::uint8_t> states_;
    std::vector<std::uint32_t> table_;
    std::uint64_t count_ = 0;
};

Counts explored(const PlainNet& net, unsigned threads) {
    proof::Budget budget;
    budget.threads = threads;
    budget.seconds = 600;
    const proof::Exploration e = proof::explore(net, {}, budget);
    return {e.states, e.edges};
}

// Gives  false, with an error, where the counts are not the oracle's.
bool check(benchmark::State& state, const Model& model, const Counts& counts) {
    if (counts.states != model.states || counts.edges != model.edges) {
        state.SkipWithError("counts differ from the contest's");
        return false;
    }
    return true;
}

double seconds_now() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

// The peak memory in bytes of a fresh process of this program that explores just one model
// ("none": nothing).
double peak_of(const std::string& model) {
    const std::string command = "'" + program + "' --peak " + model;
    std::FILE* pipe = popen(command.c_str(), "r");
    char line[64] = "";
    const bool read = pipe != nullptr && std::fgets(line, sizeof line, pipe) != nullptr;
    if (pipe != nullptr) {
        pclose(pipe);
    }
    return read ? 1024 * std::strtod(line, nullptr) : 0;
}

int print_peak(const std::string& model) {
    PlainNet net;
    for (const Model& m : kModels) {
        if (model == m.name) {
            net = read(m);
        }
    }
    benchmark::DoNotOptimize(explored(net, 1).edges);
    std::ifstream status("/proc/self/status");
    for (std::string line; std::getline(status, line);) {
        if (line.rfind("VmHWM:", 0) == 0) {
            std::puts(line.substr(6).c_str());
        }
    }
    return 0;
}

double seconds_of_two_processes(const PlainNet& net) {
    const double begin = seconds_now();
    pid_t children[2];
    for (pid_t& child : children) {
        child = fork();
        if (child == 0) {
            benchmark::DoNotOptimize(explored(net, 1).edges);
            _exit(0);
        }
    }
    for (const pid_t child : children) {
        int status = 0;
        waitpid(child, &status, 0);
    }
    return seconds_now() - begin;
}

void explore_benchmark(benchmark::State& state, const Model& model) {
    const PlainNet net = read(model);
    const double bytes = peak_of(model.name) - peak_of("none");
    Counts counts;
    for (auto _ : state) {
        counts = explored(net, 1);
    }
    if (check(state, model, counts)) {
        state.SetItemsProcessed(static_cast<std::int64_t>(model.edges) * state.iterations());
        state.counters["bytes_per_state"] = bytes / static_cast<double>(model.states);
    }
}

void floor_benchmark(benchmark::State& state, const Model& model) {
    const PlainNet net = read(model);
    Counts counts;
    for (auto _ : state) {
        counts = Naive(net).explore();
    }
    if (check(state, model, counts)) {
        state.SetItemsProcessed(static_cast<std::int64_t>(model.edges) * state.iterations());
    }
}

void threads_benchmark(benchmark::State& state, const Model& model) {
    const PlainNet net = read(model);
    Counts counts;
    double together = 1e9, apart = 1e9;
    for (auto _ : state) {
        const double begin = seconds_now();
        counts = explored(net, 2);
        const double seconds = seconds_now() - begin;
        state.SetIterationTime(seconds);
        together = std::min(together, seconds);
        apart = std::min(apart, seconds_of_two_processes(net));
    }
    if (check(state, model, counts)) {
        state.SetItemsProcessed(static_cast<std::int64_t>(model.edges) * state.iterations());
        state.counters["efficiency"] = apart / (2 * together);
    }
}

}  // namespace

int main(int argc, char** argv) {
    program = argv[0];
    if (argc == 3 && std::string(argv[1]) == "--peak") {
        return print_peak(argv[2]);
    }
    for (const Model& model : kModels) {
        const std::string name = model.name;
        const auto add = [&](const char* kind, auto function) {
            return benchmark::RegisterBenchmark(
                (kind + ("/" + name)).c_str(),
                [function, &model](benchmark::State& state) { function(state, model); });
        };
        if (test::text_of_file(kNets + name + "/model.pnml").empty()) {
            continue;  // the nets are not part of the project
        }
        add("explore", explore_benchmark)->Unit(benchmark::kMillisecond);
        add("floor", floor_benchmark)->Unit(benchmark::kMillisecond);
        add("threads", threads_benchmark)->Unit(benchmark::kMillisecond)->UseManualTime();
    }
    benchmark::Initialize(&argc, argv);
    benchmark::RunSpecifiedBenchmarks();
    return 0;
}
