// SPDX-License-Identifier: MIT
// Clamping to hinges and elliptic swing cones.
#include "puppetri/figure/limits.h"

#include <string>

#include "puppetri/base/elementary.h"
#include "puppetri/math/rotation.h"

namespace puppetri::figure {
namespace {

// A swing's quaternion has the vector part a side + b other; outside the ellipse that is pulled
// straight back to it, so that the bone is swung less far in the same direction.
Quat into_cone(const JointLimit& limit, Quat swing) {
    const Vec3 v{swing.x, swing.y, swing.z};
    const double a = dot(v, limit.side_joint) / puppetri::sin(limit.swing_side_rad / 2);
    const double b = dot(v, cross(limit.axis_joint, limit.side_joint)) /
                     puppetri::sin(limit.swing_other_rad / 2);
    const double r2 = a * a + b * b;
    if (r2 <= 1) {
        return swing;
    }
    const Vec3 inside = v * (1 / std::sqrt(r2));
    return {inside.x, inside.y, inside.z, std::sqrt(std::fmax(0, 1 - dot(inside, inside)))};
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
    if (!(limit.lo_rad <= 0 && limit.hi_rad >= 0 && room > 0) || twist * twist > room * room * n2) {
        return false;
    }
    if (limit.kind == LimitKind::kHinge) {
        return across2 < 1e-12;
    }
    const double swing = std::fmin(limit.swing_side_rad, limit.swing_other_rad);
    return kPi * kPi * across2 < swing * swing;
}

// The angle of the range that is nearest on the circle; itself, up to full turns, inside.
double into_range(double angle, double lo, double hi) {
    const double above = turn_between(lo, angle);  // in (-pi, pi]
    const double from_lo = above < 0 ? above + 2 * kPi : above;
    if (from_lo <= hi - lo) {
        return angle >= lo && angle <= hi ? angle : lo + from_lo;
    }
    return std::fabs(turn_between(hi, angle)) < std::fabs(above) ? hi : lo;
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
    const double twist = into_range(st.twist_rad, limit.lo_rad, limit.hi_rad);
    if (limit.kind == LimitKind::kHinge) {
        return limit.parent_from_centre * from_axis_angle(limit.axis_joint, twist);
    }
    const Quat swing = into_cone(limit, st.swing);
    if (swing == st.swing && twist == st.twist_rad) {
        return parent_from_joint;
    }
    return normalized(limit.parent_from_centre * swing * from_axis_angle(limit.axis_joint, twist));
}

double limit_excess_rad(const JointLimit& limit, Quat parent_from_joint) {
    return limit.kind == LimitKind::kFree
               ? 0
               : angle_between(parent_from_joint, clamp_to_limit(limit, parent_from_joint));
}

Status check(const JointLimit& limit, std::string_view element) {
    Diagnostics all;
    const auto defect = [&](const char* code, const char* message, const char* remedy) {
        all.push_back({Severity::kError, code, {}, std::string(element), message, remedy});
    };
    // Written so that a number that is none fails.
    const auto unit = [](Vec3 v) { return std::fabs(dot(v, v) - 1) < 1e-9; };
    const Quat c = limit.parent_from_centre;
    if (limit.kind == LimitKind::kFree) {
        return Ok{};
    }
    if (!unit(limit.axis_joint)) {
        defect("limit-axis", "the axis of a joint's limit has not the length 1",
               "give the axis as a direction of length 1");
    }
    if (!(std::fabs(c.x * c.x + c.y * c.y + c.z * c.z + c.w * c.w - 1) < 1e-9)) {
        defect("limit-centre", "the centre of a joint's limit is not a rotation",
               "give a quaternion x y z w of length 1");
    }
    const double range = limit.hi_rad - limit.lo_rad;
    if (range < 0) {
        defect("limit-order", "the least angle of a joint's limit is above its greatest",
               "exchange min and max");
    } else if (!(range <= 4 * kPi && std::fabs(limit.lo_rad) <= 2 * kPi &&
                 std::fabs(limit.hi_rad) <= 2 * kPi)) {
        defect("limit-range", "a joint's range is not a range of angles",
               "give min and max between -360 and 360 degrees");
    }
    if (limit.kind == LimitKind::kCone) {
        if (!unit(limit.side_joint) ||
            !(std::fabs(dot(limit.side_joint, limit.axis_joint)) < 1e-9)) {
            defect("limit-axis",
                   "the side of a joint's cone is not a direction across the cone's axis",
                   "give a direction of length 1 at a right angle to the axis");
        }
        for (const double swing : {limit.swing_side_rad, limit.swing_other_rad}) {
            if (!(swing > 0 && swing <= kPi + 1e-12)) {
                defect("limit-swing",
                       "the opening of a joint's cone is not above 0 and up to 180 degrees",
                       "give how far the bone swings from the middle of its range");
                break;
            }
        }
    }
    if (!all.empty()) {
        return Unexpected(std::move(all));
    }
    return Ok{};
}

}  // namespace puppetri::figure
