// SPDX-License-Identifier: MIT
#include "puppetri/figure/palette.h"

namespace puppetri::figure {
namespace {

// The table below was made from sRGB bytes with linear_from_srgb; what matters is how the colours
// look beside each other: muted mains of like lightness, dark neutral trousers, light shoes.
struct Row {
    std::string_view name;
    std::array<std::array<int, 3>, 5> srgb;  // main, second, accent, skin, hair
};

constexpr Row kRows[] = {
    {"teal", {{{20, 120, 124}, {44, 52, 66}, {232, 226, 214}, {226, 178, 146}, {58, 42, 36}}}},
    {"amber", {{{226, 132, 28}, {62, 56, 72}, {240, 236, 228}, {176, 120, 86}, {34, 28, 30}}}},
    {"coral", {{{225, 98, 84}, {48, 58, 78}, {238, 232, 222}, {238, 196, 168}, {122, 72, 40}}}},
    {"violet", {{{124, 96, 178}, {52, 50, 60}, {234, 228, 220}, {206, 154, 120}, {44, 34, 34}}}},
    {"moss", {{{112, 146, 72}, {70, 58, 50}, {236, 230, 214}, {222, 174, 140}, {150, 98, 52}}}},
    {"sky", {{{84, 152, 210}, {56, 60, 74}, {240, 238, 232}, {126, 82, 60}, {26, 22, 22}}}},
    {"red", {{{206, 52, 46}, {244, 238, 226}, {40, 44, 52}, {230, 186, 154}, {70, 48, 36}}}},
    {"white", {{{232, 230, 224}, {66, 70, 80}, {210, 206, 198}, {226, 178, 146}, {58, 42, 36}}}},
    {"clay",
     {{{206, 172, 140}, {196, 160, 128}, {184, 148, 116}, {212, 180, 150}, {186, 150, 118}}}},
};
constexpr std::size_t kCount = sizeof(kRows) / sizeof(kRows[0]);

// The sRGB curve, IEC 61966-2-1: ((c + 0.055) / 1.055)^2.4. The power is x^2 * x^0.4, and y = x^0.4
// solves y^5 = x^2 by Newton's method: no libm, the same bits everywhere.
constexpr float linear(int byte) {
    const double c = byte / 255.0;
    if (c <= 0.04045) {
        return static_cast<float>(c / 12.92);
    }
    const double x = (c + 0.055) / 1.055;
    double y = 1;
    for (int i = 0; i < 24; ++i) {
        const double y4 = y * y * y * y;
        y -= (y4 * y - x * x) / (5 * y4);
    }
    return static_cast<float>(x * x * y);
}

constexpr Colour colour(const std::array<int, 3>& c) {
    return {linear(c[0]), linear(c[1]), linear(c[2])};
}

constexpr std::array<Palette, kCount> make_palettes() {
    std::array<Palette, kCount> all{};
    for (std::size_t i = 0; i < kCount; ++i) {
        const auto& c = kRows[i].srgb;
        all[i] = {kRows[i].name, colour(c[0]), colour(c[1]),
                  colour(c[2]),  colour(c[3]), colour(c[4])};
    }
    return all;
}

constexpr std::array<Palette, kCount> kPalettes = make_palettes();

}  // namespace

std::span<const Palette> palettes() { return kPalettes; }

const Palette* find_palette(std::string_view name) {
    for (const Palette& p : kPalettes) {
        if (p.name == name) {
            return &p;
        }
    }
    return nullptr;
}

Colour linear_from_srgb(int red, int green, int blue) { return colour({red, green, blue}); }

}  // namespace puppetri::figure
