// SPDX-License-Identifier: MIT
#include "horizon.h"

#include <optional>

#include "puppetri/lang/decimal.h"
#include "puppetri/lang/units.h"

namespace puppetri::cli {
namespace {

constexpr const char* kForms = "write a time (40s), frames (960f) or firings (1000x)";

}  // namespace

Result<scene::Horizon, std::string> parse_horizon(const std::string& text,
                                                  const scene::FrameRate& rate) {
    const std::size_t split = text.find_first_not_of("0123456789.");
    const std::string digits = text.substr(0, split);
    std::string unit = split == std::string::npos ? "" : text.substr(split);
    unit.erase(0, unit.find_first_not_of(' '));
    const auto number = lang::parse_decimal(digits);
    if (!number || unit.empty()) {
        return Unexpected(text + " says nothing that can be counted: " + kForms);
    }
    scene::Horizon horizon;
    if (unit == "x" || unit == "firing" || unit == "firings") {
        if (!number->whole()) {
            return Unexpected("firings are whole: " + std::string(kForms));
        }
        horizon.firings = static_cast<std::uint64_t>(number->numerator);
        return horizon;
    }
    if (unit == "f" || unit == "frame" || unit == "frames") {
        horizon.time = number->whole() ? rate.time_of_frame(number->numerator) : std::nullopt;
    } else if (const auto q = lang::to_quantity(*number, unit);
               q && q->dimension == lang::dimension::kTime && q->pi_power == 0) {
        if (const auto ticks = to_ticks(q->number)) {
            horizon.time = ticks->time;
        }
    }
    if (!horizon.time) {
        return Unexpected(text + " is no time that fits: " + kForms);
    }
    return horizon;
}

}  // namespace puppetri::cli
