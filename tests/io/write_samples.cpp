// SPDX-License-Identifier: MIT
// Writes glTF files of every kind into a folder, for other people's readers: write_samples FOLDER.
#include <cstdio>

#include "puppetri/io/gltf_writer.h"
#include "support/fake_performance.h"

using namespace puppetri;

int main(int argc, char** argv) {
    if (argc != 2) {
        return 2;
    }
    const std::string folder = argv[1];
    const test::FakePerformance performance;
    const auto write = [&](const char* name, const io::TakeOptions& take_options,
                           const io::GltfOptions& options) {
        const auto take = io::sample_take(performance, take_options);
        const io::StaticMesh floor{"floor", performance.props()[0].mesh, {}};
        io::CameraTrack camera{"main", 0.6, 1.5, {}};
        camera.world_from_camera.assign(take->times.size(), {{}, {0, 1.6, 8}});
        const auto written = io::write_gltf(
            folder + "/" + name,
            {std::span(&*take, 1), std::span(&floor, 1), std::span(&camera, 1)}, options);
        return written.has_value();
    };
    const auto clips = io::sample_clips(performance, {});
    const bool good = write("plain.glb", {}, {.title = "Ana & \"Rui\""}) &&
                      write("text.gltf", {.rate = {60000, 1001}}, {}) &&
                      write("loop.glb", {.root = io::RootMode::kInPlace, .loop = true},
                            {.names = io::BoneNames::kRigify}) &&
                      write("reduced.glb", {.rest = io::RestPose::kA},
                            {.names = io::BoneNames::kMixamo, .reduce_m = 1e-3}) &&
                      write("still.glb", {.frames = io::FrameRange{0, 0}}, {}) && clips &&
                      io::write_gltf(folder + "/clips.glb", {*clips, {}, {}}, {}).has_value();
    return good ? 0 : 1;
}
