// SPDX-License-Identifier: MIT
// Ways made of steps and turns: a walk of some steps, and going to a place.
#pragma once
#include <optional>

#include "puppetri/motion/context.h"
#include "puppetri/motion/gait.h"
#include "puppetri/motion/movement.h"

namespace puppetri::motion {

// Walks k steps from standing to standing: a half one, k - 1 whole ones, a half one. `first` gives
// side, stroke, duration (where the context prescribes none), duty and limbs.
MovementPtr make_walk(const MotionContext& context, StepSpec first, int steps);

struct GoSpec {
    Vec3 to_world = {};   // where it shall stand: the point midway between the ankles
    double before_m = 0;  // so far before that point it stops
    // The heading in the end; none: the one of the way.
    std::optional<double> heading_rad = {};
    double most_stroke_m = 0.6;  // of a figure of 1.75 m
    LimbSet limbs = kAllLimbs;
};

// The longest way that is gone.
inline constexpr double kFarthestWay_m = 200;

// Turns to the place, walks there in steps of one length (those beyond 0.6 m take longer), and
// turns to the heading. What turning shifts the feet aside is allowed for: it ends within a few
// millimetres of the place. A prescribed duration is shared by all parts. Cost  of preparing: about
// two milliseconds, and a third of one for every step.
MovementPtr make_go(const MotionContext& context, const GoSpec& spec);

}  // namespace puppetri::motion
