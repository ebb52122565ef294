// SPDX-License-Identifier: MIT
// Gestures of standing and seated figures: made of poses (posed.h), so that feet and whatever else
// they do not move stay where they are.
#pragma once
#include "puppetri/motion/context.h"
#include "puppetri/motion/movement.h"

namespace puppetri::motion {

struct BowSpec {
    double deep_rad = 0.7;  // of the trunk, at most 1.2
    double duration_s = 2.4;
};
// Bends forward from the hips, stays a moment, and comes up again. All limbs.
MovementPtr make_bow(const MotionContext& context, const BowSpec& spec);

struct WaveSpec {
    Side side = Side::kRight;
    int times = 3;  // to and fro; 1 to kMostWaves
};
inline constexpr int kMostWaves = 100;
double wave_duration_s(int times);
// Raises one hand beside the head, waves it, and lowers it; the other arm hangs.
MovementPtr make_wave(const MotionContext& context, const WaveSpec& spec);

struct EatSpec {
    Side side = Side::kRight;
    int bites = 1;  // 1 to kMostBites
};
inline constexpr int kMostBites = 1000;
double eat_duration_s(int bites);
// Takes something from before the belly to the mouth, and again. Trunk and that arm: who sits keeps
// sitting. Events  "bite", when the fingers are at the mouth.
MovementPtr make_eat(const MotionContext& context, const EatSpec& spec);

}  // namespace puppetri::motion
