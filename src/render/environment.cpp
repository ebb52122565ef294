// SPDX-License-Identifier: MIT
#include "environment.h"

#include <cmath>

namespace puppetri::render {
namespace {

constexpr int kGradientSteps = 512, kAzimuths = 4096;
constexpr float kPi_f = 3.14159265f;
constexpr Float3 kZenith{0.07f, 0.21f, 0.52f}, kMiddle{0.20f, 0.45f, 0.86f},
    kHorizon{0.70f, 0.87f, 1.0f};
constexpr Float3 kWarm{1.0f, 0.80f, 0.58f};
constexpr Float3 kFarHill{0.44f, 0.60f, 0.74f}, kNearHill{0.30f, 0.45f, 0.42f},
    kMeadowHaze{0.46f, 0.58f, 0.52f};
constexpr Float3 kFloorHaze{0.96f, 1.02f, 1.08f};

// atan2 to 0.0002 rad, enough to look up hills.
float azimuth(float x, float z) {
    const float ax = std::fabs(x), az = std::fabs(z);
    const float t = std::min(ax, az) / std::max(std::max(ax, az), 1e-9f), s = t * t;
    float a = t * (0.9998660f +
                   s * (-0.3302995f + s * (0.1801410f + s * (-0.0851330f + s * 0.0208351f))));
    a = ax > az ? kPi_f / 2 - a : a;
    a = z < 0 ? kPi_f - a : a;
    return x < 0 ? -a : a;
}

}  // namespace

Environment::Environment(Vec3 to_sun_world, std::span<const stage::Set> sets)
    : to_sun_(normalized(float3(to_sun_world))),
      road_(!sets.empty() && sets.front().kind == stage::SetKind::kRoad),
      ground_(road_, sets.empty() ? 0.0f : static_cast<float>(sets.front().width_m)) {
    if (!sets.empty()) {
        const stage::Set& set = sets.front();
        centre_x_ = static_cast<float>(set.position_world.x);
        centre_z_ = static_cast<float>(set.position_world.z);
        along_x_ = static_cast<float>(std::sin(set.direction_rad));
        along_z_ = static_cast<float>(std::cos(set.direction_rad));
    }
    for (int i = 0; i <= kGradientSteps; ++i) {
        const float y = static_cast<float>(i) / kGradientSteps;
        const Float3 low = mix(kHorizon, kMiddle, 1 - std::exp(-y * 8.5f));
        gradient_.push_back(mix(low, kZenith, smooth_step(0.08f, 0.9f, y)));
    }
    // Sums of sines, so that the chains close around.
    for (int i = 0; i <= kAzimuths; ++i) {
        const float a = 2 * kPi_f * static_cast<float>(i) / kAzimuths;
        hills_.push_back(
            {0.034f + 0.011f * std::sin(3 * a + 0.6f) + 0.007f * std::sin(7 * a + 2.1f) +
                 0.0026f * std::sin(17 * a + 0.4f) + 0.0011f * std::sin(41 * a),
             0.014f + 0.006f * std::sin(5 * a + 1.9f) + 0.0035f * std::sin(11 * a + 0.3f) +
                 0.0015f * std::sin(29 * a + 1.0f) + 0.0008f * std::sin(83 * a) +
                 0.0005f * std::sin(211 * a)});
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
    const float t2 = towards * towards, t8 = t2 * t2 * t2 * t2,
                t64 = t8 * t8 * t8 * t8 * t8 * t8 * t8 * t8;
    light = light + kWarm * (0.08f * t8 + 0.25f * t64);
    if (!road_) {
        return mix(kFloorHaze, light, smooth_step(0.0f, 0.16f, d.y));
    }
    if (d.y < 0.07f) {
        const float rise = d.y / std::sqrt(std::max(1e-6f, d.x * d.x + d.z * d.z));
        const float turn = (azimuth(d.x, d.z) / (2 * kPi_f) + 0.5f) * kAzimuths;
        const auto k =
            static_cast<std::size_t>(std::clamp(static_cast<int>(turn), 0, kAzimuths - 1));
        const float part = turn - static_cast<float>(k);
        const float far = mix(hills_[k][0], hills_[k + 1][0], part),
                    near = mix(hills_[k][1], hills_[k + 1][1], part);
        constexpr float kSoft = 0.0009f;
        light = mix(light, mix(kHorizon, kFarHill, smooth_step(-0.01f, 0.035f, rise)),
                    0.9f * smooth_step(-kSoft, kSoft, far - rise));
        light = mix(light, mix(kMeadowHaze, kNearHill, smooth_step(0.0f, 0.014f, rise)),
                    smooth_step(-kSoft, kSoft, near - rise));
    }
    return light;
}

Float3 Environment::haze(Float3 light, float distance_m) const {
    const float way = distance_m / (road_ ? 140.0f : 26.0f), square = way * way;
    return mix(road_ ? kMeadowHaze : kFloorHaze, light, 1 / (1 + square + 0.5f * square * square));
}

void Environment::ground(const GroundPoints& world, Colours8& out) const {
    if (!road_) {
        ground_.colours(world, out);
        return;
    }
    // Across and along the road.
    GroundPoints own;
    const float ca = std::fabs(along_z_), sa = std::fabs(along_x_);
    for (std::size_t i = 0; i < kPack; ++i) {
        const float dx = world.x[i] - centre_x_, dz = world.z[i] - centre_z_;
        own.x[i] = dx * along_z_ - dz * along_x_;
        own.z[i] = dx * along_x_ + dz * along_z_;
        own.width_x[i] = world.width_x[i] * ca + world.width_z[i] * sa;
        own.width_z[i] = world.width_x[i] * sa + world.width_z[i] * ca;
    }
    ground_.colours(own, out);
}

}  // namespace puppetri::render
