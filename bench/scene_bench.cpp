// SPDX-License-Identifier: MIT
// Speed of a whole scene, the ball game of 40 s: from its text to the bytes of a .glb, step by step
// and in all, and frames of its film per second. Every step checks that it made what the first pass
// made.
#include <benchmark/benchmark.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "puppetri/base/hash.h"
#include "puppetri/figure/prop_mesh.h"
#include "puppetri/io/disk_files.h"
#include "puppetri/io/gltf_writer.h"
#include "puppetri/io/take.h"
#include "puppetri/render/camera.h"
#include "puppetri/render/film.h"
#include "puppetri/render/picture.h"
#include "puppetri/scene/perform.h"
#include "puppetri/scene/scene.h"

namespace {

using namespace puppetri;

const std::string kBall = PUP_SOURCE_DIR "/examples/03_ball/ball.pup";

scene::Scene load_ball() {
    io::DiskFiles files;
    return scene::load(files, kBall).value();
}

io::Take take_of(const scene::Scene& scene, const stage::Performance& performance) {
    io::TakeOptions options;
    options.rate = {scene.frame_rate.numerator, scene.frame_rate.denominator};
    return io::sample_take(performance, options).value();
}

std::string glb_of(const io::Take& take) {
    return io::make_glb({.takes = {&take, 1}, .sets = {}, .cameras = {}}, {});
}

// One whole pass, for comparison.
struct Reference {
    scene::Scene scene = load_ball();
    scene::Performed performed = scene::perform(scene).value();
    io::Take take = take_of(scene, *performed.performance);
    std::uint64_t glb_hash = hash_text(glb_of(take));
};
const Reference& reference() {
    static const Reference once;
    return once;
}

void load(benchmark::State& state) {
    for (auto _ : state) {
        const scene::Scene scene = load_ball();
        if (scene.net.hash() != reference().scene.net.hash()) {
            state.SkipWithError("another net");
            return;
        }
    }
}

void perform(benchmark::State& state) {
    for (auto _ : state) {
        const scene::Performed performed = scene::perform(reference().scene).value();
        if (performed.log_hash != reference().performed.log_hash) {
            state.SkipWithError("another log");
            return;
        }
    }
}

void take(benchmark::State& state) {
    for (auto _ : state) {
        const io::Take made = take_of(reference().scene, *reference().performed.performance);
        if (made.times.size() != reference().take.times.size()) {
            state.SkipWithError("another take");
            return;
        }
    }
}

void glb(benchmark::State& state) {
    for (auto _ : state) {
        if (hash_text(glb_of(reference().take)) != reference().glb_hash) {
            state.SkipWithError("another file");
            return;
        }
    }
}

void all(benchmark::State& state) {
    const std::string path =
        (std::filesystem::temp_directory_path() / "puppetri_bench.glb").string();
    for (auto _ : state) {
        const scene::Scene scene = load_ball();
        const scene::Performed performed = scene::perform(scene).value();
        const io::Take made = take_of(scene, *performed.performance);
        if (!io::write_gltf(path, {.takes = {&made, 1}, .sets = {}, .cameras = {}}, {}) ||
            performed.log_hash != reference().performed.log_hash) {
            state.SkipWithError("not written, or another log");
            break;
        }
    }
    std::filesystem::remove(path);
}

// Two seconds of film by two threads; with encoding where ffmpeg is there.
void film(benchmark::State& state) {
    if (!render::why_no_pictures().empty() || !render::have_ffmpeg()) {
        state.SkipWithError("no pictures or no ffmpeg on this machine");
        return;
    }
    const Reference& r = reference();
    const render::CameraPath camera(r.scene.cameras.empty()
                                        ? render::default_camera(*r.performed.performance)
                                        : r.scene.cameras.front(),
                                    *r.performed.performance, 16.0 / 9);
    const render::RenderScene scene{.performance = r.performed.performance.get(),
                                    .camera = &camera,
                                    .sets = r.scene.play.cast.sets,
                                    .look = {}};
    const render::FilmFormat format{.width = 1280,
                                    .height = 720,
                                    .rate = r.scene.frame_rate,
                                    .first_frame = 0,
                                    .last_frame = 47,
                                    .threads = 2};
    const std::string path =
        (std::filesystem::temp_directory_path() / "puppetri_bench.mp4").string();
    for (auto _ : state) {
        auto sink = render::FfmpegSink::start(format, path, ".mp4");
        if (!sink || !render::draw_film(scene, format, *sink.value()) || !sink.value()->finish()) {
            state.SkipWithError("no film");
            break;
        }
    }
    state.SetItemsProcessed(48 * state.iterations());
    std::filesystem::remove(path);
}

}  // namespace

BENCHMARK(load)->Name("ball/load")->Unit(benchmark::kMillisecond);
BENCHMARK(perform)->Name("ball/perform")->Unit(benchmark::kMillisecond);
BENCHMARK(take)->Name("ball/take")->Unit(benchmark::kMillisecond);
BENCHMARK(glb)->Name("ball/glb")->Unit(benchmark::kMillisecond);
BENCHMARK(all)->Name("ball/all")->Unit(benchmark::kMillisecond);
BENCHMARK(film)
    ->Name("ball/film_1280x720")
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime()
    ->Iterations(1);
BENCHMARK_MAIN();
