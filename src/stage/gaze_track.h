// SPDX-License-Identifier: MIT
// The turning of a head that follows a target which jumps (from a partner to a flying ball and
// back): a critically damped follower, run once over the whole take and kept as samples, so that
// poses can then be asked in any order.
#pragma once
#include <vector>

#include "puppetri/base/time.h"
#include "puppetri/math/transform.h"

namespace puppetri::stage {

class GazeTrack {
 public:
    static constexpr std::int64_t kRate_hz = 60;

    GazeTrack() = default;
    // Starts at rest at `first`.
    explicit GazeTrack(Vec3 first) : samples_{{first, {}}} {}

    // Follows the wanted rotation vector for one more sample period.
    void follow(Vec3 wanted);
    // What the head does beyond its movement at that instant: a rotation vector. Beyond the last
    // sample it stays.
    Vec3 at(SimTime at) const;
    bool empty() const { return samples_.empty(); }

 private:
    struct Sample {
        Vec3 position, velocity;
    };
    std::vector<Sample> samples_;
};

}  // namespace puppetri::stage
