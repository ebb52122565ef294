// SPDX-License-Identifier: MIT
// The mannequin: a humanoid scaled by its height alone. Segment lengths are fractions of the height
// after Drillis and Contini (1966) as printed in Winter, "Biomechanics and Motor Control of Human
// Movement" (4th ed. 2009), figure 4.1; finger segments after Buchholz, Armstrong and Goldstein
// (1992). Joint ranges are those of the American Academy of Orthopaedic Surgeons (1965), rounded
// outward to whole 5 degrees.
//
// At rest it stands in a T-pose: facing +Z, +Y up, its left arm along +X, soles on the floor, every
// joint's rotation the identity, so that joint axes are the model's axes.
#pragma once
#include <array>
#include <span>
#include <vector>

#include "puppetri/figure/dof.h"
#include "puppetri/figure/limits.h"
#include "puppetri/figure/skeleton.h"

namespace puppetri::figure {

// Arrays by side have the left at 0 and the right at 1 (the order of motion::Side).
inline constexpr int kLeft = 0, kRight = 1;

struct Leg {
    JointIndex hip, knee, ankle, toes;  // leftUpperLeg, leftLowerLeg, leftFoot, leftToes
    double thigh_m = 0, shank_m = 0;
    Vec3 hip_pelvis;  // of the hip joint in the space of `hips`
    Vec3 toes_foot;   // of the joint leftToes in the space of leftFoot
    // Contact points of the sole. The ball lies under the joint leftToes: when the heel rises the
    // toes stay flat and the foot turns about that joint.
    Vec3 heel_foot, ball_foot, toe_tip_foot;  // foot space, toes straight
    Vec3 ball_toes, toe_tip_toes;             // toes space
};

inline constexpr int kFingerJointCount =
    15;  // thumb, index, middle, ring, little; three joints each from the palm out

struct Arm {
    JointIndex clavicle, shoulder, shoulder_twist, elbow, elbow_twist,
        hand;  // leftShoulder, leftUpperArm, ...
    std::array<JointIndex, kFingerJointCount> fingers;
    double upper_m = 0, fore_m = 0;
    Vec3 clavicle_chest;     // in the space of upperChest
    Vec3 shoulder_clavicle;  // in the space of the clavicle
    // The palm: origin on the skin at the middle of the palm; +Y points out of the palm (at rest:
    // down, the palms face the floor), +Z forward across the fingers (to the thumb).
    Transform hand_from_palm;
};

// Rotations of the finger joints of one hand in three poses that are blended by weights.
struct HandPoses {
    std::array<Quat, kFingerJointCount> relaxed, spread, grip;
};

// What movements act on. A creature (figure/character.h) has a skeleton, limits and `root`, a
// height and nothing else of this: it has no controls (motion/controls.h), but its pelvis control
// places the root.
struct Figure {
    bool humanoid() const { return hips.valid(); }

    Skeleton skeleton;
    JointIndex root, hips, spine, chest, upper_chest, neck, head;
    std::array<Leg, 2> legs;
    std::array<Arm, 2> arms;
    std::array<HandPoses, 2> hands;
    std::vector<JointLimit> limits;  // one per joint
    DofSet dofs;                     // by which movements pose it
    Vec3 eyes_head;                  // the point between the eyes, in the space of `head`
    double hips_height_m = 0;        // of the joint `hips` in the rest pose
    double ankle_height_m = 0;       // of the ankles above the soles in the rest pose
    double leg_m = 0;                // thigh + shank
    double stance_half_width_m = 0;  // of the ankles from the midline when standing and walking
    double height_m = 0;
    // How tall a mannequin with arms of this length is; what hands do in parts of the height is in
    // parts of this. Of the mannequin its height.
    double reach_height_m = 0;
    double breast_height_m = 0;  // of where a ball is caught, in the rest pose
};

// Needs 0.5 <= height_m <= 3 (aborts otherwise: the language checks it before).
Figure make_mannequin(double height_m);

// The rest pose with the arms lowered by 45 degrees.
Pose a_pose(const Figure& figure);

}  // namespace puppetri::figure
