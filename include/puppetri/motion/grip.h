// SPDX-License-Identifier: MIT
// How two hands hold a ball: palms flat on it, left and right and a little underneath, fingers
// ahead. One grip serves carrying, throwing and catching, so that a ball never slides in the hands:
// while it is held, both hands are one rigid body with it, and the stage reads its place off the
// hands.
//
// Ball space: origin in the centre, +Z ahead along the fingers, +Y out of the open side between the
// hands, +X to the left hand.
#pragma once
#include "puppetri/figure/mannequin.h"
#include "puppetri/motion/context.h"

namespace puppetri::motion {

// The hand on a ball of that radius; `gap_m` more lifts the palm off the ball along its normal.
Transform ball_from_hand(const figure::Figure& figure, Side side, double radius_m,
                         double gap_m = 0);

// The ball between two hands; all in one space. Exact for hands placed by ball_from_hand; otherwise
// the mean of what either hand would say, with the left hand's rotation.
Transform ball_between(const figure::Figure& figure, const Transform& left_hand,
                       const Transform& right_hand, double radius_m);

// Where the ball is that the arms of these controls hold, in chest space, and how it moves.
struct HeldBall {
    Transform chest_from_ball = {};
    Vec3 velocity_chest, angular_chest;
};
HeldBall held_ball(const MotionContext& context, double radius_m);

// Whether both hands are where a ball between them would have them.
bool hands_hold(const MotionContext& context, double radius_m);

// Lays both hands on the ball (with the gap) and opens the fingers; writes both arms.
void lay_hands(const figure::Figure& figure, const Transform& chest_from_ball, double radius_m,
               double gap_m, Controls& out);

// The pitch of a ball there (a turn about +X of chest space, positive lowers the fingers) with
// which hands and forearms are in line: what wrists like best.
double easy_pitch(const figure::Figure& figure, Vec3 ball_chest, double radius_m);

}  // namespace puppetri::motion
