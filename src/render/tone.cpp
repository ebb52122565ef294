// SPDX-License-Identifier: MIT
// Source  the curve is K. Narkowicz's fit of the ACES reference transform (2015), with an exposure
// below 1 so that
//         white cloth stays below the shoulder.
#include "tone.h"

namespace puppetri::render {

Tone::Tone() {
    constexpr float kExposure = 0.53f;
    for (int i = 0; i < kSteps + 2; ++i) {
        const float root = static_cast<float>(i) / kScale;
        const float x = root * root * kExposure;
        const float film =
            std::clamp(x * (2.51f * x + 0.03f) / (x * (2.43f * x + 0.59f) + 0.14f), 0.0f, 1.0f);
        const float srgb =
            film <= 0.0031308f ? 12.92f * film : 1.055f * std::pow(film, 1 / 2.4f) - 0.055f;
        table_[static_cast<std::size_t>(i)] = 255 * srgb;
    }
}

}  // namespace puppetri::render
