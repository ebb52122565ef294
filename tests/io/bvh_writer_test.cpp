// SPDX-License-Identifier: MIT
#include "puppetri/io/bvh_writer.h"

#include <doctest/doctest.h>

#include <cmath>

#include "support/bvh_reader.h"
#include "support/fake_performance.h"

using namespace puppetri;
using test::Bvh;
using test::FakePerformance;

namespace {

Bvh exported(const stage::Performance& performance, std::size_t actor,
             const io::TakeOptions& take_options = {}, const io::BvhOptions& options = {}) {
    const auto take = io::sample_take(performance, take_options);
    REQUIRE(take);
    return test::read_bvh(io::make_bvh(*take, actor, options));
}

double worst_joint_m(const Bvh& bvh, const FakePerformance& performance, std::uint32_t actor,
                     std::size_t frame, double metres_per_unit) {
    figure::Pose pose;
    performance.pose({actor}, FakePerformance::at(static_cast<double>(frame) / 24), pose);
    std::vector<Transform> world_from_joint(pose.parent_from_joint.size());
    figure::to_model_space(performance.skeleton(), pose, world_from_joint);
    const auto world = bvh.pose(frame);
    double worst = 0;
    for (std::size_t j = 0; j < world_from_joint.size(); ++j) {
        const int joint = bvh.find(performance.skeleton().joints[j].name);
        if (joint < 0) {
            continue;  // the root, where hips is the first
        }
        const Vec3 here = world_from_joint[j].translation;
        const Eigen::Vector3d there =
            world[static_cast<std::size_t>(joint)].translation() * metres_per_unit;
        worst = std::max(worst, (there - Eigen::Vector3d(here.x, here.y, here.z)).norm());
    }
    return worst;
}

}  // namespace

TEST_CASE(
    "all joints read back within 0.1 mm in every frame, in centimetres and metres, in both root "
    "modes [oracle]") {
    const FakePerformance performance;
    for (const auto root : {io::RootMode::kMotion, io::RootMode::kHips}) {
        for (const auto unit : {io::LengthUnit::kCentimetre, io::LengthUnit::kMetre}) {
            for (std::uint32_t actor = 0; actor < 2; ++actor) {
                const Bvh bvh = exported(performance, actor, {.root = root}, {.unit = unit});
                REQUIRE(bvh.frames.size() == 97);
                CHECK(bvh.frame_time_s == doctest::Approx(1 / 24.0).epsilon(1e-8));
                for (std::size_t frame = 0; frame < 97; ++frame) {
                    CHECK(worst_joint_m(bvh, performance, actor, frame,
                                        unit == io::LengthUnit::kMetre ? 1 : 0.01) < 1e-5);
                }
            }
        }
    }
}

TEST_CASE("all channels zero is the rest pose, whatever axes the skeleton uses [law]") {
    const FakePerformance performance;
    for (const auto rest : {io::RestPose::kT, io::RestPose::kA}) {
        const auto take = io::sample_take(performance, {.root = io::RootMode::kHips, .rest = rest});
        REQUIRE(take);
        const Bvh bvh = test::read_bvh(io::make_bvh(*take, 0, {.unit = io::LengthUnit::kMetre}));
        const figure::Skeleton& skeleton = take->actors[0].skeleton;
        std::vector<Transform> model(8);
        figure::to_model_space(skeleton, figure::rest_pose(skeleton), model);
        const auto zero = bvh.pose(std::vector<double>(bvh.frames[0].size(), 0));
        const auto hips = static_cast<std::size_t>(bvh.find("hips"));
        for (std::size_t j = 2; j < 8; ++j) {
            const auto joint = static_cast<std::size_t>(bvh.find(skeleton.joints[j].name));
            const Vec3 here = model[j].translation - model[1].translation;
            const Eigen::Vector3d there = zero[joint].translation() - zero[hips].translation();
            CHECK((there - Eigen::Vector3d(here.x, here.y, here.z)).norm() < 1e-5);
            CHECK(zero[joint].linear().isIdentity(1e-9));
        }
    }
}

TEST_CASE("no angle jumps: a joint that rolls on for four turns is written unwrapped [law]") {
    const Bvh bvh = exported(FakePerformance(), 0, {.root = io::RootMode::kHips});
    double largest = 0;
    for (std::size_t frame = 1; frame < bvh.frames.size(); ++frame) {
        for (std::size_t c = 3; c < bvh.frames[frame].size(); ++c) {
            CHECK(std::fabs(bvh.frames[frame][c] - bvh.frames[frame - 1][c]) < 90);
            largest = std::max(largest, std::fabs(bvh.frames[frame][c]));
        }
    }
    CHECK(largest > 1000);
}

TEST_CASE(
    "three angles in the order Z X Y give the rotation back, also looking straight up [law]") {
    Vec3 before;
    for (int i = 0; i < 2000; ++i) {
        // Well-spread rotations, and every tenth at the pole of the middle angle.
        const double a = 0.37 * i,
                     b = i % 10 == 0 ? (i % 20 == 0 ? 1 : -1) * kPi / 2 : 1.3 * std::sin(0.11 * i),
                     c = 0.23 * i;
        const Quat q = about_z(a) * about_x(b) * about_y(c);
        const Vec3 angles = io::euler_zxy_rad(q, before);
        const Quat back = about_z(angles.z) * about_x(angles.x) * about_y(angles.y);
        CHECK(angle_between(q, back) < 1e-6);
        before = angles;
    }
}

TEST_CASE(
    "the first joint has six channels, end sites close the chains, all actors have equally many "
    "frames [unit]") {
    const FakePerformance performance(2.02);
    const Bvh hips = exported(performance, 0, {.root = io::RootMode::kHips});
    CHECK(hips.joints[0].name == "hips");
    CHECK(hips.joints[0].channels.size() == 6);
    CHECK(hips.joints[0].offset.isZero());
    std::size_t ends = 0;
    for (const auto& joint : hips.joints) {
        ends += joint.end_site;
    }
    CHECK(ends == 3);
    const Bvh motion = exported(performance, 1);
    CHECK(motion.joints[0].name == "root");
    CHECK(motion.frames.size() == hips.frames.size());
    CHECK(motion.frames.size() == 49);
    CHECK(io::bvh_path("out/ball.bvh", "ana") == "out/ball_ana.bvh");
}
