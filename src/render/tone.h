// SPDX-License-Identifier: MIT
// From light to bytes: a filmic curve, then sRGB, in one table.
#pragma once
#include <array>
#include <cstdint>

#include "float3.h"

namespace puppetri::render {

class Tone {
 public:
    Tone();
    // 0 .. 255, not yet rounded.
    float operator()(float light) const {
        const float at = std::sqrt(std::clamp(light, 0.0f, kBrightest)) * kScale;
        const auto i = static_cast<std::size_t>(at);
        return table_[i] + (table_[i + 1] - table_[i]) * (at - static_cast<float>(i));
    }

 private:
    static constexpr float kBrightest = 8;
    static constexpr int kSteps = 1024;
    static constexpr float kScale = kSteps / 2.8284272f;  // of the root of the brightest
    std::array<float, kSteps + 2> table_{};
};

}  // namespace puppetri::render
