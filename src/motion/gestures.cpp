// SPDX-License-Identifier: MIT
#include "puppetri/motion/gestures.h"

#include <algorithm>

#include "living.h"
#include "puppetri/base/elementary.h"
#include "puppetri/math/rotation.h"
#include "puppetri/motion/posed.h"
#include "puppetri/motion/sitting.h"

namespace puppetri::motion {
namespace {

// Lengths below are of a figure of 1.75 m.
double scale_of(const figure::Figure& figure) { return figure.height_m / 1.75; }

// 0, rising to 1 within `up_s` from `from_s`, back to 0 within `down_s` before `to_s`.
double stays(double t_s, double from_s, double up_s, double to_s, double down_s) {
    return smooth_rise(t_s - from_s, up_s) * smooth_rise(to_s - t_s, down_s);
}

const char* of(Side side, const char* left, const char* right) {
    return side == Side::kLeft ? left : right;
}

class Bow final : public PoseSource {
 public:
    Bow(double deep_rad, double scale, double duration_s)
        : deep_(clamp(deep_rad, -0.3, 1.2)), scale_(scale), duration_s_(duration_s) {}
    void sample(double t_s, PoseFrame& frame) const override {
        const double u = stays(t_s, 0, 0.42 * duration_s_, duration_s_, 0.46 * duration_s_);
        const double bend = deep_ * u;
        // Hips, spine, chest, neck; the hips go back so that the weight stays over the feet.
        // Who sits has bent its hips already.
        const double share[] = {scale_ > 0 ? 0.5 : 0.2, 0.2, 0.2, 0.1};
        for (std::size_t i = 0; i < 4; ++i) {
            frame.dofs[i] = share[i] * bend;
        }
        frame.paths[0] = Vec3{0, -0.015 * u, -0.17 * bend} * scale_;
    }

 private:
    double deep_, scale_, duration_s_;
};

constexpr double kWaveRise_s = 0.75, kWaveFall_s = 0.8, kWaveOnce_s = 0.55;

class Wave final : public PoseSource {
 public:
    explicit Wave(int times) : duration_s_(wave_duration_s(times)) {}
    void sample(double t_s, PoseFrame& frame) const override {
        const double up = stays(t_s, 0, kWaveRise_s, duration_s_, kWaveFall_s);
        const double waving =
            stays(t_s, 0.4 * kWaveRise_s, 0.5, duration_s_ - 0.4 * kWaveFall_s, 0.5);
        const double swing = waving * puppetri::sin(2 * kPi * (t_s - kWaveRise_s) / kWaveOnce_s);
        // The upper arm goes up and out, the forearm stands; it swings about the elbow.
        frame.dofs[0] = up * radians(70) + radians(4);
        frame.dofs[1] = up * radians(18) + radians(6);
        frame.dofs[2] = up * (radians(-70) + radians(18) * swing);
        frame.dofs[3] = up * radians(96) + radians(18);
        frame.dofs[4] = up * radians(6) * swing;
    }

 private:
    double duration_s_;
};

constexpr double kBite_s = 2.8, kAtMouth_s = 1.3;

class Eat final : public PoseSource {
 public:
    Eat(const figure::Figure& figure, Side side) : s_(side == Side::kLeft ? 1 : -1) {
        const double k = scale_of(figure);
        const auto& joints = figure.skeleton.joints;
        const Vec3 eyes = joints[figure.neck.value].parent_from_joint_rest.translation +
                          joints[figure.head.value].parent_from_joint_rest.translation +
                          figure.eyes_head;
        // Wrists, with the fingers at the plate and at the lips.
        mouth_ = eyes + Vec3{0.085 * s_, -0.165, 0.135} * k;
        plate_ = Vec3{0.13 * s_, -0.20, 0.36} * k;
    }
    void sample(double t_s, PoseFrame& frame) const override {
        const double t = t_s - kBite_s * std::floor(t_s / kBite_s);
        const double up = stays(t, 0.3, 0.95, 2.75, 1.1);
        // The way bends outward and ahead, as the elbow does.
        const double out = 4 * up * (1 - up);
        frame.paths[0] = lerp(plate_, mouth_, up) + Vec3{0.03 * s_, 0, 0.05} * out;
        frame.dofs[0] = radians(4) + radians(9) * stays(t, 0.2, 0.6, 1.7, 0.6);  // head
        frame.dofs[1] = radians(4) * stays(t, 0.2, 0.6, 1.9, 0.6);               // chest
        frame.dofs[2] = radians(12) + radians(38) * up;                          // wrist flex
    }

 private:
    double s_;
    Vec3 mouth_, plate_;
};

}  // namespace

MovementPtr make_bow(const MotionContext& context, const BowSpec& spec) {
    const PosedSpec posed{.name = "bow",
                          .duration_s = spec.duration_s,
                          .dofs = {"hips.flex", "spine.flex", "chest.flex", "neck.flex"},
                          .paths = {{Limb::kPelvis, PathSpace::kStart}},
                          .also = kAllLimbs};
    // Who sits bends over the seat.
    return make_posed(
        context, posed,
        std::make_shared<Bow>(spec.deep_rad, sits(context) ? 0 : scale_of(context.figure),
                              spec.duration_s));
}

double wave_duration_s(int times) {
    return kWaveRise_s + kWaveFall_s + kWaveOnce_s * std::clamp(times, 1, kMostWaves);
}

MovementPtr make_wave(const MotionContext& context, const WaveSpec& spec) {
    const Side side = spec.side;
    const PosedSpec posed{.name = "wave",
                          .duration_s = wave_duration_s(spec.times),
                          .dofs = {of(side, "left_shoulder.side", "right_shoulder.side"),
                                   of(side, "left_shoulder.flex", "right_shoulder.flex"),
                                   of(side, "left_shoulder.twist", "right_shoulder.twist"),
                                   of(side, "left_elbow.flex", "right_elbow.flex"),
                                   of(side, "left_wrist.side", "right_wrist.side")},
                          .also = kBothArms};
    return make_posed(context, posed, std::make_shared<Wave>(spec.times));
}

double eat_duration_s(int bites) { return kBite_s * std::clamp(bites, 1, kMostBites); }

MovementPtr make_eat(const MotionContext& context, const EatSpec& spec) {
    PosedSpec posed{
        .name = "eat",
        .duration_s = eat_duration_s(spec.bites),
        .dofs = {"head.flex", "chest.flex", of(spec.side, "left_wrist.flex", "right_wrist.flex")},
        .paths = {{arm_of(spec.side), PathSpace::kChest}}};
    for (int i = 0; i < std::clamp(spec.bites, 1, kMostBites); ++i) {
        posed.events.push_back({i * kBite_s + kAtMouth_s, "bite", arm_of(spec.side)});
    }
    return make_posed(context, posed, std::make_shared<Eat>(context.figure, spec.side));
}

}  // namespace puppetri::motion
