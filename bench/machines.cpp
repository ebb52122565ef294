// SPDX-License-Identifier: MIT
// A model of machines against the same model written as a bare net: who asks, who works and a
// counter for each of some pairs, with drawn durations. Both load through the language, and must
// play the same log, hash for hash; the bare net is the floor, in the same process.
//   bench_machines [pairs] [seconds of model time]
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <string>

#include "puppetri/run/player.h"
#include "puppetri/scene/scene.h"

namespace puppetri::bench {
namespace {

std::string header() { return "language 1\nscene \"machines\"\nenum Order { work, rest }\n"; }

std::string machines(int pairs) {
    std::string text = header() + R"(machine asker(orders: channel, news: channel) {
  data heard: 0 .. 9
  state thinks takes exponential(1 s) starts
  state waits
  ask:  thinks -> waits send orders!work
  hear: waits -> thinks receive news?heard
}
machine worker(orders: channel, news: channel) {
  data done: 0 .. 9
  state idle starts
  state busy takes 0.2 .. 0.4 s
  obey: idle -> busy receive orders?work set done := (done + 1) mod 10
  tell: busy -> idle send news!done
}
)";
    for (int k = 0; k < pairs; ++k) {
        const std::string i = std::to_string(k);
        text += "channel o" + i + " of Order\nchannel n" + i + " of 0 .. 9\nuse asker(o" + i +
                ", n" + i + ") as a" + i + "\nuse worker(o" + i + ", n" + i + ") as w" + i + "\n";
    }
    return text;
}

// Each name is the path that it has in the machines.
std::string bare(int pairs) {
    std::string text = header();
    for (int k = 0; k < pairs; ++k) {
        const std::string a = "a" + std::to_string(k) + ".", w = "w" + std::to_string(k) + ".";
        const auto q = [](const std::string& name) { return "'" + name + "'"; };
        text += "data " + q(a + "heard") + ": 0 .. 9\ndata " + q(w + "done") + ": 0 .. 9\n";
        text += "place " + q(a + "thinks") + " takes exponential(1 s) tokens 1\nplace " +
                q(a + "waits") + "\nplace " + q(w + "idle") + " tokens 1\nplace " + q(w + "busy") +
                " takes 0.2 .. 0.4 s\n";
        text += q(a + "ask|" + w + "obey") + ": " + q(a + "thinks") + " + " + q(w + "idle") +
                " -> " + q(a + "waits") + " + " + q(w + "busy") + " set " + q(w + "done") +
                " := (" + q(w + "done") + " + 1) mod 10\n";
        text += q(w + "tell|" + a + "hear") + ": " + q(w + "busy") + " + " + q(a + "waits") +
                " -> " + q(w + "idle") + " + " + q(a + "thinks") + " set " + q(a + "heard") +
                " := " + q(w + "done") + "\n";
    }
    return text;
}

scene::Scene load(const std::string& text) {
    scene::MemoryFiles files;
    files.add("bench.pup", text);
    Checked<scene::Scene> scene = scene::load(files, "bench.pup");
    if (!scene) {
        for (const Diagnostic& d : scene.error()) {
            std::fprintf(stderr, "%u: %s: %s\n", d.where.line, d.element.c_str(),
                         d.message.c_str());
        }
        std::exit(1);
    }
    return std::move(*scene);
}

struct Run {
    double cpu_s = 1e300;
    std::uint64_t firings = 0, hash = 0;
};

void play(const scene::Scene& scene, double seconds, Run& out) {
    run::Player player(scene.net, {.seed = 7});
    const std::clock_t begin = std::clock();
    player.run({.until = {static_cast<std::int64_t>(seconds * kTicksPerSecond)}});
    out.cpu_s = std::min(out.cpu_s, static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC);
    out.firings = player.firings();
    out.hash = player.log_hash();
}

}  // namespace
}  // namespace puppetri::bench

int main(int argc, char** argv) {
    using namespace puppetri::bench;
    const int pairs = argc > 1 ? std::atoi(argv[1]) : 20;
    const double seconds = argc > 2 ? std::atof(argv[2]) : 20'000;
    const auto machine = load(machines(pairs));
    const auto net = load(bare(pairs));
    Run ours, floor;
    for (int k = 0; k < 5; ++k) {  // in turn, so that both meet the same machine
        play(machine, seconds, ours);
        play(net, seconds, floor);
    }
    const auto rate = [](const Run& r) { return static_cast<double>(r.firings) / r.cpu_s / 1e6; };
    std::printf("model,firings,cpu_s,million_firings_per_s,log_hash\n");
    std::printf("machines,%llu,%.3f,%.2f,%016llx\n", static_cast<unsigned long long>(ours.firings),
                ours.cpu_s, rate(ours), static_cast<unsigned long long>(ours.hash));
    std::printf("bare net,%llu,%.3f,%.2f,%016llx\n", static_cast<unsigned long long>(floor.firings),
                floor.cpu_s, rate(floor), static_cast<unsigned long long>(floor.hash));
    std::printf("ratio,%.2f\n", ours.cpu_s / floor.cpu_s);
    return ours.hash == floor.hash && ours.firings == floor.firings ? 0 : 1;
}
