// SPDX-License-Identifier: MIT
// Clamping to hinges and elliptic swing cones.
#include "puppetri/figure/limits.h"

#include "puppetri/base/elementary.h"
#include "puppetri/math/rotation.h"

namespace puppetri::figure {
namespace {

// Swing as rotation vector s = a side + b other lies inside when (a / A)^2 + (b / B)^2 <= 1;
// outside it is pulled straight back to the ellipse.
double swing_scale(const JointLimit& limit, Vec3 swing) {
    const Vec3 across = cross(limit.axis_joint, limit.side_joint);
    const double a = dot(swing, limit.side_joint) / limit.swing_side_rad;
    const double b = dot(swing, across) / limit.swing_other_rad;
    const double r = std::sqrt(a * a + b * b);
    return r > 1 ? 1 / r : 1;
}

// True only when the rotation is inside for certain, without any arc tangent: an angle is at most
// pi times the sine of its half. Almost all joints of almost all poses pass here.
bool surely_inside(const JointLimit& limit, Quat q) {
    if (q.w < 0) {
        q = {-q.x, -q.y, -q.z, -q.w};
    }
    const double along =
        q.x * limit.axis_joint.x + q.y * limit.axis_joint.y + q.z * limit.axis_joint.z;
    const double n2 = along * along + q.w * q.w, across2 = 1 - n2;
    const double twist = kPi * std::fabs(along);  // times 1 / n, below
    const double room = along < 0 ? -limit.lo_rad : limit.hi_rad;
    if (!(room > 0) || twist * twist > room * room * n2) {
        return false;
    }
    if (limit.kind == LimitKind::kHinge) {
        return across2 < 1e-12;
    }
    const double swing = std::fmin(limit.swing_side_rad, limit.swing_other_rad);
    return kPi * kPi * across2 < swing * swing;
}

}  // namespace

Quat clamp_to_limit(const JointLimit& limit, Quat parent_from_joint) {
    if (limit.kind == LimitKind::kFree) {
        return parent_from_joint;
    }
    const Quat relative = conjugate(limit.parent_from_centre) * parent_from_joint;
    if (surely_inside(limit, relative)) {
        return parent_from_joint;
    }
    const SwingTwist st = to_swing_twist(relative, limit.axis_joint);
    const double twist = clamp(st.twist_rad, limit.lo_rad, limit.hi_rad);
    if (limit.kind == LimitKind::kHinge) {
        return limit.parent_from_centre * from_axis_angle(limit.axis_joint, twist);
    }
    const Vec3 swing = to_rotation_vector(st.swing);
    const double scale = swing_scale(limit, swing);
    if (scale == 1 && twist == st.twist_rad) {
        return parent_from_joint;
    }
    return normalized(limit.parent_from_centre * from_rotation_vector(swing * scale) *
                      from_axis_angle(limit.axis_joint, twist));
}

double limit_excess_rad(const JointLimit& limit, Quat parent_from_joint) {
    return limit.kind == LimitKind::kFree
               ? 0
               : angle_between(parent_from_joint, clamp_to_limit(limit, parent_from_joint));
}

}  // namespace puppetri::figure
