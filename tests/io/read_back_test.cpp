// SPDX-License-Identifier: MIT
// The reference scenes, exported and read back by readers that share no code with Puppetri, are
// measured again in the file's own frames: what arrives in other programs is what was promised.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "puppetri/io/bvh_writer.h"
#include "puppetri/io/gltf_writer.h"
#include "support/bvh_reader.h"
#include "support/example_motion.h"
#include "support/gltf_reader.h"

using namespace puppetri;

namespace {

using test::Example;

constexpr const char* kExamples[] = {
    "01_toss/toss.pup",        "02_walk/figure.pup",    "02_walk/limbs.pup",
    "02_walk/legs.pup",        "02_walk/twice.pup",     "02_walk/duty.pup",
    "03_ball/ball.pup",        "03_ball/figure5.pup",   "03_ball/impatient.pup",
    "03_ball/no_ball.pup",     "03_ball/two_balls.pup", "03_ball/waits.pup",
    "10_two_legs/two_legs.pup"};

io::Take take_of(const Example& e, const io::TakeOptions& options = {}) {
    auto take = io::sample_take(e.performance(), options);
    REQUIRE(take);
    return std::move(*take);
}

Transform from_eigen(const Eigen::Isometry3d& placed, double metres) {
    const Eigen::Quaterniond q(placed.linear());
    const Eigen::Vector3d t = placed.translation() * metres;
    return {{q.x(), q.y(), q.z(), q.w()}, {t.x(), t.y(), t.z()}};
}

// The table as far as a file's own frames show it: differences of neighbouring frames.
void check_table(const Example& e, std::uint32_t actor, double end_s,
                 std::function<void(double, std::span<Transform>)> sample) {
    const figure::Figure figure = e.figure(actor);
    const test::Measures m = test::measure({.figure = figure,
                                            .sample = std::move(sample),
                                            .begin_s = 0,
                                            .end_s = end_s,
                                            .rate_hz = 24,
                                            .planted = test::planted_of(e, actor, end_s)});
    CHECK_MESSAGE(m.slip_mm.value <= 2, m.slip_mm.where, " at ", m.slip_mm.at_s);
    CHECK_MESSAGE(m.sink_mm.value <= 2, m.sink_mm.where, " at ", m.sink_mm.at_s);
    CHECK_MESSAGE(m.hover_mm.value <= 2, m.hover_mm.where, " at ", m.hover_mm.at_s);
    CHECK_MESSAGE(m.swing_sink_mm.value <= 2, m.swing_sink_mm.where, " at ", m.swing_sink_mm.at_s);
    // Keys are single precision in glTF and have five digits in BVH.
    CHECK(m.limit_excess_deg.value <= 0.01);
    CHECK(m.knee.speed_rad_s.value <= 10);
    CHECK(m.hip.speed_rad_s.value <= 6);
    CHECK(m.ankle.speed_rad_s.value <= 8);
    CHECK(m.spine.speed_rad_s.value <= 3);
    CHECK(m.neck.speed_rad_s.value <= 6);
    CHECK(m.arm.speed_rad_s.value <= 20);
    for (const test::JointMeasures* j : {&m.knee, &m.hip, &m.ankle, &m.spine, &m.neck}) {
        CHECK(j->acceleration_rad_s2.value <= 400);
    }
    CHECK(m.pelvis_acceleration.value <= 4);
}

}  // namespace

TEST_CASE(
    "every example's glTF file keeps the table of good motion in its frames: feet stand "
    "still within 2 mm [oracle]") {
    for (const char* name : kExamples) {
        const Example& e = test::example(name);
        const io::Take take = take_of(e);
        const test::GltfFile file =
            test::read_gltf(io::make_glb({std::span(&take, 1), {}, {}}, {}));
        for (std::uint32_t actor = 0; actor < take.actors.size(); ++actor) {
            const figure::Figure figure = e.figure(actor);
            std::vector<std::size_t> nodes;
            for (const figure::Joint& joint : figure.skeleton.joints) {
                nodes.push_back(static_cast<std::size_t>(
                    file.find(take.actors[actor].name + "_" + joint.name)));
            }
            CAPTURE(name);
            CAPTURE(take.actors[actor].name);
            check_table(e, actor, take.times.back().seconds(),
                        [&](double t, std::span<Transform> world_from_joint) {
                            const auto world = file.pose(0, t);
                            for (std::size_t j = 0; j < nodes.size(); ++j) {
                                world_from_joint[j] = from_eigen(world[nodes[j]], 1);
                            }
                        });
        }
    }
}

TEST_CASE("every example's BVH files keep the table of good motion in their frames [oracle]") {
    for (const char* name : kExamples) {
        const Example& e = test::example(name);
        const io::Take take = take_of(e, {.root = io::RootMode::kHips});
        for (std::uint32_t actor = 0; actor < take.actors.size(); ++actor) {
            const figure::Figure figure = e.figure(actor);
            const test::Bvh bvh = test::read_bvh(io::make_bvh(take, actor, {}));
            std::vector<int> joints;
            for (const figure::Joint& joint : figure.skeleton.joints) {
                joints.push_back(bvh.find(joint.name));
            }
            CAPTURE(name);
            CAPTURE(take.actors[actor].name);
            check_table(e, actor, take.times.back().seconds(),
                        [&](double t, std::span<Transform> world_from_joint) {
                            const auto frame =
                                static_cast<std::size_t>(std::llround(t / bvh.frame_time_s));
                            const auto world = bvh.pose(std::min(frame, bvh.frames.size() - 1));
                            world_from_joint[0] = {};  // hips carries the root
                            for (std::size_t j = 1; j < world_from_joint.size(); ++j) {
                                world_from_joint[j] =
                                    from_eigen(world[static_cast<std::size_t>(joints[j])], 0.01);
                            }
                        });
        }
    }
}

TEST_CASE(
    "the ball in the glTF file stays at the palms while it is held, between frames too, within 1 "
    "mm [oracle]") {
    const Example& e = test::example("03_ball/ball.pup");
    const io::Take take = take_of(e);
    const test::GltfFile file = test::read_gltf(io::make_glb({std::span(&take, 1), {}, {}}, {}));
    const auto ball = static_cast<std::size_t>(file.find("ball"));
    const double radius_m = e.performance().props()[0].size_m.x / 2;
    double worst_m = 0, worst_at_s = 0;
    int held = 0;
    for (std::uint32_t actor = 0; actor < take.actors.size(); ++actor) {
        const figure::Figure figure = e.figure(actor);
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
    const Example& e = test::example("03_ball/ball.pup");
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
    const Example& e = test::example("03_ball/ball.pup");
    const auto take = io::sample_take(e.performance(), {.loop = true});
    REQUIRE(take);
    for (std::size_t a = 0; a < take->actors.size(); ++a) {
        const auto first = take->pose(a, 0), last = take->pose(a, take->times.size() - 1);
        for (std::size_t j = 1; j < first.size(); ++j) {
            CHECK(first[j] == last[j]);
        }
    }
}
