// SPDX-License-Identifier: MIT
// What is around the figures and needs no rays: the sky with far hills, the sun, haze, and the ground with its pattern.
// Patterns are filtered over the footprint of a pixel, so that lines neither flicker nor crawl while the camera moves.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "float3.h"
#include "puppetri/render/picture.h"

namespace puppetri::render {

class Environment {
   public:
    Environment(const Look& look, std::span<const stage::Set> sets);

    Float3 to_sun() const { return to_sun_; }
    Float3 sun() const { return {3.3f, 3.0f, 2.55f}; }  // radiance of a white surface that faces it
    // Light from the hemisphere around a normal, from the sky above and the ground below.
    Float3 ambient(Float3 normal) const;

    // The sky in a direction (unit length).
    Float3 sky(Float3 direction) const;
    // Colour of the ground at a point of y = 0; `width_x`, `width_z`: how far the pixel reaches there.
    Float3 ground(float x, float z, float width_x, float width_z) const;
    // Light after a way through the haze.
    Float3 haze(Float3 light, float distance_m, Float3 direction) const;

   private:
    Float3 road(float x, float z, float width_x, float width_z) const;
    Float3 floor(float x, float z, float width_x, float width_z) const;
    float hill(float azimuth_x, float azimuth_z, int layer) const;

    Float3 to_sun_;
    bool road_ = false;
    float half_width_ = 3, half_length_ = 1e6f, centre_x_ = 0, centre_z_ = 0, along_x_ = 0, along_z_ = 1;
    std::vector<Float3> gradient_;  // of the sky by the sine of elevation, 0 to 1
};

}  // namespace puppetri::render
