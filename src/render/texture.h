// SPDX-License-Identifier: MIT
// Pictures on surfaces: PNG and JPEG decoded once, in linear light, with a pyramid of halves, so
// that what is far away does not flicker.
#pragma once
#include <array>
#include <optional>
#include <vector>

#include "float3.h"
#include "puppetri/figure/mesh.h"

namespace puppetri::render {

class TextureImage {
 public:
    // Nothing where the bytes are no picture, where it has more than 8192 pixels a side, or where
    // the program was built without a decoder for it: the material's colour is then used alone.
    static std::optional<TextureImage> decode(const figure::Texture& texture);

    // The colour around a point of the picture, over `width` in texture coordinates: between the
    // two nearest levels of the pyramid, and between texels.
    Float3 at(float u, float v, float width) const;

 private:
    struct Level {
        int width = 0, height = 0;
        std::vector<std::array<float, 3>> texels;
    };
    Float3 sample(const Level& level, float u, float v) const;

    std::vector<Level> levels_;
    figure::TextureWrap wrap_u_ = figure::TextureWrap::kRepeat,
                        wrap_v_ = figure::TextureWrap::kRepeat;
    bool smooth_ = true;
};

}  // namespace puppetri::render
