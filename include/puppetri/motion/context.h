// SPDX-License-Identifier: MIT
// The state from which a movement is prepared. A movement knows the past, its own parameters and
// nothing of what comes after it; that it starts exactly from this state, in position and velocity,
// makes every join smooth.
#pragma once
#include <cstdint>

#include "puppetri/base/time.h"
#include "puppetri/figure/mannequin.h"
#include "puppetri/motion/controls.h"
#include "puppetri/motion/movement.h"

namespace puppetri::motion {

// Time derivatives of Controls, channel by channel. Angular velocities are in the space named by
// the suffix.
struct ControlsRate {
    struct Leg {
        Vec3 ankle_velocity_world, foot_angular_world;
        double toe_bend_rad_s = 0, swivel_rad_s = 0;
    };
    struct Arm {
        Vec3 hand_velocity_chest, hand_angular_chest;
        Vec3 hand_velocity_world, hand_angular_world;
        double swivel_rad_s = 0, relaxed_per_s = 0, spread_per_s = 0, grip_per_s = 0,
               world_weight_per_s = 0;
    };
    Vec3 pelvis_velocity_world, pelvis_angular_world;
    Vec3 chest_angular_pelvis, head_angular_chest;
    double breath_per_s = 0;
    std::array<Leg, 2> legs;
    std::array<Arm, 2> arms;
};

// The mean rate from a to b, dt_s > 0 seconds later. For the rate at the end of a movement sample
// it twice, about a tenth of a millisecond apart.
ControlsRate rate_between(const Controls& a, const Controls& b, double dt_s);

struct MotionContext {
    const figure::Figure& figure;
    Controls now;
    ControlsRate rate;
    SimTime at;              // absolute start of the movement
    SimTime duration{-1};    // what the net prescribes; negative: the movement decides
    std::uint64_t seed = 0;  // of the actor and movement: variation without randomness at run time
    // How the figure would go on from here, where it is cut in a stride (movement.h); else null.
    MovementPtr onward = {};
};

// Writes the limbs in `limbs` of `from` into `to`.
void copy_limbs(LimbSet limbs, const Controls& from, Controls& to);

inline constexpr LimbSet kAllLimbs{0x3f};
inline constexpr LimbSet kBothArms{(1 << static_cast<int>(Limb::kLeftArm)) |
                                   (1 << static_cast<int>(Limb::kRightArm))};
inline constexpr LimbSet kLowerBody{(1 << static_cast<int>(Limb::kPelvis)) |
                                    (1 << static_cast<int>(Limb::kLeftLeg)) |
                                    (1 << static_cast<int>(Limb::kRightLeg))};
constexpr LimbSet without(LimbSet a, LimbSet b) { return {a.bits & ~b.bits}; }
constexpr LimbSet both(LimbSet a, LimbSet b) { return {a.bits | b.bits}; }
constexpr LimbSet shared(LimbSet a, LimbSet b) { return {a.bits & b.bits}; }
constexpr LimbSet limb_set(Limb limb) { return LimbSet{}.with(limb); }
constexpr Limb leg_of(Side side) { return side == Side::kLeft ? Limb::kLeftLeg : Limb::kRightLeg; }
constexpr Limb arm_of(Side side) { return side == Side::kLeft ? Limb::kLeftArm : Limb::kRightArm; }
constexpr Side other(Side side) { return side == Side::kLeft ? Side::kRight : Side::kLeft; }
constexpr int index_of(Side side) { return static_cast<int>(side); }

}  // namespace puppetri::motion
