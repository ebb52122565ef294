// SPDX-License-Identifier: MIT
// Tolani, Goswami and Badler's limb: hinge angle from the triangle, the ball joint's rotation from
// two frames, the end joint takes what is left of the goal.
#include "puppetri/motion/limb_ik.h"

#include "puppetri/math/rotation.h"

namespace puppetri::motion {

LimbResult solve_limb(const LimbIk& ik) {
    const Vec3 line = normalized(ik.goal.translation - ik.start, ik.axis);
    Vec3 zero = ik.swivel_zero - line * dot(ik.swivel_zero, line);
    if (length(zero) < 1e-6) {
        const Vec3 any = cross(line, ik.hinge);
        zero = length(any) > 1e-6 ? any : cross(line, ik.axis);
    }
    zero = normalized(zero, {0, 0, 1});
    const Vec3 pole = rotate(from_axis_angle(line, ik.swivel_rad), zero);
    const TwoBoneResult triangle = solve_two_bone({.start = ik.start,
                                                   .target = ik.goal.translation,
                                                   .pole = pole,
                                                   .upper_m = ik.upper_m,
                                                   .lower_m = ik.lower_m,
                                                   .soft = ik.soft});
    // The hinge turns the lower bone from the upper bone's direction towards the end; its axis is
    // orthogonal to both.
    const Vec3 upper = normalized(triangle.middle - ik.start, line);
    const Vec3 hinge = normalized(cross(line, pole) * -1.0, ik.hinge);
    const Vec3 third = cross(upper, hinge);
    const Vec3 rest_third = cross(ik.axis, ik.hinge);
    const Quat parent_from_frame = from_basis(upper, hinge, third);
    const Quat rest_from_frame = from_basis(ik.axis, ik.hinge, rest_third);
    LimbResult result;
    result.start_rotation = normalized(parent_from_frame * conjugate(rest_from_frame));
    result.middle_rotation = from_axis_angle(ik.hinge, triangle.bend_rad);
    result.end_rotation =
        normalized(conjugate(result.start_rotation * result.middle_rotation) * ik.goal.rotation);
    result.residual_m = triangle.residual_m;
    return result;
}

}  // namespace puppetri::motion
