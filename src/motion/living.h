// SPDX-License-Identifier: MIT
// What makes a standing or a seated figure live: breath, weight that wanders from leg to leg, a
// glance now and then. Slow sums of sines with phases from a seed; added to a standing pose, it
// never moves a foot.
#pragma once
#include "puppetri/figure/mannequin.h"
#include "puppetri/motion/controls.h"

namespace puppetri::motion {

class Living {
 public:
    Living() = default;
    Living(const figure::Figure& figure, std::uint64_t seed, double liveliness);

    // Changes pelvis, body and hands of a standing figure by what it does at t_s, scaled by `part`
    // in [0, 1]; a movement that fades it in lets `part` grow smoothly.
    void add(double t_s, double part, Controls& controls) const;
    // The same of a seated one, whose pelvis and hands rest.
    void add_seated(double t_s, Controls& controls) const;

 private:
    double wave(int channel, double period_s, double t_s) const;

    double height_m_ = 0, liveliness_ = 0;
    double phase_[9] = {};
};

// A smooth rise from 0 at 0 to 1 at `over_s`, with rate and acceleration 0 at both ends.
double smooth_rise(double t_s, double over_s);

}  // namespace puppetri::motion
