// SPDX-License-Identifier: MIT
// The reference scenes, exported and read back by readers that share no code with Puppetri, are
// measured again in the file's own frames: what arrives in other programs is what was promised.
#include <doctest/doctest.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <string>
#include <vector>

#include "puppetri/io/bvh_writer.h"
#include "puppetri/io/gltf_writer.h"
#include "puppetri/math/rotation.h"
#include "support/bvh_reader.h"
#include "support/example_motion.h"
#include "support/gltf_reader.h"
#include "support/motion_table.h"

using namespace puppetri;

namespace {

using test::Example;

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

// The joints of an actor in the world, in the frames of a file.
class FileFrames {
 public:
    FileFrames(std::size_t frames, std::size_t joints) : joints_(joints), world_(frames * joints) {}
    std::span<Transform> at(std::size_t frame) {
        return std::span(world_).subspan(frame * joints_, joints_);
    }
    std::size_t count() const { return joints_ == 0 ? 0 : world_.size() / joints_; }
    std::span<Transform> near(double t_s, double rate_hz) {
        const auto frame = static_cast<std::size_t>(std::llround(t_s * rate_hz));
        return at(std::min(frame, count() - 1));
    }

 private:
    std::size_t joints_;
    std::vector<Transform> world_;
};

// The table as far as a file's own frames show it: differences of neighbouring frames. What is no
// humanoid is not in the table: its joints must be where the performance has them.
void check_frames(const Example& e, std::uint32_t actor, const io::Take& take, FileFrames& frames) {
    const double rate_hz = take.rate.per_second(), end_s = take.times.back().seconds();
    const figure::Character* character = e.character(actor);
    if (!e.is_humanoid(actor)) {
        figure::Pose pose;
        std::vector<Transform> joints(character->skeleton.joints.size());
        double worst_m = 0, worst_rad = 0;
        for (std::size_t frame = 0; frame < frames.count(); ++frame) {
            e.performance().pose({actor}, take.rate.time_of(static_cast<std::int64_t>(frame)),
                                 pose);
            figure::to_model_space(character->skeleton, pose, joints);
            for (std::size_t j = 0; j < joints.size(); ++j) {
                const Transform& read = frames.at(frame)[j];
                worst_m = std::fmax(worst_m, length(read.translation - joints[j].translation));
                worst_rad = std::fmax(worst_rad, angle_between(read.rotation, joints[j].rotation));
            }
        }
        CHECK(frames.count() > 24);
        CHECK(worst_m < 1e-4);
        CHECK(worst_rad < 1e-3);
        return;
    }
    const figure::Figure figure = e.figure(actor);
    const test::Measures m =
        test::measure({.figure = figure,
                       .sample =
                           [&](double t, std::span<Transform> bones) {
                               const std::span<Transform> joints = frames.near(t, rate_hz);
                               if (character != nullptr) {
                                   test::bones_of_character(*character, joints, bones);
                               } else {
                                   std::copy(joints.begin(), joints.end(), bones.begin());
                               }
                           },
                       .begin_s = 0,
                       .end_s = end_s,
                       .rate_hz = rate_hz,
                       .planted = test::planted_of(e, actor, end_s)});
    test::check_rows(e.name, e.actor(actor), test::table_of_file(m));
}

// Nodes have no signs in their names: three.js would strip them.
std::string plain(std::string name) {
    std::replace_if(
        name.begin(), name.end(), [](char c) { return std::isalnum(c) == 0 && c != '-'; }, '_');
    return name;
}

const figure::Skeleton& skeleton_of(const Example& e, std::uint32_t actor) {
    return *e.performance().actors()[actor].skeleton;
}

}  // namespace

TEST_CASE(
    "every example's glTF file keeps the table of good motion in its frames: feet stand "
    "still within 2 mm [oracle]") {
    for (const std::string& name : test::example_scenes()) {
        CAPTURE(name);
        const Example& e = test::example(name);
        const io::Take take = take_of(e);
        const test::GltfFile file =
            test::read_gltf(io::make_glb({std::span(&take, 1), {}, {}}, {}));
        const auto count = static_cast<std::size_t>(take.frame_count);
        std::vector<FileFrames> frames;
        std::vector<std::vector<std::size_t>> nodes;
        for (std::uint32_t actor = 0; actor < e.actors(); ++actor) {
            const figure::Skeleton& skeleton = skeleton_of(e, actor);
            frames.emplace_back(count, skeleton.joints.size());
            nodes.emplace_back();
            for (const figure::Joint& joint : skeleton.joints) {
                const int node = file.find(plain(e.actor(actor) + "_" + joint.name));
                REQUIRE(node >= 0);
                nodes.back().push_back(static_cast<std::size_t>(node));
            }
        }
        for (std::size_t frame = 0; frame < count; ++frame) {
            const auto world =
                file.pose(0, take.rate.time_of(static_cast<std::int64_t>(frame)).seconds());
            for (std::size_t a = 0; a < frames.size(); ++a) {
                for (std::size_t j = 0; j < nodes[a].size(); ++j) {
                    frames[a].at(frame)[j] = from_eigen(world[nodes[a][j]], 1);
                }
            }
        }
        for (std::uint32_t actor = 0; actor < e.actors(); ++actor) {
            check_frames(e, actor, take, frames[actor]);
        }
    }
}

TEST_CASE("every example's BVH files keep the table of good motion in their frames [oracle]") {
    for (const std::string& name : test::example_scenes()) {
        CAPTURE(name);
        const Example& e = test::example(name);
        const io::Take with_root = take_of(e), without = take_of(e, {.root = io::RootMode::kHips});
        for (std::uint32_t actor = 0; actor < e.actors(); ++actor) {
            const figure::Skeleton& skeleton = skeleton_of(e, actor);
            // Of a mannequin as most programs want it: hips carries the root.
            const bool own = e.character(actor) != nullptr;
            const test::Bvh bvh =
                test::read_bvh(io::make_bvh(own ? with_root : without, actor, {}));
            FileFrames frames(bvh.frames.size(), skeleton.joints.size());
            std::vector<int> joints;
            for (const figure::Joint& joint : skeleton.joints) {
                joints.push_back(bvh.find(joint.name));
                REQUIRE((joints.back() >= 0 || (!own && joints.size() == 1)));
            }
            // In BVH the zero of all rotations is the rest pose, whatever axes joints have.
            std::vector<Transform> rest(skeleton.joints.size());
            figure::to_model_space(skeleton, figure::rest_pose(skeleton), rest);
            for (std::size_t frame = 0; frame < bvh.frames.size(); ++frame) {
                const auto world = bvh.pose(frame);
                for (std::size_t j = own ? 0 : 1; j < joints.size(); ++j) {
                    Transform& at = frames.at(frame)[j];
                    at = from_eigen(world[static_cast<std::size_t>(joints[j])], 0.01);
                    at.rotation = at.rotation * rest[j].rotation;
                }
            }
            check_frames(e, actor, with_root, frames);
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
