// SPDX-License-Identifier: MIT
// How far joints turn. A spherical joint is limited by an elliptic cone for where the bone points
// (swing) and a range for its rotation about itself (twist); a hinge by a range about one axis.
// Limits are relative to a centre pose, since the middle of a shoulder's range is not the T-pose.
//
// The cone is an ellipse in the vector part of the swing's quaternion: a swing by the angle b about
// cos(f) side + sin(f) other is inside when (sin(b/2) cos(f) / sin(A/2))^2 + (sin(b/2) sin(f) /
// sin(B/2))^2 <= 1. That is within a tenth of a degree of an ellipse in the angles, and unlike it a
// polynomial in the rotation: inverse kinematics solves it exactly.
#pragma once
#include <string_view>

#include "puppetri/base/diagnostic.h"
#include "puppetri/figure/skeleton.h"

namespace puppetri::figure {

enum class LimitKind : std::uint8_t { kFree, kHinge, kCone };

struct JointLimit {
    LimitKind kind = LimitKind::kFree;
    Vec3 axis_joint{0, 1, 0};  // hinge axis, or twist axis (along the bone) of a cone; unit
    Vec3 side_joint{
        1, 0,
        0};  // cone: unit, orthogonal to the axis; swings about it have the range swing_side_rad
    Quat
        parent_from_centre{};  // the middle of the cone's swing, as a value of the joint's rotation
    double lo_rad = 0, hi_rad = 0;  // hinge range or twist range
    double swing_side_rad = 0;      // half angle of swings about side_joint, in (0, pi]
    double swing_other_rad = 0;     // half angle of swings about axis x side, in (0, pi]
};

// Fails   "limit-order" where min is above max, "limit-axis" where an axis is not unit or the side
//         is not orthogonal to it, "limit-swing" where a swing is not in (0, pi], "limit-range"
//         where a range is wider than a full turn or a number is not finite, "limit-centre" where
//         the centre is not a rotation. `element` names the joint.
Status check(const JointLimit& limit, std::string_view element);

// The nearest rotation within the limit (nearest in swing and twist separately). Inside, the
// rotation itself.
Quat clamp_to_limit(const JointLimit& limit, Quat parent_from_joint);

// By how much the rotation is outside its limit; 0 inside.
double limit_excess_rad(const JointLimit& limit, Quat parent_from_joint);

}  // namespace puppetri::figure
