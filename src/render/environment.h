// SPDX-License-Identifier: MIT
// What is around the figures and needs no rays: the sky with far hills, the sun, haze, and the
// ground.
#pragma once
#include <array>
#include <span>
#include <vector>

#include "float3.h"
#include "ground.h"
#include "puppetri/render/picture.h"

namespace puppetri::render {

class Environment {
 public:
    Environment(Vec3 to_sun_world, std::span<const stage::Set> sets);

    Float3 to_sun() const { return to_sun_; }
    Float3 sun() const {
        return {3.35f, 3.0f, 2.5f};
    }  // light that a white surface facing it sends back
    // Light from the hemisphere around a normal, from the sky above and the ground below.
    Float3 ambient(Float3 normal) const;

    // The sky in a direction (unit length).
    Float3 sky(Float3 direction) const;
    // Colours of the ground at points of the world.
    void ground(const GroundPoints& world, Colours8& out) const;
    // Light after a way through the haze.
    Float3 haze(Float3 light, float distance_m) const;

 private:
    Float3 to_sun_;
    bool road_ = false;
    float centre_x_ = 0, centre_z_ = 0, along_x_ = 0, along_z_ = 1;
    std::vector<Float3> gradient_;             // of the sky by the sine of elevation, 0 to 1
    std::vector<std::array<float, 2>> hills_;  // heights of two chains as slopes, by azimuth
    Ground ground_;
};

}  // namespace puppetri::render
