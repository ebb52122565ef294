// SPDX-License-Identifier: MIT
// Standing: breathing, weight that shifts from leg to leg, a gaze that wanders. Never a statue, and
// never a moving foot. Who sits goes on sitting.
#pragma once
#include "puppetri/motion/context.h"
#include "puppetri/motion/movement.h"

namespace puppetri::motion {

// A figure at rest at a place on the floor: feet side by side, arms hanging, looking ahead.
// Spaces  position_world is the point midway between the ankles, on the floor (y is the floor's
//         height); heading as in math/rotation.h.
Controls standing(const figure::Figure& figure, Vec3 position_world, double heading_rad);

// The arm that hangs at the side, and where the pelvis of a standing figure is above two given
// feet.
ArmControl hanging_arm(const figure::Figure& figure, Side side);
PelvisControl pelvis_over_feet(const figure::Figure& figure, const Controls& feet);

struct IdleSpec {
    LimbSet limbs = kAllLimbs;
    double duration_s = 2;  // what `takes auto` gets
    double liveliness = 1;  // scales breath, weight shift and gaze; 0 is a statue
    bool gets_up = false;   // from a seat; otherwise who sits goes on sitting
    // Arms that hang from the first instant on, wherever they were found: who asks joins them.
    LimbSet at_home = {};
};

// Stands where the feet are (who sits stays seated there, hands on the thighs; a creature stays
// where it is). Legs in the air are put down first. A
// prescribed duration in the context replaces the spec's. Deterministic in the context's seed.
MovementPtr make_idle(const MotionContext& context, const IdleSpec& spec);

}  // namespace puppetri::motion
