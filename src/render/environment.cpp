// SPDX-License-Identifier: MIT
#include "environment.h"

#include <cmath>

namespace puppetri::render {
namespace {

constexpr int kGradientSteps = 512;
constexpr Float3 kZenith{0.115f, 0.285f, 0.62f}, kMiddle{0.30f, 0.52f, 0.83f}, kHorizon{0.80f, 0.86f, 0.90f};
constexpr Float3 kWarm{1.0f, 0.80f, 0.58f};

// How much of [x - w/2, x + w/2] lies in [low, high].
float covered(float low, float high, float x, float w) {
    w = std::max(w, 1e-4f);
    return std::clamp((std::min(high, x + w / 2) - std::max(low, x - w / 2)) / w, 0.0f, 1.0f);
}

// The same for the bands [k period, k period + width], k all integers.
float covered_periodic(float period, float width, float x, float w) {
    w = std::max(w, 1e-4f);
    const auto filled = [&](float at) {
        const float k = std::floor(at / period);
        return k * width + std::min(at - k * period, width);
    };
    return std::clamp((filled(x + w / 2) - filled(x - w / 2)) / w, 0.0f, 1.0f);
}

float hash(std::int32_t x, std::int32_t z) {
    std::uint32_t h = static_cast<std::uint32_t>(x) * 0x9E3779B1u ^ static_cast<std::uint32_t>(z) * 0x85EBCA77u;
    h ^= h >> 15;
    h *= 0x2C1B3C6Du;
    h ^= h >> 13;
    return static_cast<float>(h >> 8) * (1.0f / 16777216.0f);
}

// Value noise in [0, 1], cells of size 1.
float noise(float x, float z) {
    const float fx = std::floor(x), fz = std::floor(z);
    const auto ix = static_cast<std::int32_t>(fx), iz = static_cast<std::int32_t>(fz);
    float u = x - fx, v = z - fz;
    u = u * u * (3 - 2 * u);
    v = v * v * (3 - 2 * v);
    return mix(mix(hash(ix, iz), hash(ix + 1, iz), u), mix(hash(ix, iz + 1), hash(ix + 1, iz + 1), u), v);
}

// Noise about 0 with cells of `size`, fading where a pixel is larger than a cell.
float grain(float x, float z, float size, float width) {
    const float keep = 1 - smooth_step(0.35f * size, 1.2f * size, width);
    return keep <= 0 ? 0 : (noise(x / size, z / size) - 0.5f) * keep;
}

}  // namespace

Environment::Environment(const Look& look, std::span<const stage::Set> sets) : to_sun_(normalized(float3(look.to_sun_world))) {
    if (!sets.empty()) {
        const stage::Set& set = sets.front();
        road_ = set.kind == stage::SetKind::kRoad;
        half_width_ = static_cast<float>(set.width_m / 2);
        half_length_ = static_cast<float>(set.length_m / 2);
        centre_x_ = static_cast<float>(set.position_world.x);
        centre_z_ = static_cast<float>(set.position_world.z);
        along_x_ = static_cast<float>(std::sin(set.direction_rad));
        along_z_ = static_cast<float>(std::cos(set.direction_rad));
    }
    for (int i = 0; i <= kGradientSteps; ++i) {
        const float y = static_cast<float>(i) / kGradientSteps;
        const Float3 low = mix(kHorizon, kMiddle, 1 - std::exp(-y * 5.5f));
        gradient_.push_back(mix(low, kZenith, smooth_step(0.05f, 0.95f, y)));
    }
}

Float3 Environment::ambient(Float3 n) const {
    const Float3 above{0.56f, 0.70f, 0.92f};
    const Float3 below = road_ ? Float3{0.40f, 0.39f, 0.36f} : Float3{0.50f, 0.46f, 0.40f};
    const float up = 0.5f + 0.5f * n.y;
    return mix(below * 0.75f, above * 0.95f, up * up * (3 - 2 * up));
}

// Two chains of hills, as a height of the horizon by azimuth: sums of sines of the direction, so that it closes around.
float Environment::hill(float x, float z, int layer) const {
    const float a = std::atan2(x, z);
    if (layer == 0) {
        return 0.034f + 0.011f * std::sin(3 * a + 0.6f) + 0.007f * std::sin(7 * a + 2.1f) + 0.0026f * std::sin(17 * a + 0.4f) +
               0.0011f * std::sin(41 * a);
    }
    return 0.015f + 0.006f * std::sin(5 * a + 1.9f) + 0.0035f * std::sin(11 * a + 0.3f) + 0.0015f * std::sin(29 * a + 1.0f) +
           0.0008f * std::sin(83 * a);
}

Float3 Environment::sky(Float3 d) const {
    const float y = std::clamp(d.y, 0.0f, 1.0f);
    const float at = y * kGradientSteps;
    const auto i = std::min(static_cast<int>(at), kGradientSteps - 1);
    Float3 light = mix(gradient_[static_cast<std::size_t>(i)], gradient_[static_cast<std::size_t>(i) + 1],
                       at - static_cast<float>(i));
    const float towards = std::max(0.0f, dot(d, to_sun_));
    const float glow = towards * towards * towards;
    light = light + kWarm * (0.10f * glow * glow + 0.25f * std::pow(glow, 16.0f));
    if (d.y < 0.06f && road_) {
        const float flat = std::sqrt(std::max(1e-6f, d.x * d.x + d.z * d.z));
        const float rise = d.y / flat;
        const float soft = 0.0012f;
        const float far_hill = smooth_step(-soft, soft, hill(d.x, d.z, 0) - rise);
        light = mix(light, Float3{0.47f, 0.59f, 0.70f}, far_hill * 0.85f);
        const float near_hill = smooth_step(-soft, soft, hill(d.x, d.z, 1) - rise);
        light = mix(light, Float3{0.36f, 0.47f, 0.44f}, near_hill * 0.9f);
    }
    return light;
}

Float3 Environment::haze(Float3 light, float distance_m, Float3 d) const {
    const float way = distance_m / (road_ ? 170.0f : 45.0f);
    const float through = std::exp(-way * way);
    const float flat = 1 / std::sqrt(std::max(1e-6f, d.x * d.x + d.z * d.z));
    Float3 far = sky({d.x * flat, 0.0f, d.z * flat});
    if (road_) {
        far = mix(Float3{0.36f, 0.47f, 0.44f}, kHorizon, 0.35f);
    }
    return mix(far, light, through);
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
    Float3 base{0.47f, 0.445f, 0.41f};
    const float w = std::max(width_x, width_z);
    base = base * (1 + 0.05f * grain(x, z, 1.7f, w) + 0.03f * grain(x + 3, z + 7, 0.31f, w));
    const float thin = std::max(covered_periodic(1, 0.012f, x + 0.006f, width_x), covered_periodic(1, 0.012f, z + 0.006f, width_z));
    const float thick = std::max(covered_periodic(5, 0.03f, x + 0.015f, width_x), covered_periodic(5, 0.03f, z + 0.015f, width_z));
    const float line = std::min(1.0f, 0.35f * thin + 0.4f * thick);
    return mix(base, Float3{0.24f, 0.25f, 0.27f}, line);
}

Float3 Environment::road(float x, float z, float width_x, float width_z) const {
    const float w = std::sqrt(width_x * width_z);
    const float asphalt = covered(-half_width_, half_width_, x, width_x) *
                          covered(-half_length_, half_length_, z, width_z);
    Float3 colour{};
    if (asphalt < 1) {
        const float tone = 1 + 0.55f * grain(x, z, 6.1f, w) + 0.45f * grain(x + 11, z + 5, 1.3f, w) +
                           0.55f * grain(x, z, 0.23f, w) + 0.75f * grain(x + 4, z + 9, 0.05f, w);
        const float dry = 0.5f + grain(x + 31, z + 17, 9.0f, w);
        colour = mix(Float3{0.105f, 0.185f, 0.045f}, Float3{0.20f, 0.21f, 0.075f}, dry) * tone;
        // A strip of gravel beside the asphalt.
        const float gravel = covered(-half_width_ - 0.45f, half_width_ + 0.45f, x, width_x + 0.12f + 0.3f * noise(z * 1.9f, x)) *
                             covered(-half_length_ - 0.45f, half_length_ + 0.45f, z, width_z);
        const float stones = 1 + 0.8f * grain(x, z, 0.045f, w) + 0.4f * grain(x + 3, z, 0.4f, w);
        colour = mix(colour, Float3{0.29f, 0.26f, 0.215f} * stones, gravel);
    }
    if (asphalt > 0) {
        const float tone = 1 + 0.30f * grain(x, z, 0.022f, w) + 0.16f * grain(x + 7, z, 0.11f, w) + 0.14f * grain(x, z + 3, 2.3f, w);
        Float3 tar = Float3{0.118f, 0.122f, 0.132f} * tone;
        // Wheels have polished two tracks in each lane.
        const float lane = std::fabs(std::fabs(x) - half_width_ / 2);
        tar = tar * (1 + 0.10f * (1 - smooth_step(0.25f, 0.75f, std::fabs(lane - 0.75f))));
        const float centre = covered(-0.06f, 0.06f, x, width_x) * covered_periodic(4, 1.6f, z + 0.8f, width_z);
        const float edge = covered(half_width_ - 0.34f, half_width_ - 0.22f, std::fabs(x), width_x);
        const float worn = 0.86f + 0.5f * grain(x, z, 0.06f, w) + 0.3f * grain(x, z, 0.5f, w);
        tar = mix(tar, Float3{0.66f, 0.655f, 0.63f}, std::clamp(std::max(centre, edge) * worn, 0.0f, 1.0f));
        colour = mix(colour, tar, asphalt);
    }
    return colour;
}

}  // namespace puppetri::render
