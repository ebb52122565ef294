// SPDX-License-Identifier: MIT
// The packed form against the editable one, the tree against the plain loop, all widths against one
// another, bit by bit; no allocation.
#include "puppetri/motion/packed_clip.h"

#include <doctest/doctest.h>

#include <cstring>
#include <random>

#include "support/count_allocations.h"

using namespace puppetri;
using namespace puppetri::motion;

namespace {

std::mt19937 g_random(11);
double real(double lo, double hi) {
    return std::uniform_real_distribution<double>(lo, hi)(g_random);
}
Vec3 vector(double size) { return {real(-size, size), real(-size, size), real(-size, size)}; }

figure::Skeleton random_skeleton(int joints) {
    figure::Skeleton skeleton;
    for (int j = 0; j < joints; ++j) {
        figure::Joint joint;
        joint.name = "j" + std::to_string(j);
        if (j > 1) {  // two roots
            joint.parent = {static_cast<std::uint32_t>(g_random()) % static_cast<std::uint32_t>(j)};
        }
        joint.parent_from_joint_rest = {from_rotation_vector(vector(1)), vector(0.5)};
        skeleton.joints.push_back(joint);
    }
    return skeleton;
}

constexpr Interpolation kAll[] = {
    Interpolation::kStep,     Interpolation::kLinear,          Interpolation::kCatmullRom,
    Interpolation::kCardinal, Interpolation::kKochanekBartels, Interpolation::kHermite,
    Interpolation::kBezier};

template <class Key>
void add_keys(ClipTrack<Key>& track, double duration_s, bool even, Interpolation how, auto value) {
    double t = 0;
    while (t <= duration_s) {
        Key key;
        key.t_s = t;
        key.value = value();
        key.interpolation = how;
        track.keys.push_back(key);
        t += even ? 0.125 : real(0.03, 0.3);
    }
}

Clip random_clip(const figure::Skeleton& skeleton, bool even, int how) {
    Clip clip;
    clip.duration_s = 2;
    for (std::size_t j = 0; j < skeleton.joints.size(); ++j) {
        const auto kind = [&] { return how < 0 ? kAll[g_random() % 7] : kAll[how]; };
        if (g_random() % 4 != 0) {
            RotationTrack track{skeleton.joints[j].name, {}};
            add_keys(track, 2, even, kind(), [&] { return from_rotation_vector(vector(1)); });
            clip.rotations.push_back(track);
        }
        if (g_random() % 4 == 0) {
            VectorTrack track{skeleton.joints[j].name, {}};
            add_keys(track, 2, even, kind(), [&] { return vector(1); });
            clip.translations.push_back(track);
        }
    }
    return clip;
}

bool same_bits(const PackedPose& a, const PackedPose& b, std::uint32_t joints) {
    for (int k = 0; k < 7; ++k) {
        if (std::memcmp(a.component(k), b.component(k), joints * sizeof(float)) != 0) {
            return false;
        }
    }
    return true;
}

}  // namespace

TEST_CASE(
    "a packed clip is the editable one, within its tolerance, whatever the splines [oracle]") {
    for (int round = 0; round < 12; ++round) {
        const figure::Skeleton skeleton = random_skeleton(1 + round * 5);
        const Clip clip = random_clip(skeleton, round % 2 == 0, -1);
        REQUIRE(check(clip).has_value());
        const PackedSkeleton packed(skeleton);
        const PackedClip fast = pack_clip(clip, skeleton, packed);
        PackedPose pose(packed);
        figure::Pose plain = figure::rest_pose(skeleton);
        const ClipBinding binding = bind_clip(clip, skeleton);
        for (int i = 0; i < 100; ++i) {
            const double t = real(0, 2);
            bool jumps = false;  // within the 10 microseconds that a step takes
            const auto near_key = [&](const auto& tracks) {
                for (const auto& track : tracks) {
                    for (const auto& key : track.keys) {
                        jumps = jumps || std::fabs(key.t_s - t) < 2e-5;
                    }
                }
            };
            near_key(clip.rotations);
            near_key(clip.translations);
            if (jumps) {
                continue;
            }
            fast.sample(t, pose);
            sample_clip(clip, binding, t, plain);
            for (std::uint32_t j = 0; j < skeleton.joints.size(); ++j) {
                const Transform got = pose.at(packed.slot_of({j}));
                REQUIRE(angle_between(got.rotation, plain.parent_from_joint[j].rotation) < 2e-4);
                REQUIRE(length(got.translation - plain.parent_from_joint[j].translation) < 2e-4);
            }
        }
    }
}

TEST_CASE("of keys that are linear nothing is lost but rounding [law]") {
    const figure::Skeleton skeleton = random_skeleton(31);
    for (const bool even : {true, false}) {
        const Clip clip = random_clip(skeleton, even, 1);
        const PackedSkeleton packed(skeleton);
        const PackedClip fast = pack_clip(clip, skeleton, packed, nullptr, {1e9, 1e9});
        PackedPose pose(packed);
        for (const RotationTrack& track : clip.rotations) {
            const std::uint32_t slot = packed.slot_of(skeleton.find(track.target));
            for (const RotationKey& key : track.keys) {
                fast.sample(key.t_s, pose);
                REQUIRE(angle_between(pose.at(slot).rotation, key.value) < 2e-6);
            }
        }
        for (const VectorTrack& track : clip.translations) {
            const std::uint32_t slot = packed.slot_of(skeleton.find(track.target));
            for (double t = 0; t < 2; t += 0.0137) {
                fast.sample(t, pose);
                REQUIRE(length(pose.at(slot).translation - sample(track, t, false, 2)) < 1e-6);
            }
        }
    }
}

TEST_CASE("the tree is the plain product along the parents, for any tree [oracle]") {
    for (int joints = 1; joints < 90; joints += 4) {
        const figure::Skeleton skeleton = random_skeleton(joints);
        const PackedSkeleton packed(skeleton);
        PackedPose local(packed), model(packed);
        figure::Pose pose = figure::rest_pose(skeleton);
        for (std::uint32_t j = 0; j < pose.parent_from_joint.size(); ++j) {
            local.set(packed.slot_of({j}), pose.parent_from_joint[j]);
            CHECK(packed.joint_of(packed.slot_of({j})) == figure::JointIndex{j});
        }
        std::vector<Transform> expected(pose.parent_from_joint.size());
        figure::to_model_space(skeleton, pose, expected);
        to_model_space(packed, local, model);
        std::vector<float> matrices(12 * expected.size());
        to_matrices(packed, model, matrices);
        for (std::uint32_t j = 0; j < expected.size(); ++j) {
            const Transform got = model.at(packed.slot_of({j}));
            REQUIRE(angle_between(got.rotation, expected[j].rotation) < 1e-5);
            REQUIRE(length(got.translation - expected[j].translation) < 2e-5);
            const float* m = &matrices[12 * j];
            const Vec3 y = rotate(expected[j].rotation, {0, 1, 0});
            REQUIRE(length(Vec3{m[3], m[4], m[5]} - y) < 1e-5);
            REQUIRE(length(Vec3{m[9], m[10], m[11]} - expected[j].translation) < 2e-5);
        }
    }
}

TEST_CASE("every width gets the same bits [law]") {
    const figure::Skeleton skeleton = random_skeleton(67);
    const PackedSkeleton packed(skeleton);
    const PackedClip a = pack_clip(random_clip(skeleton, true, -1), skeleton, packed);
    const PackedClip b = pack_clip(random_clip(skeleton, false, -1), skeleton, packed);
    for (int i = 0; i < 50; ++i) {
        const double t = real(0, 2), u = real(0, 2);
        const float weight = static_cast<float>(real(0, 1));
        PackedPose reference(packed);
        std::vector<float> reference_matrices, matrices(std::size_t{12} * packed.joint_count());
        for (const Lanes lanes : {Lanes::k1, Lanes::k4, Lanes::k8}) {
            PackedPose p(packed), q(packed), mixed(packed), model(packed);
            a.sample(t, p, lanes);
            b.sample(u, q, lanes);
            blend(p, q, weight, mixed, lanes);
            to_model_space(packed, mixed, model, lanes);
            to_matrices(packed, model, matrices, lanes);
            if (lanes == Lanes::k1) {
                reference = model;
                reference_matrices = matrices;
            } else {
                REQUIRE(same_bits(reference, model, packed.joint_count()));
                REQUIRE(std::memcmp(reference_matrices.data(), matrices.data(),
                                    matrices.size() * sizeof(float)) == 0);
            }
        }
    }
}

TEST_CASE("a blend ends at its clips, and its middle is half way, -q or not [law]") {
    const figure::Skeleton skeleton = random_skeleton(9);
    const PackedSkeleton packed(skeleton);
    PackedPose a(packed), b(packed), out(packed);
    for (std::uint32_t slot = 0; slot < 9; ++slot) {
        a.set(slot, {from_rotation_vector(vector(1)), vector(1)});
        Quat q = from_rotation_vector(vector(1));
        if (slot % 2 == 0) {
            q = {-q.x, -q.y, -q.z, -q.w};
        }
        b.set(slot, {q, vector(1)});
    }
    blend(a, b, 0, out);
    CHECK(angle_between(out.at(4).rotation, a.at(4).rotation) < 1e-6);
    blend(a, b, 1, out);
    CHECK(angle_between(out.at(4).rotation, b.at(4).rotation) < 1e-6);
    blend(a, b, 0.5f, out);
    for (std::uint32_t slot = 0; slot < 9; ++slot) {
        CHECK(angle_between(out.at(slot).rotation,
                            slerp(a.at(slot).rotation, b.at(slot).rotation, 0.5)) < 1e-5);
        CHECK(length(out.at(slot).translation -
                     (a.at(slot).translation + b.at(slot).translation) * 0.5) < 1e-5);
    }
}

TEST_CASE("a crowd is its members one by one, and allocates nothing [alloc]") {
    const figure::Skeleton skeleton = random_skeleton(31);
    const PackedSkeleton packed(skeleton);
    Clip looping = random_clip(skeleton, true, 1);
    looping.loops = true;
    const PackedClip a = pack_clip(looping, skeleton, packed);
    const PackedClip b = pack_clip(random_clip(skeleton, false, -1), skeleton, packed);
    std::vector<CrowdMember> members;
    for (int i = 0; i < 40; ++i) {
        members.push_back({&a, real(-5, 5), i % 2 ? &b : nullptr, real(0, 2), 0.3f});
    }
    std::vector<PackedPose> poses(members.size(), PackedPose(packed));
    std::array<PackedPose, 2> scratch{PackedPose(packed), PackedPose(packed)};
    pose_crowd(packed, members, poses, scratch);
    const std::uint64_t before = test::allocations();
    pose_crowd(packed, members, poses, scratch);
    CHECK(test::allocations() == before);
    for (std::size_t i = 0; i < members.size(); ++i) {
        PackedPose p(packed), q(packed), model(packed);
        a.sample(members[i].t_s, p);
        if (members[i].other) {
            b.sample(members[i].other_t_s, q);
            blend(p, q, 0.3f, p);
        }
        to_model_space(packed, p, model);
        CHECK(same_bits(model, poses[i], packed.joint_count()));
    }
}

TEST_CASE("degrees of freedom are packed as the joint that they turn [unit]") {
    figure::Skeleton skeleton;
    skeleton.joints = {{"base", {}, {}, {}}, {"link", {0}, {{}, {0, 1, 0}}, {}}};
    figure::DofSet dofs;
    dofs.dofs = {{"link.turn", {1}, figure::DofKind::kTurn, {0, 1, 0}, -3, 3, 0},
                 {"link.flex", {1}, figure::DofKind::kTurn, {1, 0, 0}, -3, 3, 0}};
    Clip clip;
    clip.duration_s = 1;
    clip.numbers = {
        {"link.flex", {NumberKey{.t_s = 0, .value = 0}, NumberKey{.t_s = 1, .value = 1}}},
        {"nobody.flex", {NumberKey{.t_s = 0, .value = 3}}}};
    const PackedSkeleton packed(skeleton);
    const PackedClip fast = pack_clip(clip, skeleton, packed, &dofs);
    PackedPose pose(packed);
    fast.sample(0.7, pose);
    CHECK(angle_between(pose.at(packed.slot_of({1})).rotation, about_x(0.7)) < 1e-4);
    // What has no track stays as the pose has it.
    figure::Pose plain = figure::rest_pose(skeleton);
    plain.parent_from_joint[1].rotation = about_y(0.4) * about_x(0.1);
    sample_clip(clip, bind_clip(clip, skeleton, &dofs), 0.7, plain);
    CHECK(angle_between(plain.parent_from_joint[1].rotation, about_y(0.4) * about_x(0.7)) < 1e-9);
}
