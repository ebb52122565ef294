// SPDX-License-Identifier: MIT
// Cycles out of a capture whose truth is known: a walker by formula, with feet that stand still by
// construction, noise on top.
#include "puppetri/motion/walk_cycle.h"

#include <doctest/doctest.h>

#include <cmath>

#include "puppetri/motion/clip_blend.h"
#include "puppetri/motion/clip_edit.h"

using namespace puppetri;
using namespace puppetri::motion;

namespace {

// Walks along +X (or a wide circle), right foot half a stride after the left one.
struct Walker {
    double stride_s = 1.1, stride_m = 1.4, duty = 0.62, turn_rad_per_s = 0, noise_m = 0.002;
    double start_s = 0.4;  // stands before, so that the first landing is no begin of the take

    double landing(int side, int k) const {
        return start_s + stride_s * (k + (side == 0 ? 0.0 : 0.5));
    }
    // Along the path, of a foot.
    double along(int side, double t) const {
        const double phase = (t - landing(side, 0)) / stride_s;
        const double k = std::floor(phase), u = phase - k;
        const double swing = u < duty ? 0 : (u - duty) / (1 - duty);
        const double s = swing - std::sin(2 * kPi * swing) / (2 * kPi);
        return stride_m * (k + s) + (side == 0 ? 0 : stride_m / 2);
    }
    double height(int side, double t) const {
        const double phase = (t - landing(side, 0)) / stride_s;
        const double u = phase - std::floor(phase);
        return u < duty ? 0 : 0.12 * std::pow(std::sin(kPi * (u - duty) / (1 - duty)), 2);
    }
    Vec3 on_path(double s, double side) const {
        if (turn_rad_per_s == 0) {
            return {s, 0, -side};
        }
        const double r = stride_m / stride_s / turn_rad_per_s, a = s / r;
        return {(r + side) * std::sin(a), 0, (r + side) * std::cos(a) - r};
    }
    Vec3 hips(double t) const {
        const double s = stride_m * (t - start_s) / stride_s + 0.3;
        Vec3 p = on_path(s, 0.02 * std::sin(2 * kPi * (t - start_s) / stride_s));
        p.y = 0.9 + 0.02 * std::cos(4 * kPi * (t - start_s) / stride_s);
        return p + Vec3{0, noise_m * std::sin(37 * t), 0};
    }
    double heading(double t) const {
        return kPi / 2 + turn_rad_per_s * (t - start_s) +
               0.05 * std::sin(2 * kPi * (t - start_s) / stride_s);
    }
    Vec3 foot(int side, double t) const {
        Vec3 p = on_path(along(side, t), side == 0 ? 0.1 : -0.1);
        p.y = 0.08 + height(side, t) + noise_m * std::sin(53 * t + side);
        return p;
    }

    Clip capture(double duration_s) const {
        Clip clip;
        clip.name = "capture";
        clip.duration_s = duration_s;
        clip.root = "hips";
        clip.translations = {{"hips", {}}, {"leftFoot", {}}, {"rightFoot", {}}};
        clip.rotations = {{"hips", {}}};
        for (int k = 0; k <= std::lround(duration_s * 120); ++k) {
            const double t = std::min(k / 120.0, duration_s);
            const Quat turned = about_y(heading(t));
            clip.rotations[0].keys.push_back(RotationKey{.t_s = t, .value = turned});
            clip.translations[0].keys.push_back(VectorKey{.t_s = t, .value = hips(t)});
            for (int side = 0; side < 2; ++side) {
                clip.translations[static_cast<std::size_t>(1 + side)].keys.push_back(VectorKey{
                    .t_s = t, .value = rotate(conjugate(turned), foot(side, t) - hips(t))});
            }
        }
        return clip;
    }
};

figure::Skeleton skeleton() {
    figure::Skeleton s;
    s.joints = {{"hips", {}, {{}, {0, 0.9, 0}}, {}},
                {"leftFoot", {0}, {{}, {0.1, -0.8, 0}}, {}},
                {"rightFoot", {0}, {{}, {-0.1, -0.8, 0}}, {}}};
    return s;
}

const std::array<FootJoints, 2> kFeet = {FootJoints{"leftFoot", ""}, FootJoints{"rightFoot", ""}};

Vec3 foot_at(const Clip& clip, int side, double t) {
    const figure::Skeleton s = skeleton();
    figure::Pose pose = figure::rest_pose(s);
    sample_clip(clip, bind_clip(clip, s), t, pose);
    std::vector<Transform> model(3);
    figure::to_model_space(s, pose, model);
    return model[static_cast<std::size_t>(1 + side)].translation;
}

}  // namespace

TEST_CASE("contacts are found when and for as long as feet stand [oracle]") {
    const Walker walker;
    const Clip clip = walker.capture(6);
    for (int side = 0; side < 2; ++side) {
        const std::vector<ClipMark> marks =
            find_contacts(clip, skeleton(), kFeet[static_cast<std::size_t>(side)], {});
        REQUIRE(marks.size() >= 5);
        for (const ClipMark& mark : marks) {
            if (mark.t_s < 0.1 || mark.end_s > 5.9) {
                continue;  // cut off by the take
            }
            const double k = std::nearbyint((mark.t_s - walker.landing(side, 0)) / walker.stride_s);
            CHECK(std::fabs(mark.t_s - walker.landing(side, static_cast<int>(k))) < 0.06);
            CHECK(std::fabs(mark.end_s - mark.t_s - walker.duty * walker.stride_s) < 0.1);
        }
    }
}

TEST_CASE("a stride is cut out, travels, closes without a corner, and its feet stay put [oracle]") {
    for (const double turn : {0.0, 0.15}) {
        Walker walker;
        walker.turn_rad_per_s = turn;
        const Clip take = walker.capture(7);
        const Checked<WalkCycle> cycle = cut_walk_cycle(take, skeleton(), kFeet);
        REQUIRE(cycle.has_value());
        const Clip& clip = cycle->clip;
        REQUIRE(check(clip).has_value());
        CHECK(clip.loops);
        CHECK(clip.duration_s == doctest::Approx(walker.stride_s).epsilon(0.02));
        CHECK(cycle->travel_m == doctest::Approx(walker.stride_m).epsilon(0.03));
        CHECK(cycle->duty_factor == doctest::Approx(walker.duty).epsilon(0.08));
        CHECK(cycle->mismatch_m < 0.05);
        // Straight ahead, for ever: along +Z, from the origin.
        const Transform far = root_travel(clip, 10 * clip.duration_s);
        const Vec3 start = sample(*clip.find_translation("hips"), 0, true, clip.duration_s);
        CHECK(length(Vec3{start.x, 0, start.z}) < 1e-9);
        const Vec3 end =
            sample(*clip.find_translation("hips"), clip.duration_s, true, clip.duration_s);
        CHECK(std::fabs(end.x) < 1e-6);
        CHECK(end.z == doctest::Approx(walker.stride_m).epsilon(0.03));
        CHECK(length(far.translation) == doctest::Approx(10 * end.z).epsilon(1e-6));
        // The seam: places and velocities of feet seen from the root.
        const double p = clip.duration_s, d = 1e-4;
        for (int side = 0; side < 2; ++side) {
            const Vec3 a = foot_at(clip, side, 0), b = foot_at(clip, side, p);
            CHECK(length(b - a - Vec3{0, 0, end.z}) < 1e-6);
            const Vec3 va = (foot_at(clip, side, d) - a) * (1 / d);
            const Vec3 vb = (b - foot_at(clip, side, p - d)) * (1 / d);
            CHECK(length(va - vb) < 0.1);
        }
        // Marks of both feet; while one lasts the foot is where it is.
        int strikes = 0;
        for (const ClipMark& mark : clip.marks) {
            const int side = mark.target == "leftFoot" ? 0 : 1;
            strikes += mark.name == "foot_strike";
            if (mark.name != "contact") {
                continue;
            }
            const double from = mark.t_s + 0.06, to = mark.end_s - 0.06;
            for (double t = from; t < to; t += 0.02) {
                const Vec3 moved = foot_at(clip, side, t) - foot_at(clip, side, from);
                // Taking 0.15 rad/s out of a path turns what stands on the floor, too.
                CHECK(length(Vec3{moved.x, 0, moved.z}) < (turn == 0 ? 0.04 : 0.08));
            }
        }
        CHECK(strikes == 2);
        CHECK(clip.marks[0].t_s < 0.02);
    }
}

TEST_CASE("what is no walk is told [unit]") {
    Walker hopper;
    Clip clip = hopper.capture(5);
    const auto code = [&](const Clip& c, const std::array<FootJoints, 2>& feet) {
        const auto cycle = cut_walk_cycle(c, skeleton(), feet);
        return cycle ? std::string("fine") : cycle.error()[0].code;
    };
    CHECK(code(clip, {FootJoints{"leftFoot", ""}, FootJoints{"paw", ""}}) == "no-foot");
    // Both feet alike: hops, found when asked for.
    const std::array<FootJoints, 2> together = {kFeet[0], kFeet[0]};
    CHECK(code(clip, together) == "no-stride");
    CHECK(cut_walk_cycle(clip, skeleton(), together, {.alternating = false}).has_value());
    clip.root = "";
    CHECK(code(clip, kFeet) == "no-root");
    Clip still = stretched(hopper.capture(5), 1);
    for (VectorTrack& track : still.translations) {
        track.keys.resize(1);
    }
    for (RotationTrack& track : still.rotations) {
        track.keys.resize(1);
    }
    CHECK(code(still, kFeet) == "no-stride");
}

TEST_CASE("cycles are blended by phase: feet land when they must [oracle]") {
    Walker slow, fast;
    fast.stride_s = 0.8;
    fast.stride_m = 1.8;
    fast.duty = 0.5;
    const Clip a = cut_walk_cycle(slow.capture(7), skeleton(), kFeet)->clip;
    const Clip b = cut_walk_cycle(fast.capture(7), skeleton(), kFeet)->clip;
    const std::vector<std::string> feet{"leftFoot", "rightFoot"};
    const std::vector<PhasePoint> phases = phases_of(a, b, feet);
    REQUIRE(phases.size() >= 1);
    for (const double weight : {0.0, 0.5, 1.0}) {
        const Clip mixed = blended_cycles(a, b, weight, phases);
        REQUIRE(check(mixed).has_value());
        CHECK(mixed.duration_s == doctest::Approx(lerp(a.duration_s, b.duration_s, weight)));
        const double travel = root_travel(mixed, mixed.duration_s).translation.z;
        CHECK(travel == doctest::Approx(lerp(1.4, 1.8, weight)).epsilon(0.05));
        for (const ClipMark& mark : mixed.marks) {
            if (mark.name == "foot_strike" && mark.target == "rightFoot") {
                CHECK(mark.t_s == doctest::Approx(mixed.duration_s / 2).epsilon(0.06));
                CHECK(foot_at(mixed, 1, mark.t_s + 0.02).y < 0.11);
            }
        }
    }
}

TEST_CASE(
    "a transition starts where and as fast as the first clip was, and ends as the second "
    "[law]") {
    Walker slow, fast;
    fast.stride_s = 0.8;
    const Clip a = cut_walk_cycle(slow.capture(7), skeleton(), kFeet)->clip;
    const Clip b = cut_walk_cycle(fast.capture(7), skeleton(), kFeet)->clip;
    const Clip over = transition(a, 0.5, b, 0.1, 0.3);
    REQUIRE(check(over).has_value());
    CHECK(over.duration_s == doctest::Approx(0.5 + b.duration_s - 0.1));
    const double d = 1e-4;
    for (int side = 0; side < 2; ++side) {
        const Vec3 at = foot_at(over, side, 0.5);
        CHECK(length(at - foot_at(a, side, 0.5)) < 1e-6);
        const Vec3 before = (at - foot_at(over, side, 0.5 - d)) * (1 / d);
        const Vec3 after = (foot_at(over, side, 0.5 + d) - at) * (1 / d);
        CHECK(length(before - after) < 0.15);
        // In the end it is the second, carried along.
        const auto relative = [&](const Clip& c, double t) {
            const Vec3 hips = sample(*c.find_translation("hips"), t, c.loops, c.duration_s);
            const Quat turned = sample(*c.find_rotation("hips"), t, c.loops, c.duration_s);
            return rotate(conjugate(turned), foot_at(c, side, t) - hips);
        };
        CHECK(length(relative(over, 0.9) - relative(b, 0.5)) < 1e-3);
    }
}
