// SPDX-License-Identifier: MIT
// Controls: what movements write. Not joint angles but the handles an animator would grab: the
// pelvis, the bend of the trunk, the gaze, each foot in the world, each hand before the chest.
// Inverse kinematics (solve_controls.h) turns a whole set into a Pose. Movements that drive
// different limbs meet here without knowing of each other; blending and inertialization happen here
// too, so that a planted foot stays planted whatever the trunk does.
#pragma once
#include <array>
#include <cstdint>

#include "puppetri/math/transform.h"

namespace puppetri::motion {

enum class Side : std::uint8_t { kLeft, kRight };

// What a movement can drive. `pelvis` belongs to the movement of the support leg (or of both legs);
// `body` is the trunk and the head. Names in the language: pelvis, body, left_leg, right_leg,
// left_arm, right_arm.
enum class Limb : std::uint8_t { kPelvis, kBody, kLeftLeg, kRightLeg, kLeftArm, kRightArm };
inline constexpr int kLimbCount = 6;

// Figures that are no humanoids have no controls; their limbs are named chains of joints, numbered
// from kLimbCount on.
inline constexpr int kMaxLimbs = 32;

// A set of limbs as bits, bit i for Limb i.
struct LimbSet {
    std::uint32_t bits = 0;
    constexpr bool has(Limb limb) const { return (bits >> static_cast<int>(limb)) & 1; }
    constexpr LimbSet with(Limb limb) const {
        return {bits | (std::uint32_t{1} << static_cast<int>(limb))};
    }
    constexpr bool operator==(const LimbSet&) const = default;
};

struct PelvisControl {
    Vec3 position_world;  // of the joint `hips`
    Quat rotation_world;  // identity in the rest pose of a figure that faces +Z
};

// Rotations relative to the rest pose. The trunk's is spread over spine, chest and upperChest, the
// head's over neck and head. Hands hang from the chest, so that bending carries them along.
struct BodyControl {
    Quat pelvis_from_chest;
    Quat chest_from_head;
    double breath = 0;  // 0 exhaled .. 1 inhaled: lifts chest and shoulders by a few millimetres
};

struct LegControl {
    Vec3 ankle_world;          // of the joint `leftFoot` / `rightFoot`
    Quat foot_rotation_world;  // identity: flat on the floor, toes to +Z
    double toe_bend_rad = 0;   // positive lifts the toes relative to the foot
    double swivel_rad =
        0;  // turns the knee out of the plane that the foot's heading gives; positive is outward
};

// The hand either hangs (given by the target) in chest space, or is fixed to a point of the world:
// `world_weight` 1 takes hand_world instead, values between blend.
struct ArmControl {
    Transform chest_from_hand;  // of the joint `leftHand` / `rightHand`; chest space is the joint
                                // upperChest's
    double swivel_rad =
        0;  // elbow about the line shoulder-wrist; 0 hangs down and back, positive is outward
    double relaxed = 1, spread = 0, grip = 0;  // weights of the hand poses, sum 1
    Transform world_from_hand;                 // used where world_weight > 0
    double world_weight = 0;
};

struct Controls {
    PelvisControl pelvis;
    BodyControl body;
    std::array<LegControl, 2> legs;  // by Side
    std::array<ArmControl, 2> arms;  // by Side
};

}  // namespace puppetri::motion
