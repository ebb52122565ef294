// SPDX-License-Identifier: MIT
// The law of cosines, with an eased reach.
#include "puppetri/motion/two_bone_ik.h"

#include "puppetri/base/elementary.h"
#include "puppetri/base/require.h"
#include "puppetri/math/rotation.h"

namespace puppetri::motion {

double eased_reach_m(double wanted_m, double full_m, double soft) {
    const double from = soft * full_m, rest = full_m - from;
    if (wanted_m <= from) {
        return wanted_m;
    }
    return rest > 0 ? from + rest * (1 - puppetri::exp(-(wanted_m - from) / rest)) : full_m;
}

TwoBoneResult solve_two_bone(const TwoBoneIk& ik) {
    const double u = ik.upper_m, l = ik.lower_m;
    PUP_REQUIRE(u > 1e-6 && l > 1e-6 && ik.soft > 0 && ik.soft <= 1);
    const Vec3 to_target = ik.target - ik.start;
    const double wanted = length(to_target);
    const Vec3 along = normalized(to_target, {0, -1, 0});
    const double d =
        std::fmax(eased_reach_m(wanted, u + l, ik.soft), std::fabs(u - l) * (1 + 1e-9));
    Vec3 across = ik.pole - along * dot(ik.pole, along);
    if (length(across) < 1e-9) {
        const Vec3 any = std::fabs(along.z) < 0.9 ? Vec3{0, 0, 1} : Vec3{1, 0, 0};
        across = any - along * dot(any, along);
    }
    across = normalized(across);
    // Foot of the middle joint's height on the line start-end, and that height.
    const double x = d > 0 ? (d * d + u * u - l * l) / (2 * d) : 0;
    const double y = std::sqrt(std::fmax(0, u * u - x * x));
    const double cos_inner = clamp((u * u + l * l - d * d) / (2 * u * l), -1, 1);
    TwoBoneResult result;
    result.middle = ik.start + along * x + across * y;
    result.end = ik.start + along * d;
    result.bend_rad = kPi - puppetri::acos(cos_inner);
    result.residual_m = std::fabs(wanted - d);
    return result;
}

}  // namespace puppetri::motion
