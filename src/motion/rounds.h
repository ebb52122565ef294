// SPDX-License-Identifier: MIT
// Time of a movement to time of the source that it plays: slower, faster, or round after round.
#pragma once
#include <algorithm>
#include <cmath>
#include <vector>

#include "puppetri/motion/movement.h"
#include "puppetri/motion/posed.h"
#include "times.h"

namespace puppetri::motion {

class Rounds {
 public:
    Rounds() = default;
    Rounds(const PosedSpec& spec, SimTime duration) : loops_(spec.loops), end_s_(spec.duration_s) {
        const double given_s = duration.seconds();
        if (given_s > 0 && end_s_ > 0) {
            count_ = loops_ ? clamp(std::nearbyint(given_s / end_s_), 1, 1e6) : 1;
            // What goes on anyway may be cut anywhere: no figure hurries through a round for it.
            // Events that a net may wait for are all told.
            const bool cut = loops_ && spec.events.empty() && given_s < end_s_ / 2;
            pace_ = cut ? 1 : count_ * end_s_ / given_s;
        }
        if (!spec.stretches) {
            pace_ = std::fmax(pace_, 1);
        }
    }

    struct At {
        double source_s = 0;  // within the source's duration
        double round = 0;     // how many lie behind
    };
    // `short_of_end_s`: what does not loop rests so much before its end.
    At at(double t_s, double short_of_end_s = 0) const {
        const double t = t_s * pace_;
        if (!loops_ || end_s_ <= 0) {
            return {clamp(t, 0, end_s_ - short_of_end_s), 0};
        }
        const double round = std::fmax(0, std::floor(t / end_s_));
        return {clamp(t - round * end_s_, 0, end_s_), round};
    }
    // When the source's instant of a round is.
    SimTime time_of(double source_s, int round = 0) const {
        return to_time((round * end_s_ + source_s) / pace_);
    }
    double pace() const { return pace_; }  // seconds of the source per second
    // Rounds within the movement's duration of which events and contacts are told.
    int told() const { return static_cast<int>(std::fmin(count_, 1000)); }

    // The events of all rounds.
    void tell_events(const PosedSpec& spec, std::vector<MovementEvent>& events) const {
        for (int round = 0; round < told(); ++round) {
            for (const PosedSpec::Event& e : spec.events) {
                events.push_back({time_of(e.at_s, round), e.name, e.limb});
            }
        }
    }

 private:
    bool loops_ = false;
    double end_s_ = 0, pace_ = 1, count_ = 1;
};

}  // namespace puppetri::motion
