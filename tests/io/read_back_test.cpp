// SPDX-License-Identifier: MIT
// The reference scenes, exported and read back by readers that share no code with Puppetri, are
// measured again in the file's own frames: what arrives in other programs is what was promised.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "puppetri/io/bvh_writer.h"
#include "puppetri/io/disk_files.h"
#include "puppetri/io/gltf_writer.h"
#include "puppetri/scene/perform.h"
#include "support/bvh_reader.h"
#include "support/gltf_reader.h"
#include "support/measure.h"

using namespace puppetri;

namespace {

struct Example {
    std::unique_ptr<scene::Scene> scene;
    scene::Performed performed;
    const stage::Performance& performance() const { return *performed.performance; }
};

const Example& example(const std::string& name) {
    static std::vector<std::pair<std::string, std::unique_ptr<Example>>> loaded;
    for (const auto& [known, found] : loaded) {
        if (known == name) {
            return *found;
        }
    }
    io::DiskFiles files;
    auto scene = scene::load(files, PUP_SOURCE_DIR "/examples/" + name);
    REQUIRE(scene);
    auto result = std::make_unique<Example>();
    result->scene = std::make_unique<scene::Scene>(std::move(*scene));
    auto performed = scene::perform(*result->scene);
    REQUIRE(performed);
    result->performed = std::move(*performed);
    loaded.emplace_back(name, std::move(result));
    return *loaded.back().second;
}

io::Take take_of(const Example& e, const io::TakeOptions& options = {}) {
    auto take = io::sample_take(e.performance(), options);
    REQUIRE(take);
    return std::move(*take);
}

// When feet stand, as the performance says.
std::vector<test::Planted> planted_of(const stage::Performance& performance, std::uint32_t actor,
                                      double end_s) {
    std::vector<test::Planted> planted;
    for (int side = 0; side < 2; ++side) {
        const motion::Limb leg = side == 0 ? motion::Limb::kLeftLeg : motion::Limb::kRightLeg;
        constexpr double kStep_s = 1.0 / 480;
        double begin_s = -1;
        for (double t = 0; t <= end_s; t += kStep_s) {
            const SimTime at{static_cast<std::int64_t>(std::llround(t * kTicksPerSecond))};
            const bool stands = performance.phase({actor}, leg, at) == motion::Phase::kSupport;
            if (stands && begin_s < 0) {
                begin_s = t;
            } else if (!stands && begin_s >= 0) {
                planted.push_back({side, begin_s, t - kStep_s});
                begin_s = -1;
            }
        }
        if (begin_s >= 0) {
            planted.push_back({side, begin_s, end_s});
        }
    }
    return planted;
}

Transform from_eigen(const Eigen::Isometry3d& placed, double metres) {
    const Eigen::Quaterniond q(placed.linear());
    const Eigen::Vector3d t = placed.translation() * metres;
    return {{q.x(), q.y(), q.z(), q.w()}, {t.x(), t.y(), t.z()}};
}

void check_feet(const figure::Figure& figure, const stage::Performance& performance,
                std::uint32_t actor, double end_s,
                std::function<void(double, std::span<Transform>)> sample) {
    const test::Measures m = test::measure({.figure = figure,
                                            .sample = std::move(sample),
                                            .begin_s = 0,
                                            .end_s = end_s,
                                            .rate_hz = 24,
                                            .planted = planted_of(performance, actor, end_s)});
    CHECK_MESSAGE(m.slip_mm.value <= 2, m.slip_mm.where, " at ", m.slip_mm.at_s);
    CHECK_MESSAGE(m.sink_mm.value <= 2, m.sink_mm.where, " at ", m.sink_mm.at_s);
    CHECK_MESSAGE(m.hover_mm.value <= 2, m.hover_mm.where, " at ", m.hover_mm.at_s);
    CHECK_MESSAGE(m.swing_sink_mm.value <= 2, m.swing_sink_mm.where, " at ", m.swing_sink_mm.at_s);
}

figure::Figure figure_of(const Example& e, std::uint32_t actor) {
    return figure::make_mannequin(e.scene->play.cast.actors[actor].height_m);
}

}  // namespace

TEST_CASE(
    "feet in the glTF file stand still: slip, sink and hover within 2 mm in its frames [oracle]") {
    for (const char* name : {"02_walk/figure.pup", "03_ball/ball.pup"}) {
        const Example& e = example(name);
        const io::Take take = take_of(e);
        const test::GltfFile file =
            test::read_gltf(io::make_glb({std::span(&take, 1), {}, {}}, {}));
        for (std::uint32_t actor = 0; actor < take.actors.size(); ++actor) {
            const figure::Figure figure = figure_of(e, actor);
            std::vector<std::size_t> nodes;
            for (const figure::Joint& joint : figure.skeleton.joints) {
                nodes.push_back(static_cast<std::size_t>(
                    file.find(take.actors[actor].name + "_" + joint.name)));
            }
            CAPTURE(name);
            CAPTURE(take.actors[actor].name);
            check_feet(figure, e.performance(), actor, take.times.back().seconds(),
                       [&](double t, std::span<Transform> world_from_joint) {
                           const auto world = file.pose(0, t);
                           for (std::size_t j = 0; j < nodes.size(); ++j) {
                               world_from_joint[j] = from_eigen(world[nodes[j]], 1);
                           }
                       });
        }
    }
}

TEST_CASE(
    "feet in the BVH file stand still: slip, sink and hover within 2 mm in its frames [oracle]") {
    const Example& e = example("03_ball/ball.pup");
    const io::Take take = take_of(e, {.root = io::RootMode::kHips});
    for (std::uint32_t actor = 0; actor < take.actors.size(); ++actor) {
        const figure::Figure figure = figure_of(e, actor);
        const test::Bvh bvh = test::read_bvh(io::make_bvh(take, actor, {}));
        CAPTURE(take.actors[actor].name);
        check_feet(
            figure, e.performance(), actor, take.times.back().seconds(),
            [&](double t, std::span<Transform> world_from_joint) {
                const auto frame = static_cast<std::size_t>(std::llround(t / bvh.frame_time_s));
                const auto world = bvh.pose(std::min(frame, bvh.frames.size() - 1));
                world_from_joint[0] = {};  // hips carries the root
                for (std::size_t j = 1; j < world_from_joint.size(); ++j) {
                    const int joint = bvh.find(figure.skeleton.joints[j].name);
                    world_from_joint[j] = from_eigen(world[static_cast<std::size_t>(joint)], 0.01);
                }
            });
    }
}

TEST_CASE(
    "the ball in the glTF file stays at the palms while it is held, between frames too, within 1 "
    "mm [oracle]") {
    const Example& e = example("03_ball/ball.pup");
    const io::Take take = take_of(e);
    const test::GltfFile file = test::read_gltf(io::make_glb({std::span(&take, 1), {}, {}}, {}));
    const auto ball = static_cast<std::size_t>(file.find("ball"));
    const double radius_m = e.performance().props()[0].size_m.x / 2;
    double worst_m = 0, worst_at_s = 0;
    int held = 0;
    for (std::uint32_t actor = 0; actor < take.actors.size(); ++actor) {
        const figure::Figure figure = figure_of(e, actor);
        for (double t = 0; t < take.times.back().seconds(); t += 1.0 / 480) {
            const SimTime at{static_cast<std::int64_t>(std::llround(t * kTicksPerSecond))};
            if (e.performance().holder({0}, at) != take.actors[actor].name + ".hands") {
                continue;
            }
            ++held;
            const auto world = file.pose(0, t);
            for (const auto& [side, name] :
                 {std::pair{0, "_leftHand"}, std::pair{1, "_rightHand"}}) {
                const auto hand =
                    static_cast<std::size_t>(file.find(take.actors[actor].name + name));
                const Transform world_from_hand = from_eigen(world[hand], 1);
                const Vec3 palm =
                    world_from_hand *
                    figure.arms[static_cast<std::size_t>(side)].hand_from_palm.translation;
                const Vec3 centre = from_eigen(world[ball], 1).translation;
                const double gap_m = std::fabs(length(palm - centre) - radius_m);
                if (gap_m > worst_m) {
                    worst_m = gap_m;
                    worst_at_s = t;
                }
            }
        }
    }
    CHECK(held > 1000);
    CHECK_MESSAGE(worst_m <= 1e-3, "at ", worst_at_s);
}

TEST_CASE(
    "the ball game's file has every throw and catch as a marker with a key at its very time "
    "[unit]") {
    const Example& e = example("03_ball/ball.pup");
    const io::Take take = take_of(e);
    std::size_t releases = 0, catches = 0;
    for (const io::TakeEvent& event : take.events) {
        releases += event.name == "release";
        catches += event.name == "catch";
        CHECK(std::binary_search(take.times.begin(), take.times.end(), event.at));
    }
    CHECK(releases >= 3);
    CHECK(catches >= 3);
    CHECK(releases - catches <= 1);
    CHECK(take.frame_count == 961);
}

TEST_CASE("a walk is exported as a loop of one period [unit]") {
    const Example& e = example("03_ball/ball.pup");
    const auto take = io::sample_take(e.performance(), {.loop = true});
    REQUIRE(take);
    for (std::size_t a = 0; a < take->actors.size(); ++a) {
        const auto first = take->pose(a, 0), last = take->pose(a, take->times.size() - 1);
        for (std::size_t j = 1; j < first.size(); ++j) {
            CHECK(first[j] == last[j]);
        }
    }
}
