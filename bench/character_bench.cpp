// SPDX-License-Identifier: MIT
// How long a character takes from the bytes of its file to a figure that can perform: CesiumMan.glb
// of ../shared/motion (or the file that the environment variable PUPPETRI_CHARACTER names). The
// floor in the same run is reading every byte of the file once. Every pass checks that it made what
// the first pass made.
#include <benchmark/benchmark.h>

#include <cstdint>
#include <cstdlib>
#include <string>

#include "puppetri/base/hash.h"
#include "puppetri/figure/character.h"
#include "puppetri/io/character_reader.h"
#include "puppetri/io/disk_files.h"

namespace {

using namespace puppetri;

std::string path() {
    const char* named = std::getenv("PUPPETRI_CHARACTER");
    return named != nullptr ? named : PUP_SOURCE_DIR "/../shared/motion/CesiumMan.glb";
}

const std::string& bytes() {
    static const std::string all = [] {
        auto read = io::DiskFiles().read(path());
        return read ? std::move(*read) : std::string();
    }();
    return all;
}

std::uint64_t hash_of(const figure::Character& c) {
    std::string text;
    const auto put = [&](const auto& list) {
        text.append(reinterpret_cast<const char*>(list.data()), list.size() * sizeof(list[0]));
    };
    put(c.mesh.positions);
    put(c.mesh.normals);
    put(c.mesh.weights);
    for (const figure::Joint& joint : c.skeleton.joints) {
        text += joint.name;
    }
    return hash_text(text);
}

// From bytes in memory to a humanoid with its rig.
figure::Character make() {
    scene::CharacterRequest request;
    request.path = path();
    request.height_m = 1.7;
    const auto document = io::GltfDocument::parse(bytes(), request.path, nullptr);
    Diagnostics notes;
    return io::read_character(document.value(), request, notes).value();
}

void load(benchmark::State& state) {
    if (bytes().empty()) {
        state.SkipWithError("skipped: there is no such file; set PUPPETRI_CHARACTER");
        return;
    }
    static const std::uint64_t first = hash_of(make());
    for (auto _ : state) {
        const figure::Character c = make();
        state.PauseTiming();
        if (hash_of(c) != first) {
            state.SkipWithError("another figure");
        }
        state.ResumeTiming();
    }
}
BENCHMARK(load)->Unit(benchmark::kMillisecond);

void parse_alone(benchmark::State& state) {
    if (bytes().empty()) {
        state.SkipWithError("skipped: there is no such file; set PUPPETRI_CHARACTER");
        return;
    }
    for (auto _ : state) {
        benchmark::DoNotOptimize(io::GltfDocument::parse(bytes(), path(), nullptr));
    }
}
BENCHMARK(parse_alone)->Unit(benchmark::kMillisecond);

void floor_of_bytes(benchmark::State& state) {
    for (auto _ : state) {
        benchmark::DoNotOptimize(hash_text(bytes()));
    }
}
BENCHMARK(floor_of_bytes)->Unit(benchmark::kMillisecond);

// Carrying one pose from the humanoid to the character's own joints.
void carry(benchmark::State& state) {
    if (bytes().empty()) {
        state.SkipWithError("skipped: there is no such file; set PUPPETRI_CHARACTER");
        return;
    }
    const figure::Character c = make();
    const figure::Pose pose = figure::rest_pose(c.humanoid->figure.skeleton);
    figure::Pose raw;
    for (auto _ : state) {
        c.carry(pose, raw);
        benchmark::DoNotOptimize(raw.parent_from_joint.data());
    }
}
BENCHMARK(carry)->Unit(benchmark::kMicrosecond);

}  // namespace

BENCHMARK_MAIN();
