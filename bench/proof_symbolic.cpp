// SPDX-License-Identifier: MIT
// Symbolic counts: states and edges of the contest's nets in ../shared/nets/mcc (or
// PUPPETRI_NETS/mcc) and of two families with closed forms up to N = 100, from the plain net to the
// printed number. A wrong count reports an error and no time.
#include <benchmark/benchmark.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "proof/classic_nets.h"
#include "puppetri/io/load_net.h"
#include "puppetri/net/net.h"
#include "puppetri/proof/symbolic.h"

namespace {

using namespace puppetri;
using proof::PlainNet;
using proof::SymbolicSpace;

void measure(benchmark::State& state, const PlainNet& net, const std::string& states,
             const std::string& edges) {
    std::uint64_t bytes = 0;
    for (auto _ : state) {
        proof::Budget budget;
        budget.seconds = 60;
        budget.bytes = std::uint64_t{1} << 30;
        SymbolicSpace space(net, budget);
        const auto counted = space.count(space.all()), fired = space.edges(space.all());
        if (!counted.has_value() || !fired.has_value()) {
            state.SkipWithError(proof::name_of(space.ended()));
            return;
        }
        if (counted->decimal() != states || fired->decimal() != edges) {
            state.SkipWithError("the count differs from the known one");
            return;
        }
        bytes = space.peak_bytes();
    }
    state.counters["peak_MB"] = static_cast<double>(bytes) / 1e6;
}

void add(const std::string& name, PlainNet net, const std::string& states,
         const std::string& edges) {
    benchmark::RegisterBenchmark(("symbolic/" + name).c_str(), [=](benchmark::State& state) {
        measure(state, net, states, edges);
    })->Unit(benchmark::kMillisecond);
}

void add_contest_nets() {
    const char* elsewhere = std::getenv("PUPPETRI_NETS");
    const std::filesystem::path folder =
        (elsewhere != nullptr ? std::filesystem::path(elsewhere)
                              : std::filesystem::path(PUP_SOURCE_DIR) / "../shared/nets") /
        "mcc";
    std::ifstream answers(folder / "answers.tsv");
    std::string line;
    std::getline(answers, line);  // model places transitions arcs states edges ...
    while (std::getline(answers, line)) {
        std::istringstream cells(line);
        std::string model, places, transitions, arcs, states, edges;
        cells >> model >> places >> transitions >> arcs >> states >> edges;
        const Checked<io::NetFile> file = io::load_net((folder / model / "model.pnml").string());
        const Checked<net::Net> net = file.has_value() ? net::compile(file->draft) : net::Net();
        if (file.has_value() && net.has_value()) {
            add(model, proof::plain(*net).net, states, edges);
        }
    }
}

void add_families() {
    for (const std::uint32_t n : {10u, 20u, 50u, 100u}) {
        Natural power = 1;  // 3^(n - 2)
        for (std::uint32_t i = 2; i < n; ++i) {
            power *= 3;
        }
        Natural states = power, eating = power, voting = power;
        states *= 9;
        eating *= 7 * n;
        voting *= 3 * 2 * n;
        add("Philosophers/" + std::to_string(n), proof::test::philosophers(n), states.decimal(),
            eating.decimal());
        add("Referendum/" + std::to_string(n), proof::test::referendum(n), (states + 1).decimal(),
            (voting + 1).decimal());
    }
}

}  // namespace

int main(int argc, char** argv) {
    benchmark::Initialize(&argc, argv);
    add_contest_nets();
    add_families();
    benchmark::RunSpecifiedBenchmarks();
    return 0;
}
