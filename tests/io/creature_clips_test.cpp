// SPDX-License-Identifier: MIT
// Creatures that play the clips of their own files: what the joints do on the stage against what
// the nodes of the file do, multiplied here.
#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <vector>

#include "io/scene_files.h"
#include "puppetri/figure/character.h"
#include "puppetri/io/clip_file.h"
#include "puppetri/scene/perform.h"

using namespace puppetri;
using namespace puppetri::io::testing;

namespace {

// All distances between joints of a figure and of the nodes, in the same proportion throughout.
void moves_as_nodes(const char* file, const char* take, double height_m) {
    CAPTURE(file);
    SceneFiles files("language 1\nscene \"s\"\nuntil 5 s\ncast { me: creature { file \"" + kMotion +
                     file + "\", height " + std::to_string(height_m) + " m } }\nclip c { from \"" +
                     kMotion + file + "\", take \"" + take +
                     "\" }\nplace p does me.c() tokens 1\nend { p }\n");
    const auto scene = scene::load(files, "scene.pup");
    if (!scene) {
        FAIL(scene.error().front().element << ": " << scene.error().front().message);
    }
    const auto played = scene::perform(*scene);
    REQUIRE(played.has_value());
    const figure::Skeleton& skeleton = *played->performance->actors()[0].skeleton;
    const auto loaded = io::load_clips(kMotion + file);
    REQUIRE(loaded.has_value());
    const motion::Clip* clip = nullptr;
    for (const motion::Clip& c : loaded->clips) {
        clip = c.name == take ? &c : clip;
    }
    REQUIRE(clip != nullptr);
    const motion::ClipBinding binding = motion::bind_clip(*clip, loaded->skeleton);
    std::vector<std::size_t> mine, nodes;
    for (std::size_t j = 1; j < skeleton.joints.size(); ++j) {
        const figure::JointIndex node = loaded->skeleton.find(skeleton.joints[j].name);
        if (node.valid()) {
            mine.push_back(j);
            nodes.push_back(node.value);
        }
    }
    REQUIRE(mine.size() > 10);
    double scale = 0;
    for (double t = 0.4; t < 0.95 * clip->duration_s; t += 0.1) {
        CAPTURE(t);
        figure::Pose pose, raw = figure::rest_pose(loaded->skeleton);
        played->performance->pose({0}, SimTime{static_cast<std::int64_t>(t * kTicksPerSecond)},
                                  pose);
        std::vector<Transform> world(skeleton.joints.size()), model(loaded->skeleton.joints.size());
        figure::to_model_space(skeleton, pose, world);
        // The place lasts whole milliseconds.
        const double whole_s = std::ceil(clip->duration_s * 1000 - 1e-9) / 1000;
        motion::sample_clip(*clip, binding, t * clip->duration_s / whole_s, raw);
        figure::to_model_space(loaded->skeleton, raw, model);
        for (std::size_t a = 0; a < mine.size(); ++a) {
            for (std::size_t b = 0; b < a; ++b) {
                const double ours = length(world[mine[a]].translation - world[mine[b]].translation);
                const double theirs =
                    length(model[nodes[a]].translation - model[nodes[b]].translation);
                if (scale == 0 && theirs > 1e-3) {
                    scale = ours / theirs;
                }
                REQUIRE(ours == doctest::Approx(theirs * scale).epsilon(1e-5).scale(height_m));
            }
        }
    }
}

}  // namespace

TEST_CASE("a creature that plays a clip of its own file moves as its nodes [oracle]") {
    if (there("Fox.glb")) {
        moves_as_nodes("Fox.glb", "Run", 0.6);
        moves_as_nodes("Fox.glb", "Survey", 0.6);
    }
    if (there("robot.glb")) {
        moves_as_nodes("robot.glb", "Robot_Dance", 1.5);
        moves_as_nodes("robot.glb", "Robot_Walking", 1.5);
    }
}

TEST_CASE("the example of the fox that runs: where it is follows from the net [unit]") {
    if (!there("Fox.glb")) {
        return;
    }
    io::DiskFiles files;
    files.replace("Fox.glb", kMotion + "Fox.glb");
    const auto scene = scene::load(files, PUP_SOURCE_DIR "/examples/07_creatures/fox_runs.pup");
    REQUIRE(scene.has_value());
    const auto played = scene::perform(*scene);
    REQUIRE(played.has_value());
    // It looks about for 3.417 s, trots at 1 m/s for 1.4 s, runs at 2.4 m/s for 2.3 s. Whole rounds
    // last a little more or less than their own time, and the way goes with them: 2 rounds of
    // 17/24 s, then 2 of 1.158 s.
    const auto at = [&](double t) {
        figure::Pose pose;
        played->performance->pose({0}, SimTime{static_cast<std::int64_t>(t * kTicksPerSecond)},
                                  pose);
        return pose.parent_from_joint[0].translation;
    };
    CHECK(length(at(3.4) - Vec3{0, 0, -4}) < 1e-9);
    const double begins = 3.417, trots = 2 * 17.0 / 24 * 1.0, runs = 2 * 2.4 * 27.8 / 24;
    CHECK(at(begins + 1.4).z == doctest::Approx(-4 + trots).epsilon(1e-3));
    CHECK(at(begins + 3.7).z == doctest::Approx(-4 + trots + runs).epsilon(2e-3));
    CHECK(at(11).x == 0);
}
