// SPDX-License-Identifier: MIT
#include "texture.h"

#ifdef PUPPETRI_WITH_PNG
#include <png.h>
#endif
#ifdef PUPPETRI_WITH_STB
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wall"
#pragma GCC diagnostic ignored "-Wextra"
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wsign-conversion"
#pragma GCC diagnostic ignored "-Wold-style-cast"
#pragma GCC diagnostic ignored "-Wcast-qual"
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wdouble-promotion"
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wuseless-cast"
#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#define STBI_ONLY_JPEG
#define STBI_NO_STDIO
#include <stb/stb_image.h>
#pragma GCC diagnostic pop
#endif

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>

#include "puppetri/figure/palette.h"

namespace puppetri::render {
namespace {

constexpr int kMostSide = 8192;

struct Pixels {
    int width = 0, height = 0;
    std::vector<unsigned char> rgb;
};

Pixels decode_png([[maybe_unused]] const std::string& bytes) {
    Pixels out;
#ifdef PUPPETRI_WITH_PNG
    png_image image;
    std::memset(&image, 0, sizeof image);
    image.version = PNG_IMAGE_VERSION;
    if (png_image_begin_read_from_memory(&image, bytes.data(), bytes.size()) == 0) {
        return out;
    }
    if (image.width == 0 || image.height == 0 || image.width > kMostSide ||
        image.height > kMostSide) {
        png_image_free(&image);
        return out;
    }
    image.format = PNG_FORMAT_RGBA;
    std::vector<unsigned char> rgba(PNG_IMAGE_SIZE(image));
    if (png_image_finish_read(&image, nullptr, rgba.data(), 0, nullptr) != 0) {
        out.width = static_cast<int>(image.width);
        out.height = static_cast<int>(image.height);
        for (std::size_t i = 0; i + 3 < rgba.size(); i += 4) {
            out.rgb.insert(out.rgb.end(), {rgba[i], rgba[i + 1], rgba[i + 2]});
        }
    }
    png_image_free(&image);
#endif
    return out;
}

Pixels decode_jpeg([[maybe_unused]] const std::string& bytes) {
    Pixels out;
#ifdef PUPPETRI_WITH_STB
    const auto* data = reinterpret_cast<const stbi_uc*>(bytes.data());
    const int size = static_cast<int>(bytes.size());
    int width = 0, height = 0, channels = 0;
    if (bytes.size() > (1u << 28) ||
        stbi_info_from_memory(data, size, &width, &height, &channels) == 0 || width <= 0 ||
        height <= 0 || width > kMostSide || height > kMostSide) {
        return out;
    }
    if (stbi_uc* rgb = stbi_load_from_memory(data, size, &width, &height, &channels, 3)) {
        out.width = width;
        out.height = height;
        out.rgb.assign(
            rgb, rgb + static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 3);
        stbi_image_free(rgb);
    }
#endif
    return out;
}

std::array<float, 256> make_linear() {
    std::array<float, 256> table{};
    for (std::size_t i = 0; i < 256; ++i) {
        table[i] = figure::linear_from_srgb(static_cast<int>(i), 0, 0)[0];
    }
    return table;
}

// Into [0, size), as the sampler says.
int wrapped(int i, int size, figure::TextureWrap wrap) {
    if (wrap == figure::TextureWrap::kClamp) {
        return std::clamp(i, 0, size - 1);
    }
    const int period = wrap == figure::TextureWrap::kMirror ? 2 * size : size;
    int at = i % period;
    at = at < 0 ? at + period : at;
    return at < size ? at : 2 * size - 1 - at;
}

}  // namespace

std::optional<TextureImage> TextureImage::decode(const figure::Texture& texture) {
    const Pixels pixels =
        texture.mime_type == "image/png" ? decode_png(texture.bytes) : decode_jpeg(texture.bytes);
    if (pixels.rgb.empty()) {
        return std::nullopt;
    }
    TextureImage image;
    image.wrap_u_ = texture.wrap_u;
    image.wrap_v_ = texture.wrap_v;
    image.smooth_ = texture.smooth;
    static const std::array<float, 256> linear = make_linear();
    Level first{pixels.width, pixels.height, {}};
    first.texels.reserve(pixels.rgb.size() / 3);
    for (std::size_t i = 0; i + 2 < pixels.rgb.size(); i += 3) {
        first.texels.push_back(
            {linear[pixels.rgb[i]], linear[pixels.rgb[i + 1]], linear[pixels.rgb[i + 2]]});
    }
    image.levels_.push_back(std::move(first));
    while (image.levels_.back().width > 1 || image.levels_.back().height > 1) {
        const Level& fine = image.levels_.back();
        Level half{std::max(fine.width / 2, 1), std::max(fine.height / 2, 1), {}};
        half.texels.reserve(static_cast<std::size_t>(half.width) *
                            static_cast<std::size_t>(half.height));
        for (int y = 0; y < half.height; ++y) {
            for (int x = 0; x < half.width; ++x) {
                std::array<float, 3> sum{};
                for (int k = 0; k < 4; ++k) {
                    const int fx = std::min(2 * x + (k & 1), fine.width - 1),
                              fy = std::min(2 * y + (k >> 1), fine.height - 1);
                    const auto& t = fine.texels[static_cast<std::size_t>(fy * fine.width + fx)];
                    for (std::size_t c = 0; c < 3; ++c) {
                        sum[c] += t[c] / 4;
                    }
                }
                half.texels.push_back(sum);
            }
        }
        image.levels_.push_back(std::move(half));
    }
    return image;
}

Float3 TextureImage::sample(const Level& level, float u, float v) const {
    const auto texel = [&](int x, int y) {
        return float3(level.texels[static_cast<std::size_t>(
            wrapped(y, level.height, wrap_v_) * level.width + wrapped(x, level.width, wrap_u_))]);
    };
    // Coordinates far outside lose their fraction anyway.
    const float x = std::clamp(u, -1e4f, 1e4f) * static_cast<float>(level.width) - 0.5f,
                y = std::clamp(v, -1e4f, 1e4f) * static_cast<float>(level.height) - 0.5f;
    if (!smooth_) {
        return texel(static_cast<int>(std::floor(x + 0.5f)),
                     static_cast<int>(std::floor(y + 0.5f)));
    }
    const float fx = std::floor(x), fy = std::floor(y), a = x - fx, b = y - fy;
    const int ix = static_cast<int>(fx), iy = static_cast<int>(fy);
    return (texel(ix, iy) * (1 - a) + texel(ix + 1, iy) * a) * (1 - b) +
           (texel(ix, iy + 1) * (1 - a) + texel(ix + 1, iy + 1) * a) * b;
}

Float3 TextureImage::at(float u, float v, float width) const {
    const float texels = width * static_cast<float>(std::max(levels_[0].width, levels_[0].height));
    const float level = texels > 1 ? std::log2(texels) : 0;
    const float last = static_cast<float>(levels_.size() - 1);
    const float low = std::min(std::floor(level), last), rest = std::min(level, last) - low;
    const auto i = static_cast<std::size_t>(low);
    if (rest <= 0) {
        return sample(levels_[i], u, v);
    }
    return sample(levels_[i], u, v) * (1 - rest) + sample(levels_[i + 1], u, v) * rest;
}

}  // namespace puppetri::render
