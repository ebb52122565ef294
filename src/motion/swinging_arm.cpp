// SPDX-License-Identifier: MIT
#include "swinging_arm.h"

#include "puppetri/base/elementary.h"
#include "puppetri/math/rotation.h"

namespace puppetri::motion {
namespace {

constexpr double kWrist_s = 0.2, kStraight_s = 0.25;

Curve1 settle(double x, double v, double rest, double duration_s) {
    return Curve1({{0, {x, v, 0}}, {duration_s, {rest, 0, 0}}});
}

}  // namespace

Cylinder to_cylinder(Vec3 from_shoulder) {
    return {atan2(from_shoulder.z, -from_shoulder.y),
            std::sqrt(from_shoulder.y * from_shoulder.y + from_shoulder.z * from_shoulder.z),
            from_shoulder.x};
}

Vec3 from_cylinder(const Cylinder& c) {
    return {c.side_m, -c.reach_m * cos(c.angle_rad), c.reach_m * sin(c.angle_rad)};
}

SwingingArm::SwingingArm(const SwingSpec& spec) : shoulder_(spec.shoulder) {
    constexpr double h = 1e-4;
    const Vec3 p = spec.now.translation - spec.shoulder;
    const Cylinder a = to_cylinder(p), b = to_cylinder(p + spec.velocity * h),
                   c = to_cylinder(spec.target.translation - spec.shoulder);
    const double angle_rate = (b.angle_rad - a.angle_rad) / h,
                 reach_rate = (b.reach_m - a.reach_m) / h;
    angle_ = settle(a.angle_rad, angle_rate, c.angle_rad, spec.duration_s);
    side_ = settle(a.side_m, (b.side_m - a.side_m) / h, c.side_m, spec.duration_s);
    // Along itself an arm stops soon, and stays as long as it is until the swing is over.
    const double soon_s = std::fmin(kStraight_s, 0.4 * spec.duration_s);
    const double soon =
        clamp(a.reach_m + 0.3 * soon_s * reach_rate, 0.3 * spec.longest_m, 0.97 * spec.longest_m);
    reach_ = Curve1({{0, {a.reach_m, reach_rate, 0}},
                     {soon_s, {soon, 0, 0}},
                     {spec.duration_s, {c.reach_m, 0, 0}}});
    // How the hand lies on the arm fades with the swing; how fast it turns against the arm fades at
    // once, since wrists do not go far.
    target_from_arm_ = about_x(c.angle_rad) * spec.target.rotation;
    const Quat arm_from_chest = about_x(a.angle_rad);
    lie_ = InertialOffset3(
        to_rotation_vector(arm_from_chest * spec.now.rotation * conjugate(target_from_arm_)), {},
        spec.duration_s);
    wrist_ = InertialOffset3({}, rotate(arm_from_chest, spec.angular - Vec3{-angle_rate, 0, 0}),
                             std::fmin(kWrist_s, spec.duration_s));
}

Transform SwingingArm::at(double t_s) const {
    const double angle = angle_.at(t_s).position;
    const Quat rotation = about_x(-angle) * from_rotation_vector(wrist_.at(t_s)) *
                          from_rotation_vector(lie_.at(t_s)) * target_from_arm_;
    return {normalized(rotation),
            shoulder_ + from_cylinder({angle, reach_.at(t_s).position, side_.at(t_s).position})};
}

}  // namespace puppetri::motion
