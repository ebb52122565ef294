// SPDX-License-Identifier: MIT
// How two hands hold a ball or a box: palms flat on it, left and right (a ball: and a little
// underneath), fingers ahead. One grip serves carrying, throwing and catching, so that nothing ever
// slides in the hands: while it is held, both hands are one rigid body with it, and the stage reads
// its place off the hands.
//
// Ball space: origin in the centre, +Z ahead along the fingers, +Y out of the open side between the
// hands, +X to the left hand.
#pragma once
#include "puppetri/figure/mannequin.h"
#include "puppetri/motion/context.h"

namespace puppetri::motion {

struct Grip {
    double half_m = 0.11;   // from the centre to either palm
    double ahead_m = 0.11;  // how far the thing reaches from there to the belly
    bool flat = false;      // two opposite faces of a box
    double yaw_rad = 0;     // flat: of the box in the world, while it lies; its faces are taken

    bool operator==(const Grip&) const = default;
};
constexpr Grip ball_grip(double radius_m) { return {radius_m, radius_m, false, 0}; }

// How a box is taken by one who faces there, seen from the box: by the two faces that are most to
// its left and right. The yaw is that of the hands, seen from the box.
Grip box_grip(Vec3 size_m, double heading_rad);

// Wider things than this are not taken between two palms.
inline constexpr double kWidestGrip_m = 0.6;

// The hand on a thing held so; `gap_m` more lifts the palm off it along its normal.
Transform ball_from_hand(const figure::Figure& figure, Side side, const Grip& grip,
                         double gap_m = 0);

// The ball between two hands; all in one space. Exact for hands placed by ball_from_hand; otherwise
// the mean of what either hand would say, with the left hand's rotation.
Transform ball_between(const figure::Figure& figure, const Transform& left_hand,
                       const Transform& right_hand, const Grip& grip);

// Where the ball is that the arms of these controls hold, in chest space, and how it moves.
struct HeldBall {
    Transform chest_from_ball = {};
    Vec3 velocity_chest, angular_chest;
};
HeldBall held_ball(const MotionContext& context, const Grip& grip);

// Whether both hands are where a ball between them would have them.
bool hands_hold(const MotionContext& context, const Grip& grip);

// Lays both hands on the ball (with the gap) and opens the fingers; writes both arms.
void lay_hands(const figure::Figure& figure, const Transform& chest_from_ball, const Grip& grip,
               double gap_m, Controls& out);

// The pitch of a ball there (a turn about +X of chest space, positive lowers the fingers) with
// which hands and forearms are in line: what wrists like best.
double easy_pitch(const figure::Figure& figure, Vec3 ball_chest, const Grip& grip);

}  // namespace puppetri::motion
