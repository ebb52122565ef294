// SPDX-License-Identifier: MIT
// The colours of the ground: a road between meadows, or a floor with a grid. Grain comes from
// squares of noise that repeat, with smaller and smaller averages of themselves; lines are averaged
// over a pixel by formula. So nothing flickers or crawls while the camera moves.
#pragma once
#include <cstdint>
#include <initializer_list>
#include <vector>

#include "lanes.h"

namespace puppetri::render {

struct Octave {
    int cells;  // per side of the tile
    float strength;
};

// A tile of noise about 0 (each octave lies in [-strength / 2, strength / 2]) and its averages.
class GrainTile {
 public:
    GrainTile(float tile_m, std::initializer_list<Octave> octaves, std::uint32_t seed);

    static constexpr int kLevels = 10, kSide = 1 << (kLevels - 1);  // 512, 256, .. 1 texels a side
    float tiles_per_metre = 1, step = 1;  // step: between two values of a byte
    // All levels one after the other. Per texel a byte for itself, its right, its lower and its
    // lower right neighbour, so that one load serves an interpolation.
    std::vector<std::uint32_t> texels;
    std::int32_t blank_level = kLevels;  // from here on nothing is left to see
};

// Points of the ground (y = 0) that pixels see: where, and how far the pixel reaches along either
// axis.
struct GroundPoints {
    Lanes8 x, z, width_x, width_z;
};

class Ground {
 public:
    // road: along +Z around x = 0, `width_m` wide, endless. Otherwise a floor with lines every
    // metre.
    Ground(bool road, float width_m);
    void colours(const GroundPoints& points, Colours8& out) const;

 private:
    bool road_;
    float half_width_;
    GrainTile fine_, coarse_, wide_;
};

}  // namespace puppetri::render
