// SPDX-License-Identifier: MIT
// Grain of the ground: a square of noise that repeats, with smaller and smaller averages of itself, read with as many
// taps as a pixel is longer than wide. Made once; reading costs some nanoseconds.
#pragma once
#include <cstdint>
#include <initializer_list>
#include <vector>

namespace puppetri::render {

struct Octave {
    int cells;      // per side of the tile
    float strength;
};

class GroundTexture {
   public:
    // most_taps: how many places a long pixel may be read at.
    GroundTexture(float tile_m, int most_taps, std::initializer_list<Octave> octaves, std::uint32_t seed);
    // The mean over a pixel, about 0 (each octave adds noise in [-strength / 2, strength / 2]).
    float operator()(float x, float z, float width_x, float width_z) const;

   private:
    static constexpr int kLevels = 10, kSide = 1 << (kLevels - 1);  // 512, 256, .. 1
    float texel(int level, float u, float v) const;

    float tiles_per_metre_;
    int most_taps_;
    std::vector<std::vector<float>> levels_;
};

}  // namespace puppetri::render
