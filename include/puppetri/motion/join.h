// SPDX-License-Identifier: MIT
// The ruler for joins: whether a figure goes from one movement to the next without a jump. It sees
// the transforms of joints in the world around one instant and nothing else, so that prepared
// movements, a run under way, a performance and a file that was read back are judged alike. The
// limits are those of the table "What good motion measures".
#pragma once
#include <cstdint>
#include <span>

#include "puppetri/figure/mannequin.h"

namespace puppetri::motion {

// Joints that are judged together. kNone: none of a limb, such as the root.
enum class JointGroup : std::uint8_t {
    kNone,
    kKnee,
    kHip,
    kAnkle,
    kToes,
    kSpine,
    kNeck,
    kArm,
    kFingers
};
JointGroup group_of(const figure::Figure& figure, figure::JointIndex joint);

struct JoinLimits {
    double position_m = 1e-6;
    double pelvis_m_s = 0.05;
    double hand_m_s = 0.2, foot_m_s = 0.2;
    double acceleration_ratio = 1.5;
};

struct JoinInput {
    const figure::Figure& figure;
    // Fills world_from_joint, one per joint of the skeleton.
    void (*sample)(void* context, double t_s, std::span<Transform> world_from_joint) = nullptr;
    void* context = nullptr;
    double at_s = 0;                // the instant at which a movement begins
    double begin_s = 0, end_s = 0;  // what can be sampled
    double rate_hz = 480;           // of the grid from begin_s on for accelerations
};

// The worst of one quantity and the joint that has it.
struct JoinValue {
    double value = 0;
    figure::JointIndex joint;
};

struct JoinMeasures {
    bool measured = false;  // false: less than a grid step of motion on one side
    JoinValue position_m;   // jump of any joint from one side to the other, motion taken out
    JoinValue pelvis_m_s, hand_m_s, foot_m_s;  // jump of velocity
    // Angular acceleration of a joint's relative rotation across the join, against the largest
    // within 60 ms on either side. Fingers are left out; accelerations below 20 rad/s^2, a
    // twentieth of what a walk may reach, are no jerk whatever their ratio.
    JoinValue acceleration_ratio;
};

// Position and velocity are limits from both sides, from samples 10 microseconds apart.
// Gives   with `enough`: acceleration_ratio is exact where it is above the limit, else only known
// to
//         be below it; then few samples are taken of a join that is good.
// Cost    8 samples, and 4 to 60 for accelerations.
JoinMeasures measure_join(const JoinInput& input, const JoinLimits* enough = nullptr);

// The first quantity that is out of its limit; `quantity` is null where none is.
struct JoinFault {
    const char* quantity = nullptr;  // "velocity"
    const char* unit = "";           // "m/s"; empty: a ratio
    double value = 0, limit = 0;
    figure::JointIndex joint;
};
JoinFault fault_of(const JoinMeasures& measures, const JoinLimits& limits);

}  // namespace puppetri::motion
