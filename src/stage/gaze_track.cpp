// SPDX-License-Identifier: MIT
#include "gaze_track.h"

#include "puppetri/base/elementary.h"

namespace puppetri::stage {
namespace {

// Heads reach a new target in about half a second (Guitton and Volle 1987 measured 0.3 to 0.6 s for
// 40 to 80 degrees).
constexpr double kStiffness_per_s = 9;
constexpr double kStep_s = 1.0 / GazeTrack::kRate_hz;

}  // namespace

// x'' = w^2 (target - x) - 2 w x', solved exactly over one period with the target held.
void GazeTrack::follow(Vec3 wanted) {
    const double w = kStiffness_per_s, fade = exp(-w * kStep_s);
    const Sample& last = samples_.back();
    const Vec3 x = last.position - wanted, slope = last.velocity + x * w;
    samples_.push_back(
        {wanted + (x + slope * kStep_s) * fade, (last.velocity - slope * (w * kStep_s)) * fade});
}

Vec3 GazeTrack::at(SimTime at) const {
    if (samples_.empty()) {
        return {};
    }
    constexpr std::int64_t kPeriod = kTicksPerSecond / kRate_hz;
    const std::int64_t i = at.ticks > 0 ? at.ticks / kPeriod : 0;
    if (i + 1 >= static_cast<std::int64_t>(samples_.size())) {
        return samples_.back().position;
    }
    const Sample &a = samples_[static_cast<std::size_t>(i)],
                 &b = samples_[static_cast<std::size_t>(i) + 1];
    const double u = static_cast<double>(at.ticks - i * kPeriod) / kPeriod, v = 1 - u;
    // Cubic Hermite.
    return a.position * ((1 + 2 * u) * v * v) + a.velocity * (u * v * v * kStep_s) +
           b.position * ((3 - 2 * u) * u * u) - b.velocity * (u * u * v * kStep_s);
}

}  // namespace puppetri::stage
