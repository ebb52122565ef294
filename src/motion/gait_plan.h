// SPDX-License-Identifier: MIT
// The plan of one step, made once when the step is prepared: times, footprints, and curves in the
// frame of the path.
#pragma once
#include "foot_path.h"
#include "puppetri/motion/gait.h"

namespace puppetri::motion {

// How a step that walks on comes to rest where the next one is late: the pelvis goes on over the
// front foot, slower and slower, and the heel of the foot behind rises with it. Times are seconds
// after the step's end.
struct Halt {
    static constexpr double kRamp = 0.1;
    double length_s = 0;  // 0: it has none
    FootPath support;     // of the support leg
    Curve1 height;        // of the pelvis
    // How far along its own curves the step is past its end: the pace falls from 1 to 0, half
    // of length_s at last.
    double past_end_s(double late_s) const;
};

// Path space: the support foot's ankle, put on the floor, is the origin; +Z is the way ahead, +Y
// up, +X left.
struct StepPlan {
    double duration_s = 0;
    Transform world_from_path;
    double heading_rad = 0;
    // When feet leave and meet the floor, seconds after the start; beyond [0, duration] where that
    // happens in a neighbour step. Of the transfer leg, and of the support leg (below duty factor
    // 0.5 it flies too).
    double lift_s = 0, strike_s = 0;
    double support_strike_s = 0, support_lift_s = 0;
    std::array<FootPath, 2> feet;    // by Side
    Curve3 pelvis_path;              // the joint `hips`
    Vec3 rest_path;                  // where the pelvis comes to rest after the last half step
    Curve1 pelvis_yaw, pelvis_list;  // relative to the heading; list is about the way ahead
    Curve1 arm_swing;  // of the left shoulder, ahead is positive; the right arm's is the negative
    bool runs = false;
    Halt halt;
    double lean_rad = 0;  // largest forward lean of the trunk during this step beyond the usual
};

// What is planned takes a sixth of a second at least, half steps a tenth: a net that allows less
// cuts the movement there, and the next goes on from that pose.
// Below it a foot is on the ground for less than half of the time: a run.
inline constexpr double kRunsBelow = 0.495;

double plan_duration_s(const MotionContext& context, const StepSpec& spec);
StepPlan plan_step(const MotionContext& context, const StepSpec& spec);
double longest_run_stroke_m(const figure::Figure& figure, double duty_factor);
StepPlan plan_run(const MotionContext& context,
                  const StepSpec& spec);  // below a duty factor of 0.5

}  // namespace puppetri::motion
