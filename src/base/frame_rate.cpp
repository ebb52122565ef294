// SPDX-License-Identifier: MIT
// With T ticks a second, frame k of the rate n/d is at k T d / n. To stay within 64 bits the
// products are split: k d = q n + r gives q T + r T / n; an instant of s seconds and f ticks, s n =
// q d + r, is frame q + (r T + f n) / (T d).
#include "puppetri/base/frame_rate.h"

#include <limits>
#include <numeric>

#include "puppetri/base/require.h"

namespace puppetri {
namespace {

constexpr std::int64_t kMost = std::numeric_limits<std::int64_t>::max();

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

std::optional<SimTime> FrameRate::time_of_frame(std::int64_t frame) const {
    if (frame < 0 || frame > kMost / denominator) {
        return std::nullopt;
    }
    const std::int64_t seconds = frame * denominator / numerator;
    const std::int64_t rest = frame * denominator % numerator;
    if (seconds >= kMost / kTicksPerSecond) {
        return std::nullopt;
    }
    std::int64_t ticks = seconds * kTicksPerSecond + rest * kTicksPerSecond / numerator;
    const std::int64_t over = rest * kTicksPerSecond % numerator, under = numerator - over;
    if (over > under || (over == under && ticks % 2 != 0)) {
        ++ticks;
    }
    return SimTime{ticks};
}

SimTime FrameRate::time_of(std::int64_t frame) const {
    const std::optional<SimTime> at = time_of_frame(frame);
    PUP_REQUIRE(at.has_value());
    return *at;
}

std::int64_t FrameRate::frame_at_or_before(SimTime at) const {
    PUP_REQUIRE(at.ticks >= 0);
    const std::int64_t whole = at.ticks / kTicksPerSecond, part = at.ticks % kTicksPerSecond;
    PUP_REQUIRE(whole <= kMost / numerator);
    const std::int64_t frames = whole * numerator / denominator;
    const std::int64_t rest = whole * numerator % denominator;
    std::int64_t frame =
        frames + (rest * kTicksPerSecond + part * numerator) / (kTicksPerSecond * denominator);
    // time_of_frame rounds: the next frame may be shown at this very tick, or this one after it.
    if (const auto next = time_of_frame(frame + 1); next && *next <= at) {
        ++frame;
    } else if (time_of(frame) > at) {
        --frame;
    }
    return frame;
}

std::int64_t FrameRate::nearest_frame(SimTime at) const {
    const std::int64_t before = frame_at_or_before(at);
    const std::optional<SimTime> next = time_of_frame(before + 1);
    return next && *next - at <= at - time_of(before) ? before + 1 : before;
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

}  // namespace puppetri
