// SPDX-License-Identifier: MIT
// Steps: the gait of Girard and Maciejewski (1985) as the papers use it. A step lasts n and carries
// the body by its stroke x while one leg supports and the other transfers; half steps, n/2 and x/2,
// leave and reach rest. The duty factor is the part of the gait's period 2n that a foot spends on
// the ground: above 0.5 the figure walks (both feet planted around the border of two steps, which
// lies in the middle of that double support), below 0.5 it runs.
#pragma once
#include "puppetri/motion/context.h"
#include "puppetri/motion/movement.h"

namespace puppetri::motion {

enum class StepKind : std::uint8_t {
    kFirstHalf,  // from rest; the foot travels x, the body x/2
    kWhole,      // the foot travels 2x, the body x
    kLastHalf,   // to rest, feet together; the foot travels x, the body x/2
};

struct StepSpec {
    Side transfer = Side::kRight;  // the leg that swings
    StepKind kind = StepKind::kWhole;
    double stroke_m = 0.6;          // x, of a whole step
    double duration_s = 20.0 / 24;  // n, of a whole step; half steps last half of it
    double duty_factor = 0.62;      // in [0.2, 0.9]
    LimbSet limbs = kAllLimbs;      // what the movement drives; see the single-limb forms below
};

// The length of this movement: n or n/2. A duration that the net prescribes in the context replaces
// it (n becomes the prescribed length, or twice it for a half step).
double step_duration_s(const StepSpec& spec);
// The longest stroke that this figure can walk or run; a longer one is shortened to it. A walk's is
// shorter where feet are long for the legs: from ankle to ball beyond 0.35 of the leg.
double longest_stroke_m(const figure::Figure& figure, double duty_factor);

// A step. It goes where the feet point, along the line midway between them, and begins with the
// state of the context whatever that is: feet in the air land first where they are headed.
// Events  "foot_off" and "foot_strike" of the legs. Phases: support and swing of both legs.
// Needs   stroke_m >= 0, duration_s > 0.
// Gives   a pelvis at most 0.1 m off the formula, and feet that never slide: a stroke beyond what
//         this figure's legs can do (0.87 of the leg, 43 % of the height, in a walk; less with a
//         long double support) is shortened.
// Cost    a third of a millisecond to prepare; a sample allocates nothing.
MovementPtr make_step(const MotionContext& context, const StepSpec& spec);

// The four single-limb movements of a step, to be run side by side from the same context: together
// they give exactly make_step. The support leg's drives the pelvis and the body too.
LimbSet support_limbs(Side transfer);   // pelvis, body, support leg
LimbSet transfer_limbs(Side transfer);  // the transfer leg

}  // namespace puppetri::motion
