// SPDX-License-Identifier: MIT
// Humanoids of any proportions. The mannequin is the one whose measures follow from its height; the
// measures of characters are taken from their skeletons and skins. All have the same joints, so
// that every movement is generated for every humanoid. Bones that a character lacks have no length
// here, so that turning them moves nothing.
#pragma once
#include <array>

#include "puppetri/figure/mannequin.h"

namespace puppetri::figure {

// Of the T-pose: facing +Z, left arm along +X, soles at y = 0, hips above the origin. Offsets are
// from the parent joint, in the model's axes, metres.
struct HumanoidMeasures {
    struct Arm {
        Vec3 clavicle;  // from upperChest
        Vec3 shoulder;  // from the clavicle
        double upper_m = 0, fore_m = 0;
        double hand_m = 0;                            // wrist to fingertips
        Transform hand_from_palm;                     // see figure::Arm
        std::array<Vec3, kFingerJointCount> fingers;  // offsets from the joint before
        std::array<Vec3, 5> finger_tips;              // from the last joint of each finger
    };
    struct Leg {
        Vec3 hip;  // from hips
        double thigh_m = 0, shank_m = 0;
        Vec3 toes;                                // from the ankle
        Vec3 heel_foot, ball_foot, toe_tip_foot;  // contact points, from the ankle
    };
    double height_m = 0;
    double hips_height_m = 0;
    Vec3 spine, chest, upper_chest, neck, head;
    Vec3 head_top;  // from the joint head
    Vec3 eyes_head;
    double ankle_height_m = 0;
    double leg_m = 0;  // thigh and shank, of the shorter leg
    double stance_half_width_m = 0;
    double reach_height_m = 0;  // see figure::Figure
    double breast_height_m = 0;
    std::array<Arm, 2> arms;  // left, right
    std::array<Leg, 2> legs;
};

// The measures of the mannequin of that height. Needs 0.5 <= height_m <= 3.
HumanoidMeasures mannequin_measures(double height_m);

// Needs positive lengths of thigh, shank, upper arm and forearm; finite numbers.
Figure make_humanoid(const HumanoidMeasures& measures);

}  // namespace puppetri::figure
