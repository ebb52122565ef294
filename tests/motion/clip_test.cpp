// SPDX-License-Identifier: MIT
// Editable clips: what tracks are between their keys, against closed forms and finite differences;
// their defects; the travel of the root.
#include "puppetri/motion/clip.h"

#include <doctest/doctest.h>

#include <random>

using namespace puppetri;
using namespace puppetri::motion;

namespace {

std::mt19937 g_random(7);
double real(double lo, double hi) {
    return std::uniform_real_distribution<double>(lo, hi)(g_random);
}
Quat rotation() { return from_rotation_vector({real(-1, 1), real(-1, 1), real(-1, 1)}); }

NumberTrack numbers(Interpolation how, std::vector<double> values, double step_s = 0.5) {
    NumberTrack track{"x", {}};
    for (std::size_t i = 0; i < values.size(); ++i) {
        NumberKey key;
        key.t_s = static_cast<double>(i) * step_s;
        key.value = values[i];
        key.interpolation = how;
        track.keys.push_back(key);
    }
    return track;
}

RotationTrack rotations(Interpolation how, int keys, double step_s = 0.25) {
    RotationTrack track{"j", {}};
    for (int i = 0; i < keys; ++i) {
        RotationKey key;
        key.t_s = i * step_s;
        key.value = rotation();
        key.interpolation = how;
        track.keys.push_back(key);
    }
    return track;
}

constexpr Interpolation kAll[] = {
    Interpolation::kStep,     Interpolation::kLinear,          Interpolation::kCatmullRom,
    Interpolation::kCardinal, Interpolation::kKochanekBartels, Interpolation::kHermite,
    Interpolation::kBezier};

}  // namespace

TEST_CASE("whatever the interpolation, a key is met exactly and the ends hold [law]") {
    for (const Interpolation how : kAll) {
        RotationTrack track = rotations(how, 6);
        for (RotationKey& key : track.keys) {
            key.shape = {real(-1, 1), real(-1, 1), real(-1, 1)};
            key.in = {real(-2, 2), real(-2, 2), real(-2, 2)};
            key.out = key.in;
        }
        for (const RotationKey& key : track.keys) {
            CHECK(angle_between(sample(track, key.t_s, false, 1.25), key.value) < 1e-12);
        }
        CHECK(sample(track, -3, false, 1.25) == track.keys.front().value);
        CHECK(sample(track, 99, false, 1.25) == track.keys.back().value);
    }
}

TEST_CASE("Catmull-Rom at equal spacing is the textbook's matrix [oracle]") {
    const std::vector<double> p{0.3, -1, 2, 0.5, 0.7};
    const NumberTrack track = numbers(Interpolation::kCatmullRom, p);
    for (std::size_t i = 1; i + 2 < p.size(); ++i) {
        for (const double u : {0.0, 0.3, 0.6, 1.0}) {
            const double expected =
                0.5 * (2 * p[i] + (p[i + 1] - p[i - 1]) * u +
                       (2 * p[i - 1] - 5 * p[i] + 4 * p[i + 1] - p[i + 2]) * u * u +
                       (3 * p[i] - p[i - 1] - 3 * p[i + 1] + p[i + 2]) * u * u * u);
            CHECK(sample(track, 0.5 * (static_cast<double>(i) + u), false, 2) ==
                  doctest::Approx(expected));
        }
    }
}

TEST_CASE(
    "the splines named after their parameters are the same curve at 0, and not otherwise "
    "[law]") {
    const std::vector<double> p{0.3, -1, 2, 0.5, 0.7};
    const NumberTrack plain = numbers(Interpolation::kCatmullRom, p);
    NumberTrack tcb = numbers(Interpolation::kKochanekBartels, p);
    NumberTrack cardinal = numbers(Interpolation::kCardinal, p);
    for (double t = 0; t < 2; t += 0.07) {
        CHECK(sample(tcb, t, false, 2) == doctest::Approx(sample(plain, t, false, 2)));
        CHECK(sample(cardinal, t, false, 2) == doctest::Approx(sample(plain, t, false, 2)));
    }
    for (std::size_t i = 0; i < p.size(); ++i) {
        tcb.keys[i].shape.tension = cardinal.keys[i].shape.tension = 0.5;
        cardinal.keys[i].shape.bias = 0.7;  // not the cardinal spline's business
    }
    for (double t = 0.1; t < 2; t += 0.07) {
        CHECK(sample(tcb, t, false, 2) == doctest::Approx(sample(cardinal, t, false, 2)));
    }
    CHECK(std::fabs(sample(tcb, 0.8, false, 2) - sample(plain, 0.8, false, 2)) > 0.01);
    tcb.keys[2].shape.tension = 1;  // full tension: the curve stands still at the key
    CHECK(sample_rate(tcb, 1.0, false, 2) == doctest::Approx(0));
}

TEST_CASE("smooth interpolations have one rate on both sides of a key, of rotations too [law]") {
    for (const Interpolation how :
         {Interpolation::kCatmullRom, Interpolation::kCardinal, Interpolation::kKochanekBartels}) {
        RotationTrack track = rotations(how, 6);
        for (RotationKey& key : track.keys) {
            key.shape = {real(-0.5, 0.5), 0, real(-0.5, 0.5)};  // continuity 0
        }
        for (std::size_t i = 1; i + 1 < track.keys.size(); ++i) {
            const double t = track.keys[i].t_s, d = 1e-6;
            const auto q = [&](double at) { return sample(track, at, false, 1.25); };
            const Vec3 before = change_between(q(t - d), q(t)) * (1 / d);
            const Vec3 after = change_between(q(t), q(t + d)) * (1 / d);
            CHECK(length(before - after) < 2e-3);
            CHECK(length(after - sample_rate(track, t, false, 1.25)) < 2e-3);
        }
    }
    // With continuity there is a corner.
    NumberTrack corner = numbers(Interpolation::kKochanekBartels, {0, 1, 3});
    corner.keys[1].shape.continuity = -1;
    CHECK(sample_rate(corner, 0.4999999, false, 1) == doctest::Approx(2).epsilon(1e-4));
    CHECK(sample_rate(corner, 0.5, false, 1) == doctest::Approx(4).epsilon(1e-4));
}

TEST_CASE("a loop is smooth across its seam, and only a loop [law]") {
    NumberTrack track = numbers(Interpolation::kCatmullRom, {0, 1, 0, -1, 0});
    CHECK(sample_rate(track, 0, true, 2) == doctest::Approx(2));  // (1 - -1) / (2 * 0.5)
    CHECK(sample_rate(track, 0, false, 2) == doctest::Approx(2 * 1.0 / 1.0));
    CHECK(sample_rate(track, 1.99999, true, 2) == doctest::Approx(2).epsilon(1e-3));
    CHECK(sample(track, 2.25, true, 2) == doctest::Approx(sample(track, 0.25, true, 2)));
    CHECK(sample(track, -0.25, true, 2) == doctest::Approx(sample(track, 1.75, true, 2)));
    // Travel of the root goes on across the seam.
    NumberTrack travel = numbers(Interpolation::kCatmullRom, {0, 1, 3, 4});
    CHECK(sample_rate(travel, 0, true, 1.5) == doctest::Approx(2));  // (1 + 1) / 1
}

TEST_CASE("step, linear and eased segments are what their names say [unit]") {
    NumberTrack track = numbers(Interpolation::kStep, {1, 2, 4});
    CHECK(sample(track, 0.49, false, 1) == 1);
    CHECK(sample(track, 0.5, false, 1) == 2);
    track = numbers(Interpolation::kLinear, {1, 2, 4});
    CHECK(sample(track, 0.75, false, 1) == doctest::Approx(3));
    track.keys[1].interpolation = Interpolation::kBezier;
    track.keys[1].easing = {0.3, 0, 0.9, 0.7};
    CHECK(sample(track, 0.75, false, 1) == doctest::Approx(2 + 2 * ease({0.3, 0, 0.9, 0.7}, 0.5)));
    RotationTrack turn = rotations(Interpolation::kLinear, 2);
    CHECK(angle_between(sample(turn, 0.1, false, 0.25),
                        slerp(turn.keys[0].value, turn.keys[1].value, 0.4)) < 1e-12);
    // -q is the same rotation: the way stays the short one.
    const Quat q = turn.keys[1].value;
    turn.keys[1].value = {-q.x, -q.y, -q.z, -q.w};
    CHECK(angle_between(sample(turn, 0.1, false, 0.25), slerp(turn.keys[0].value, q, 0.4)) < 1e-12);
}

TEST_CASE("a clip moves the joints that it names and no other [unit]") {
    figure::Skeleton skeleton;
    skeleton.joints = {{"root", {}, {}, {}},
                       {"hips", {0}, {{}, {0, 1, 0}}, {}},
                       {"spine", {1}, {{}, {0, 0.1, 0}}, {}}};
    Clip clip;
    clip.duration_s = 1;
    clip.rotations = {rotations(Interpolation::kLinear, 2, 1.0)};
    clip.rotations[0].target = "spine";
    clip.translations = {{"tail", {VectorKey{.t_s = 0, .value = {9, 9, 9}}}}};
    const ClipBinding binding = bind_clip(clip, skeleton);
    CHECK(binding.rotations[0] == figure::JointIndex{2});
    CHECK(!binding.translations[0].valid());
    figure::Pose pose = figure::rest_pose(skeleton);
    sample_clip(clip, binding, 0.5, pose);
    CHECK(pose.parent_from_joint[1] == skeleton.joints[1].parent_from_joint_rest);
    CHECK(pose.parent_from_joint[2].translation == Vec3{0, 0.1, 0});
    CHECK(angle_between(pose.parent_from_joint[2].rotation,
                        sample(clip.rotations[0], 0.5, false, 1)) < 1e-12);
}

TEST_CASE("defects of a clip are told, each with its track and key [unit]") {
    const auto defect = [](const Clip& clip) {
        const Status status = check(clip, "x.keys");
        return status ? std::string("fine")
                      : status.error()[0].code + " " + status.error()[0].element;
    };
    Clip clip;
    clip.duration_s = 2;
    clip.numbers = {numbers(Interpolation::kLinear, {1, 2, 4})};
    CHECK(defect(clip) == "fine");
    Clip bad = clip;
    bad.numbers[0].keys[1].value = std::nan("");
    CHECK(defect(bad) == "bad-clip-value track x, key 2");
    bad = clip;
    bad.numbers[0].keys[2].t_s = 0.5;
    CHECK(defect(bad) == "bad-clip-time track x, key 3");
    bad = clip;
    bad.numbers[0].keys[2].t_s = 2.5;
    CHECK(defect(bad) == "bad-clip-time track x, key 3");
    bad = clip;
    bad.numbers.push_back(bad.numbers[0]);
    CHECK(defect(bad) == "bad-clip-track track x");
    bad = clip;
    bad.numbers[0].keys.clear();
    CHECK(defect(bad) == "bad-clip-track track x");
    bad = clip;
    bad.rotations = {{"hips", {RotationKey{.value = {0, 0, 0, 2}}}}};
    CHECK(defect(bad) == "bad-clip-value rotation of hips, key 1");
    bad = clip;
    bad.duration_s = -1;
    CHECK(defect(bad) == "bad-clip-time clip ");
    bad = clip;
    bad.numbers[0].keys[0].easing.x1 = 1.5;
    CHECK(defect(bad) == "bad-clip-value track x, key 1");
    bad = clip;
    bad.marks = {{3, 3, "late", ""}};
    CHECK(defect(bad) == "bad-clip-time mark late");
}

TEST_CASE("the travel of a root adds up over the rounds of a loop [oracle]") {
    // A quarter turn to the left while going 1 m ahead, per round of 1 s: four rounds close a ring.
    Clip clip;
    clip.duration_s = 1;
    clip.loops = true;
    clip.root = "root";
    clip.translations = {
        {"root",
         {VectorKey{.t_s = 0, .value = {3, 0.2, 5}}, VectorKey{.t_s = 1, .value = {3, 0.2, 6}}}}};
    clip.rotations = {
        {"root",
         {RotationKey{.t_s = 0, .value = {}}, RotationKey{.t_s = 1, .value = about_y(kPi / 2)}}}};
    const Transform half = root_travel(clip, 0.5);
    CHECK(length(half.translation - Vec3{0, 0, 0.5}) < 1e-12);
    CHECK(heading_of(half.rotation) == doctest::Approx(kPi / 4));
    const Transform two = root_travel(clip, 2);
    CHECK(length(two.translation - Vec3{1, 0, 1}) < 1e-9);
    const Transform ring = root_travel(clip, 4);
    CHECK(length(ring.translation) < 1e-9);
    CHECK(angle_of(ring.rotation) < 1e-9);
    const Transform later = root_travel(clip, 400'000.5);
    CHECK(length(later.translation - half.translation) < 1e-6);
    clip.root.clear();
    CHECK(root_travel(clip, 7) == Transform{});
}
