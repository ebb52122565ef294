// SPDX-License-Identifier: MIT
// Palettes: the few colours that a figure or a prop wears, chosen to go together under a warm sun.
// A scene names one
// (`palette teal`); everything that draws or exports gets the same linear colours from here.
#pragma once
#include <array>
#include <span>
#include <string_view>

namespace puppetri::figure {

// Linear RGB, each in [0, 1].
using Colour = std::array<float, 3>;

struct Palette {
    std::string_view name;
    Colour main;    // shirt; a ball's panels
    Colour second;  // trousers; a ball's other panels
    Colour accent;  // shoes, seams
    Colour skin;    // head, hands
    Colour hair;
};

// All palettes, in the order in which documentation shows them: teal, amber, ...
std::span<const Palette> palettes();

// The palette of that name, or null.
const Palette* find_palette(std::string_view name);

// From sRGB bytes, each in [0, 255], to linear.
Colour linear_from_srgb(int red, int green, int blue);

}  // namespace puppetri::figure
