// SPDX-License-Identifier: MIT
#include "puppetri/motion/gaze.h"

#include "puppetri/base/elementary.h"
#include "puppetri/math/rotation.h"
#include "puppetri/motion/pelvis_placement.h"
#include "trunk.h"

namespace puppetri::motion {

Transform world_from_chest(const figure::Figure& figure, const Controls& controls) {
    return Transform{controls.pelvis.rotation_world, pelvis_in_reach(figure, controls)} *
           pelvis_from_upper_chest(figure, trunk_rotations(controls.body));
}

Transform world_from_hand(const figure::Figure& figure, const Controls& controls, Side side) {
    const ArmControl& arm = controls.arms[index_of(side)];
    const Transform hanging = world_from_chest(figure, controls) * arm.chest_from_hand;
    const double w = clamp(arm.world_weight, 0, 1);
    return w > 0 ? Transform{slerp(hanging.rotation, arm.world_from_hand.rotation, w),
                             lerp(hanging.translation, arm.world_from_hand.translation, w)}
                 : hanging;
}

Transform world_from_palm(const figure::Figure& figure, const Controls& controls, Side side) {
    return world_from_hand(figure, controls, side) * figure.arms[index_of(side)].hand_from_palm;
}

Vec3 shoulder_chest(const figure::Figure& figure, Side side) {
    const figure::Arm& arm = figure.arms[index_of(side)];
    return arm.clavicle_chest + arm.shoulder_clavicle;
}

Quat gaze_at(const figure::Figure& figure, const Controls& controls, Vec3 target_world) {
    const Transform chest = world_from_chest(figure, controls);
    const auto& joints = figure.skeleton.joints;
    const Vec3 eyes_chest = joints[figure.neck.value].parent_from_joint_rest.translation +
                            joints[figure.head.value].parent_from_joint_rest.translation +
                            figure.eyes_head;
    const Vec3 to_target = inverse(chest) * target_world - eyes_chest;
    const double level = std::sqrt(to_target.x * to_target.x + to_target.z * to_target.z);
    const double yaw = heading_of(to_target), pitch = puppetri::atan2(to_target.y, level);
    // Behind the back the yaw would flip between the shoulders: from 110 degrees on it fades to
    // straight ahead.
    constexpr double kMost = radians(70);
    const double beyond = clamp((std::fabs(yaw) - radians(110)) / radians(70), 0, 1);
    const double fade = 1 - beyond * beyond * (3 - 2 * beyond);
    return about_y(clamp(yaw, -kMost, kMost) * fade) *
           about_x(-clamp(pitch, -radians(40), radians(40)) * fade);
}

}  // namespace puppetri::motion
