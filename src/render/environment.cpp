// SPDX-License-Identifier: MIT
#include "environment.h"

#include <cmath>

namespace puppetri::render {
namespace {

constexpr int kGradientSteps = 512, kAzimuths = 4096;
constexpr float kPi_f = 3.14159265f;
constexpr Float3 kZenith{0.07f, 0.21f, 0.52f}, kMiddle{0.22f, 0.46f, 0.85f}, kHorizon{0.78f, 0.90f, 1.0f};
constexpr Float3 kWarm{1.0f, 0.80f, 0.58f};
constexpr Float3 kFarHill{0.44f, 0.60f, 0.74f}, kNearHill{0.30f, 0.45f, 0.42f}, kMeadowHaze{0.46f, 0.58f, 0.52f};
constexpr Float3 kFloorHaze{0.74f, 0.79f, 0.82f};

// How much of [x - w/2, x + w/2] lies in [low, high].
float covered(float low, float high, float x, float w) {
    w = std::max(w, 1e-4f);
    return std::clamp((std::min(high, x + w / 2) - std::max(low, x - w / 2)) / w, 0.0f, 1.0f);
}

// The same for the bands [k period, k period + width], k all integers.
float covered_periodic(float period, float width, float x, float w) {
    w = std::max(w, 1e-4f);
    const auto filled = [&](float at) {
        const auto k = static_cast<float>(floor_int(at / period));
        return k * width + std::min(at - k * period, width);
    };
    return std::clamp((filled(x + w / 2) - filled(x - w / 2)) / w, 0.0f, 1.0f);
}

// atan2 to 0.0002 rad, enough to look up hills.
float azimuth(float x, float z) {
    const float ax = std::fabs(x), az = std::fabs(z);
    const float t = std::min(ax, az) / std::max(std::max(ax, az), 1e-9f), s = t * t;
    float a = t * (0.9998660f + s * (-0.3302995f + s * (0.1801410f + s * (-0.0851330f + s * 0.0208351f))));
    a = ax > az ? kPi_f / 2 - a : a;
    a = z < 0 ? kPi_f - a : a;
    return x < 0 ? -a : a;
}

}  // namespace

Environment::Environment(const Look& look, std::span<const stage::Set> sets)
    : to_sun_(normalized(float3(look.to_sun_world))),
      fine_(3.0f, 3, {{128, 0.55f}, {256, 0.6f}, {40, 0.25f}}, 1),
      coarse_(19.0f, 2, {{12, 0.45f}, {31, 0.4f}, {83, 0.35f}, {190, 0.35f}}, 11),
      wide_(170.0f, 1, {{9, 0.6f}, {23, 0.5f}, {61, 0.4f}}, 23) {
    if (!sets.empty()) {
        const stage::Set& set = sets.front();
        road_ = set.kind == stage::SetKind::kRoad;
        half_width_ = static_cast<float>(set.width_m / 2);
        centre_x_ = static_cast<float>(set.position_world.x);
        centre_z_ = static_cast<float>(set.position_world.z);
        along_x_ = static_cast<float>(std::sin(set.direction_rad));
        along_z_ = static_cast<float>(std::cos(set.direction_rad));
    }
    for (int i = 0; i <= kGradientSteps; ++i) {
        const float y = static_cast<float>(i) / kGradientSteps;
        const Float3 low = mix(kHorizon, kMiddle, 1 - std::exp(-y * 7.5f));
        gradient_.push_back(mix(low, kZenith, smooth_step(0.08f, 0.9f, y)));
    }
    // Sums of sines, so that the chains close around.
    for (int i = 0; i <= kAzimuths; ++i) {
        const float a = 2 * kPi_f * static_cast<float>(i) / kAzimuths;
        hills_.push_back({0.034f + 0.011f * std::sin(3 * a + 0.6f) + 0.007f * std::sin(7 * a + 2.1f) +
                              0.0026f * std::sin(17 * a + 0.4f) + 0.0011f * std::sin(41 * a),
                          0.014f + 0.006f * std::sin(5 * a + 1.9f) + 0.0035f * std::sin(11 * a + 0.3f) +
                              0.0015f * std::sin(29 * a + 1.0f) + 0.0008f * std::sin(83 * a) + 0.0005f * std::sin(211 * a)});
    }
}

Float3 Environment::ambient(Float3 n) const {
    const Float3 above{0.54f, 0.70f, 0.96f};
    const Float3 below = road_ ? Float3{0.40f, 0.39f, 0.36f} : Float3{0.50f, 0.46f, 0.40f};
    const float up = 0.5f + 0.5f * n.y;
    return mix(below * 0.75f, above * 0.95f, up * up * (3 - 2 * up));
}

Float3 Environment::sky(Float3 d) const {
    const float y = std::clamp(d.y, 0.0f, 1.0f);
    const float at = y * kGradientSteps;
    const auto i = static_cast<std::size_t>(std::min(static_cast<int>(at), kGradientSteps - 1));
    Float3 light = mix(gradient_[i], gradient_[i + 1], at - static_cast<float>(i));
    const float towards = std::max(0.0f, dot(d, to_sun_));
    const float t2 = towards * towards, t8 = t2 * t2 * t2 * t2, t64 = t8 * t8 * t8 * t8 * t8 * t8 * t8 * t8;
    light = light + kWarm * (0.08f * t8 + 0.25f * t64);
    if (!road_) {
        return mix(kFloorHaze, light, smooth_step(0.0f, 0.16f, d.y));
    }
    if (d.y < 0.07f) {
        const float rise = d.y / std::sqrt(std::max(1e-6f, d.x * d.x + d.z * d.z));
        const float turn = (azimuth(d.x, d.z) / (2 * kPi_f) + 0.5f) * kAzimuths;
        const auto k = static_cast<std::size_t>(std::clamp(static_cast<int>(turn), 0, kAzimuths - 1));
        const float part = turn - static_cast<float>(k);
        const float far = mix(hills_[k][0], hills_[k + 1][0], part), near = mix(hills_[k][1], hills_[k + 1][1], part);
        constexpr float kSoft = 0.0009f;
        light = mix(light, mix(kHorizon, kFarHill, smooth_step(-0.01f, 0.035f, rise)), 0.9f * smooth_step(-kSoft, kSoft, far - rise));
        light = mix(light, mix(kMeadowHaze, kNearHill, smooth_step(0.0f, 0.014f, rise)), smooth_step(-kSoft, kSoft, near - rise));
    }
    return light;
}

Float3 Environment::haze(Float3 light, float distance_m) const {
    const float way = distance_m / (road_ ? 140.0f : 26.0f), square = way * way;
    return mix(road_ ? kMeadowHaze : kFloorHaze, light, 1 / (1 + square + 0.5f * square * square));
}

Float3 Environment::ground(float x, float z, float width_x, float width_z) const {
    const float dx = x - centre_x_, dz = z - centre_z_;
    if (!road_) {
        return floor(dx, dz, width_x, width_z);
    }
    // Across and along the road.
    const float across = dx * along_z_ - dz * along_x_, along = dx * along_x_ + dz * along_z_;
    const float ca = std::fabs(along_z_), sa = std::fabs(along_x_);
    return road(across, along, width_x * ca + width_z * sa, width_x * sa + width_z * ca);
}

Float3 Environment::floor(float x, float z, float width_x, float width_z) const {
    const Float3 base = Float3{0.40f, 0.375f, 0.34f} * (1 + 0.10f * coarse_(x, z, width_x, width_z) + 0.05f * fine_(x, z, width_x, width_z));
    const float thin = std::max(covered_periodic(1, 0.012f, x + 0.006f, width_x), covered_periodic(1, 0.012f, z + 0.006f, width_z));
    const float thick = std::max(covered_periodic(5, 0.03f, x + 0.015f, width_x), covered_periodic(5, 0.03f, z + 0.015f, width_z));
    const float line = std::min(1.0f, 0.35f * thin + 0.4f * thick);
    return mix(base, Float3{0.20f, 0.21f, 0.23f}, line);
}

// The road goes on to the horizon, beyond the length of its set.
Float3 Environment::road(float x, float z, float width_x, float width_z) const {
    const float asphalt = covered(-half_width_, half_width_, x, width_x);
    Float3 colour{};
    if (asphalt < 1) {
        const float blades = fine_(x, z, width_x, width_z), tufts = coarse_(x, z, width_x, width_z);
        const float dry = std::clamp(0.5f + wide_(x, z, width_x, width_z) + 0.25f * tufts, 0.0f, 1.0f);
        colour = mix(Float3{0.072f, 0.150f, 0.030f}, Float3{0.165f, 0.185f, 0.055f}, dry) * (1 + 0.7f * tufts + 0.9f * blades);
        // A strip of gravel beside the asphalt, with a ragged rim.
        const float rim = half_width_ + 0.42f + 0.35f * tufts;
        const float gravel = covered(-rim, rim, x, width_x + 0.15f);
        colour = mix(colour, Float3{0.27f, 0.245f, 0.205f} * (1 + 0.9f * blades), gravel);
    }
    if (asphalt > 0) {
        const float tone = 1 + 0.36f * fine_(x, z, width_x, width_z) + 0.16f * coarse_(x, z, width_x, width_z) + 0.25f * wide_(x, z, width_x, width_z);
        Float3 tar = Float3{0.105f, 0.108f, 0.117f} * tone;
        // Wheels have polished two tracks in each lane.
        const float lane = std::fabs(std::fabs(x) - half_width_ / 2);
        tar = tar * (1 + 0.10f * (1 - smooth_step(0.25f, 0.75f, std::fabs(lane - 0.75f))));
        const float centre = covered(-0.06f, 0.06f, x, width_x) * covered_periodic(4, 1.6f, z + 0.8f, width_z);
        const float edge = covered(half_width_ - 0.34f, half_width_ - 0.22f, std::fabs(x), width_x);
        const float paint = std::max(centre, edge);
        if (paint > 0) {
            tar = mix(tar, Float3{0.66f, 0.655f, 0.63f}, std::clamp(paint * (0.88f + 0.35f * tone - 0.35f), 0.0f, 1.0f));
        }
        colour = mix(colour, tar, asphalt);
    }
    return colour;
}

}  // namespace puppetri::render
