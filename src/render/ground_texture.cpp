// SPDX-License-Identifier: MIT
#include "ground_texture.h"

#include <algorithm>
#include <bit>

#include "float3.h"

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

}  // namespace

GroundTexture::GroundTexture(float tile_m, int most_taps, std::initializer_list<Octave> octaves, std::uint32_t seed)
    : tiles_per_metre_(1 / tile_m), most_taps_(most_taps) {
    levels_.resize(kLevels);
    levels_[0].assign(static_cast<std::size_t>(kSide) * kSide, 0.0f);
    for (const Octave& octave : octaves) {
        const auto cells = static_cast<std::uint32_t>(octave.cells);
        ++seed;
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
                levels_[0][static_cast<std::size_t>(i * kSide + k)] += octave.strength * (low * (1 - v) + high * v - 0.5f);
            }
        }
    }
    for (std::size_t level = 1; level < kLevels; ++level) {
        const std::size_t side = static_cast<std::size_t>(kSide) >> level;
        const std::vector<float>& finer = levels_[level - 1];
        levels_[level].resize(side * side);
        for (std::size_t i = 0; i < side; ++i) {
            for (std::size_t k = 0; k < side; ++k) {
                const float* p = finer.data() + 4 * i * side + 2 * k;
                levels_[level][i * side + k] = (p[0] + p[1] + p[2 * side] + p[2 * side + 1]) / 4;
            }
        }
    }
}

// Bilinear; u and v in tiles.
float GroundTexture::texel(int level, float u, float v) const {
    const int side = kSide >> level, mask = side - 1;
    const float x = u * static_cast<float>(side) - 0.5f, y = v * static_cast<float>(side) - 0.5f;
    const int fx = floor_int(x), fy = floor_int(y);
    const int x0 = fx & mask, y0 = fy & mask, x1 = (x0 + 1) & mask, y1 = (y0 + 1) & mask;
    const float s = x - static_cast<float>(fx), t = y - static_cast<float>(fy);
    const float* p = levels_[static_cast<std::size_t>(level)].data();
    const float low = p[y0 * side + x0] * (1 - s) + p[y0 * side + x1] * s;
    const float high = p[y1 * side + x0] * (1 - s) + p[y1 * side + x1] * s;
    return low * (1 - t) + high * t;
}

float GroundTexture::operator()(float x, float z, float width_x, float width_z) const {
    const bool along_x = width_x >= width_z;
    const float longer = along_x ? width_x : width_z, shorter = std::max(along_x ? width_z : width_x, 1e-5f);
    const int taps = std::clamp(static_cast<int>(longer / shorter + 0.5f), 1, most_taps_);
    const float part = longer / static_cast<float>(taps);
    // Texels that one tap covers, to the nearest power of two: the exponent of the float.
    const float covered = std::max(part * tiles_per_metre_ * kSide * 1.41f, 1.0f);
    const int level = std::min(static_cast<int>(std::bit_cast<std::uint32_t>(covered) >> 23) - 127, kLevels - 1);
    float sum = 0;
    for (int i = 0; i < taps; ++i) {
        const float off = part * (static_cast<float>(i) + 0.5f) - longer / 2;
        sum += texel(level, (along_x ? x + off : x) * tiles_per_metre_, (along_x ? z : z + off) * tiles_per_metre_);
    }
    return sum / static_cast<float>(taps);
}

}  // namespace puppetri::render
