// SPDX-License-Identifier: MIT
#include "trunk.h"

#include "puppetri/math/rotation.h"

namespace puppetri::motion {

namespace {
// A full breath bends the upper chest back by a degree (the head keeps its attitude) and lifts the
// shoulders by 1.5.
constexpr double kBreathChest_rad = 0.018, kBreathShoulder_rad = 0.026;
}  // namespace

Quat breath_rotation(double breath) { return about_x(-kBreathChest_rad * breath); }

TrunkRotations trunk_rotations(const BodyControl& body) {
    const Vec3 bend = to_rotation_vector(body.pelvis_from_chest);
    const Quat third = from_rotation_vector(bend * (1.0 / 3));
    const Quat half = from_rotation_vector(to_rotation_vector(body.chest_from_head) * 0.5);
    const Quat breath = breath_rotation(body.breath);
    return {third, third, third * breath, conjugate(breath) * half, half};
}

Transform pelvis_from_upper_chest(const figure::Figure& figure, const TrunkRotations& trunk) {
    const auto& joints = figure.skeleton.joints;
    auto at = [&](figure::JointIndex j, Quat q) {
        return Transform{q, joints[j.value].parent_from_joint_rest.translation};
    };
    return at(figure.spine, trunk.spine) * at(figure.chest, trunk.chest) *
           at(figure.upper_chest, trunk.upper_chest);
}

Quat clavicle_rotation(const figure::Figure& figure, int side, Vec3 hand_chest, double breath) {
    const figure::Arm& arm = figure.arms[side];
    const double s = side == figure::kLeft ? 1 : -1;
    const Vec3 v = (hand_chest - (arm.clavicle_chest + arm.shoulder_clavicle)) *
                   (1 / (arm.upper_m + arm.fore_m));
    const double above = std::fmax(0, v.y + 0.4);
    const double raise = std::fmin(0.30 * above * above, 0.5) + kBreathShoulder_rad * breath;
    const double ahead = 0.22 * clamp(v.z, -0.5, 1) * std::fmin(1, dot(v, v));
    return about_y(-s * ahead) * about_z(s * raise);
}

}  // namespace puppetri::motion
