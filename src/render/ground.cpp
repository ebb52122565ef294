// SPDX-License-Identifier: MIT
#include "ground.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

namespace puppetri::render {
namespace {

float hash(std::uint32_t x, std::uint32_t z, std::uint32_t seed) {
    std::uint32_t h = (x * 0x9E3779B1u) ^ (z * 0x85EBCA77u) ^ (seed * 0xC2B2AE3Du);
    h ^= h >> 15;
    h *= 0x2C1B3C6Du;
    h ^= h >> 13;
    h *= 0x297A2D39u;
    h ^= h >> 16;
    return static_cast<float>(h >> 8) * (1.0f / 16777216.0f);
}

float smooth(float t) { return t * t * (3 - 2 * t); }

// What is below must be inlined into functions that are compiled for several processors.
#define PUP_INLINE inline __attribute__((always_inline))

PUP_INLINE float least(float a, float b) { return a < b ? a : b; }
PUP_INLINE float most(float a, float b) { return a > b ? a : b; }
PUP_INLINE float in_unit(float x) { return least(most(x, 0.0f), 1.0f); }
PUP_INLINE int rounded_down(float x) {
    const int i = static_cast<int>(x);
    return i - (x < static_cast<float>(i) ? 1 : 0);
}

// How much of [x - w/2, x + w/2] lies in [low, high].
PUP_INLINE float covered(float low, float high, float x, float w) {
    return in_unit((least(high, x + w / 2) - most(low, x - w / 2)) / w);
}

// The same for the bands [k period, k period + width], k all integers.
PUP_INLINE float filled(float period, float width, float at) {
    const auto k = static_cast<float>(rounded_down(at / period));
    return k * width + least(at - k * period, width);
}
PUP_INLINE float covered_periodic(float period, float width, float x, float w) {
    return in_unit((filled(period, width, x + w / 2) - filled(period, width, x - w / 2)) / w);
}

// The mean of a tile over each pixel, read at `taps` places along its longer side.
PUP_INLINE void read(const GrainTile& tile, int taps, const GroundPoints& p, Lanes8& out) {
    alignas(32) std::int32_t level[kPack];
    alignas(32) float keep[kPack], part_x[kPack], part_z[kPack], sum[kPack];
    for (int i = 0; i < kPack; ++i) {
        const bool along_x = p.width_x[i] >= p.width_z[i];
        const float part = (along_x ? p.width_x[i] : p.width_z[i]) / static_cast<float>(taps);
        part_x[i] = along_x ? part : 0.0f;
        part_z[i] = along_x ? 0.0f : part;
        // Texels that one tap covers, to the nearest power of two: the exponent of the float.
        const float covers = most(part * tile.tiles_per_metre * (GrainTile::kSide * 1.41f), 1.0f);
        std::int32_t bits;
        std::memcpy(&bits, &covers, sizeof bits);
        const std::int32_t l = (bits >> 23) - 127;
        keep[i] = l >= tile.blank_level ? 0.0f : tile.step;
        level[i] = l < GrainTile::kLevels - 1 ? l : GrainTile::kLevels - 1;
        sum[i] = 0;
    }
    const std::uint32_t* texels = tile.texels.data();
    for (int tap = 0; tap < taps; ++tap) {
        const float off = static_cast<float>(tap) + 0.5f - static_cast<float>(taps) / 2;
        for (int i = 0; i < kPack; ++i) {
            // Levels follow each other: 4^9, 4^8, .. texels; level l starts at (4^10 - 4^(10 - l))
            // / 3.
            const std::int32_t shift = GrainTile::kLevels - 1 - level[i], mask = (1 << shift) - 1;
            const std::int32_t start =
                ((1 << (2 * GrainTile::kLevels)) - (1 << (2 * shift + 2))) / 3;
            const auto side = static_cast<float>(1 << shift);
            const float x = (p.x[i] + off * part_x[i]) * tile.tiles_per_metre * side - 0.5f;
            const float z = (p.z[i] + off * part_z[i]) * tile.tiles_per_metre * side - 0.5f;
            const int fx = rounded_down(x), fz = rounded_down(z);
            const float s = x - static_cast<float>(fx), t = z - static_cast<float>(fz);
            const std::uint32_t four = texels[start + ((fz & mask) << shift) + (fx & mask)];
            const auto a = static_cast<float>(static_cast<std::int32_t>(four & 255));
            const auto b = static_cast<float>(static_cast<std::int32_t>(four >> 8 & 255));
            const auto c = static_cast<float>(static_cast<std::int32_t>(four >> 16 & 255));
            const auto d = static_cast<float>(static_cast<std::int32_t>(four >> 24));
            const float low = a + (b - a) * s, high = c + (d - c) * s;
            sum[i] += low + (high - low) * t;
        }
    }
    for (int i = 0; i < kPack; ++i) {
        out[i] = (sum[i] / static_cast<float>(taps) - 128) * keep[i];
    }
}

PUP_CLONES void road_colours(const GrainTile& fine, const GrainTile& coarse, const GrainTile& wide,
                             float half_width, const GroundPoints& p, Colours8& out) {
    Lanes8 grain, tufts, fields;
    read(fine, 3, p, grain);
    read(coarse, 2, p, tufts);
    read(wide, 1, p, fields);
    for (int i = 0; i < kPack; ++i) {
        const float x = p.x[i], wx = most(p.width_x[i], 1e-4f), wz = most(p.width_z[i], 1e-4f);
        const float aside = x < 0 ? -x : x;
        const float asphalt = covered(-half_width, half_width, x, wx);
        // Grass, and a strip of gravel with a ragged rim between it and the asphalt.
        const float dry = in_unit(0.5f + fields[i] + 0.25f * tufts[i]);
        const float blades = 1 + 0.7f * tufts[i] + 0.9f * grain[i];
        const float rim = half_width + 0.42f + 0.35f * tufts[i];
        const float gravel = covered(-rim, rim, x, wx + 0.15f), stones = 1 + 0.9f * grain[i];
        // Asphalt, polished by wheels in two tracks per lane, and its paint.
        const float tone = 1 + 0.36f * grain[i] + 0.16f * tufts[i] + 0.25f * fields[i];
        float lane = aside - half_width / 2;
        lane = (lane < 0 ? -lane : lane) - 0.75f;
        const float beside = in_unit(((lane < 0 ? -lane : lane) - 0.25f) / 0.5f);
        const float polish = 1 + 0.10f * (1 - beside * beside * (3 - 2 * beside));
        const float centre =
            covered(-0.06f, 0.06f, x, wx) * covered_periodic(4, 1.6f, p.z[i] + 0.8f, wz);
        const float edge = covered(half_width - 0.34f, half_width - 0.22f, aside, wx);
        const float paint = in_unit(most(centre, edge) * (0.53f + 0.35f * tone));
        const float tar = 0.108f * tone * polish * (1 - paint) + 0.65f * paint;
        const float green_r = (0.072f + 0.093f * dry) * blades,
                    green_g = (0.150f + 0.035f * dry) * blades,
                    green_b = (0.030f + 0.025f * dry) * blades;
        const float side_r = green_r + (0.270f * stones - green_r) * gravel,
                    side_g = green_g + (0.245f * stones - green_g) * gravel,
                    side_b = green_b + (0.205f * stones - green_b) * gravel;
        out.r[i] = side_r + (0.975f * tar + 0.016f * paint - side_r) * asphalt;
        out.g[i] = side_g + (tar - side_g) * asphalt;
        out.b[i] = side_b + (1.08f * tar - 0.07f * paint - side_b) * asphalt;
    }
}

PUP_CLONES void floor_colours(const GrainTile& fine, const GrainTile& coarse, const GroundPoints& p,
                              Colours8& out) {
    Lanes8 grain, tufts;
    read(fine, 2, p, grain);
    read(coarse, 1, p, tufts);
    for (int i = 0; i < kPack; ++i) {
        const float x = p.x[i], z = p.z[i], wx = most(p.width_x[i], 1e-4f),
                    wz = most(p.width_z[i], 1e-4f);
        const float tone = 1 + 0.10f * tufts[i] + 0.05f * grain[i];
        const float thin = most(covered_periodic(1, 0.012f, x + 0.006f, wx),
                                covered_periodic(1, 0.012f, z + 0.006f, wz));
        const float thick = most(covered_periodic(5, 0.03f, x + 0.015f, wx),
                                 covered_periodic(5, 0.03f, z + 0.015f, wz));
        const float line = least(1.0f, 0.35f * thin + 0.4f * thick);
        out.r[i] = 0.36f * tone * (1 - line) + 0.17f * line;
        out.g[i] = 0.345f * tone * (1 - line) + 0.19f * line;
        out.b[i] = 0.315f * tone * (1 - line) + 0.22f * line;
    }
}

}  // namespace

GrainTile::GrainTile(float tile_m, std::initializer_list<Octave> octaves, std::uint32_t seed)
    : tiles_per_metre(1 / tile_m) {
    std::vector<float> values(static_cast<std::size_t>(kSide) * kSide, 0.0f);
    float strongest = 0;
    for (const Octave& octave : octaves) {
        const auto cells = static_cast<std::uint32_t>(octave.cells);
        ++seed;
        strongest += octave.strength / 2;
        for (int i = 0; i < kSide; ++i) {
            const float fz = (static_cast<float>(i) + 0.5f) * static_cast<float>(cells) / kSide;
            const auto z = static_cast<std::uint32_t>(fz);
            const float v = smooth(fz - static_cast<float>(z));
            for (int k = 0; k < kSide; ++k) {
                const float fx = (static_cast<float>(k) + 0.5f) * static_cast<float>(cells) / kSide;
                const auto x = static_cast<std::uint32_t>(fx);
                const float u = smooth(fx - static_cast<float>(x));
                const std::uint32_t x1 = (x + 1) % cells, z1 = (z + 1) % cells;
                const float low = hash(x, z, seed) * (1 - u) + hash(x1, z, seed) * u;
                const float high = hash(x, z1, seed) * (1 - u) + hash(x1, z1, seed) * u;
                values[static_cast<std::size_t>(i * kSide + k)] +=
                    octave.strength * (low * (1 - v) + high * v - 0.5f);
            }
        }
    }
    step = strongest / 127;
    for (int level = 0; level < kLevels; ++level) {
        const std::size_t side = static_cast<std::size_t>(kSide) >> level;
        const auto byte = [&](std::size_t i, std::size_t k) {
            return static_cast<std::uint32_t>(values[(i % side) * side + k % side] / step + 128.5f);
        };
        float extreme = 0;
        for (std::size_t i = 0; i < side; ++i) {
            for (std::size_t k = 0; k < side; ++k) {
                texels.push_back(byte(i, k) | byte(i, k + 1) << 8 | byte(i + 1, k) << 16 |
                                 byte(i + 1, k + 1) << 24);
                extreme = std::max(extreme, std::abs(values[i * side + k]));
            }
        }
        if (extreme > 0.06f * strongest) {
            blank_level = level + 1;
        }
        std::vector<float> coarser(side * side / 4);
        for (std::size_t i = 0; i < side / 2; ++i) {
            for (std::size_t k = 0; k < side / 2; ++k) {
                const float* p = values.data() + 2 * i * side + 2 * k;
                coarser[i * (side / 2) + k] = (p[0] + p[1] + p[side] + p[side + 1]) / 4;
            }
        }
        values = std::move(coarser);
    }
}

Ground::Ground(bool road, float width_m)
    : road_(road),
      half_width_(width_m / 2),
      fine_(3.0f, {{128, 0.55f}, {256, 0.6f}, {40, 0.25f}}, 1),
      coarse_(19.0f, {{12, 0.45f}, {31, 0.4f}, {83, 0.35f}, {190, 0.35f}}, 11),
      wide_(170.0f, {{9, 0.6f}, {23, 0.5f}, {61, 0.4f}}, 23) {}

void Ground::colours(const GroundPoints& points, Colours8& out) const {
    if (road_) {
        road_colours(fine_, coarse_, wide_, half_width_, points, out);
    } else {
        floor_colours(fine_, coarse_, points, out);
    }
}

}  // namespace puppetri::render
