// SPDX-License-Identifier: MIT
#include "puppetri/io/frame_rate.h"

#include <numeric>

#include "puppetri/base/require.h"

namespace puppetri::io {
namespace {

__extension__ typedef __int128 Wide;

// a * b / c rounded towards minus infinity (or to the nearest) without overflow; c > 0.
std::int64_t scaled(std::int64_t a, std::int64_t b, std::int64_t c, bool nearest) {
    const Wide product = static_cast<Wide>(a) * b * (nearest ? 2 : 1) + (nearest ? c : 0);
    const Wide divisor = static_cast<Wide>(c) * (nearest ? 2 : 1);
    Wide quotient = product / divisor;
    if (product % divisor < 0) {
        --quotient;
    }
    return static_cast<std::int64_t>(quotient);
}

// Digits with at most one point as a ratio; at most nine digits.
std::optional<FrameRate> parse_decimal(std::string_view text) {
    std::int64_t digits = 0, scale = 1;
    int count = 0;
    bool point = false;
    for (const char c : text) {
        if (c == '.' && !point) {
            point = true;
        } else if (c >= '0' && c <= '9' && count < 9) {
            digits = digits * 10 + (c - '0');
            scale *= point ? 10 : 1;
            ++count;
        } else {
            return std::nullopt;
        }
    }
    if (count == 0 || digits == 0) {
        return std::nullopt;
    }
    const std::int64_t common = std::gcd(digits, scale);
    return FrameRate{digits / common, scale / common};
}

}  // namespace

SimTime FrameRate::time_of(std::int64_t frame) const {
    return {scaled(frame, kTicksPerSecond * denominator, numerator, true)};
}

std::int64_t FrameRate::frame_at_or_before(SimTime at) const {
    std::int64_t frame = scaled(at.ticks, numerator, kTicksPerSecond * denominator, false);
    // time_of rounds: the next frame may be shown at this very tick.
    if (time_of(frame + 1) <= at) {
        ++frame;
    }
    return frame;
}

std::int64_t FrameRate::nearest_frame(SimTime at) const {
    return scaled(at.ticks, numerator, kTicksPerSecond * denominator, true);
}

std::optional<FrameRate> parse_frame_rate(std::string_view text) {
    struct Television {
        std::string_view name;
        std::int64_t nominal;
    };
    static constexpr Television kTelevision[] = {{"23.976", 24}, {"23.98", 24}, {"29.97", 30},
                                                 {"47.952", 48}, {"47.95", 48}, {"59.94", 60},
                                                 {"119.88", 120}};
    for (const Television& known : kTelevision) {
        if (text == known.name) {
            return FrameRate{known.nominal * 1000, 1001};
        }
    }
    std::optional<FrameRate> rate;
    const std::size_t slash = text.find('/');
    if (slash == std::string_view::npos) {
        rate = parse_decimal(text);
    } else {
        const auto above = parse_decimal(text.substr(0, slash));
        const auto below = parse_decimal(text.substr(slash + 1));
        if (above && below && above->denominator == 1 && below->denominator == 1) {
            const std::int64_t common = std::gcd(above->numerator, below->numerator);
            rate = FrameRate{above->numerator / common, below->numerator / common};
        }
    }
    if (rate && rate->numerator > 1000 * rate->denominator) {
        return std::nullopt;
    }
    return rate;
}

std::string to_string(FrameRate rate) {
    const std::string above = std::to_string(rate.numerator);
    return rate.denominator == 1 ? above : above + "/" + std::to_string(rate.denominator);
}

}  // namespace puppetri::io
