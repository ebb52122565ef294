// SPDX-License-Identifier: MIT
// How long the proof of whole scenes takes: every rule, the built-in ones included. Each line: what
// was proved, seconds of the processor for loading and for proving, peak memory.
#include "support/proof_scenes.h"

#include <sys/resource.h>

#include <cstdio>
#include <string>

#include "puppetri/io/disk_files.h"
#include "puppetri/scene/scene.h"
#include "puppetri/verdict/prove.h"

namespace {

using namespace puppetri;

double cpu_s() {
    rusage u{};
    getrusage(RUSAGE_SELF, &u);
    return static_cast<double>(u.ru_utime.tv_sec + u.ru_stime.tv_sec) +
           1e-6 * static_cast<double>(u.ru_utime.tv_usec + u.ru_stime.tv_usec);
}
double peak_mb() {
    rusage u{};
    getrusage(RUSAGE_SELF, &u);
    return static_cast<double>(u.ru_maxrss) / 1024;
}

bool prove(const char* name, scene::FileSource& files, const std::string& path) {
    const double begin = cpu_s();
    const auto scene = scene::load(files, path);
    if (!scene) {
        std::printf("%s: %s\n", name, scene.error().front().message.c_str());
        return false;
    }
    const double loaded = cpu_s();
    verdict::ProveOptions options;
    options.budget.seconds = 60;
    const auto verdicts = verdict::prove(*scene, options);
    std::size_t proved = 0;
    for (const verdict::Verdict& v : verdicts) {
        proved += v.answer == verdict::Answer::kProved ? 1 : 0;
        if (v.answer != verdict::Answer::kProved) {
            std::printf("  %s %s: %s\n", name_of(v).c_str(), v.rule.c_str(), v.reason.c_str());
        }
    }
    std::printf("%s,%u places,%zu of %zu rules,load %.3f s,prove %.3f s,peak %.1f MB\n", name,
                scene->net.place_count(), proved, verdicts.size(), loaded - begin, cpu_s() - loaded,
                peak_mb());
    return proved == verdicts.size();
}

}  // namespace

int main() {
    io::DiskFiles disk;
    bool good = prove("walk", disk, PUP_SOURCE_DIR "/examples/02_walk/twice.pup");
    good = prove("ball game", disk, PUP_SOURCE_DIR "/examples/03_ball/ball.pup") && good;
    scene::MemoryFiles memory;
    memory.add("pairs.pup", made::pairs_of_players(50));
    memory.add("ring.pup", made::ring_of_players(100, 10));
    good = prove("50 pairs", memory, "pairs.pup") && good;
    good = prove("ring of 100 with 10 balls", memory, "ring.pup") && good;
    return good ? 0 : 1;
}
