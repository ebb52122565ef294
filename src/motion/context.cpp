// SPDX-License-Identifier: MIT
// Rates between two sets of controls.
#include "puppetri/motion/context.h"

#include "puppetri/base/require.h"
#include "puppetri/math/rotation.h"

namespace puppetri::motion {

ControlsRate rate_between(const Controls& a, const Controls& b, double dt_s) {
    PUP_REQUIRE(dt_s > 0);
    const double f = 1 / dt_s;
    auto linear = [f](Vec3 from, Vec3 to) { return (to - from) * f; };
    ControlsRate r;
    r.pelvis_velocity_world = linear(a.pelvis.position_world, b.pelvis.position_world);
    r.pelvis_angular_world =
        angular_velocity(a.pelvis.rotation_world, b.pelvis.rotation_world, dt_s);
    r.chest_angular_pelvis =
        angular_velocity(a.body.pelvis_from_chest, b.body.pelvis_from_chest, dt_s);
    r.head_angular_chest = angular_velocity(a.body.chest_from_head, b.body.chest_from_head, dt_s);
    r.breath_per_s = (b.body.breath - a.body.breath) * f;
    for (int i = 0; i < 2; ++i) {
        const LegControl &p = a.legs[i], &q = b.legs[i];
        r.legs[i] = {linear(p.ankle_world, q.ankle_world),
                     angular_velocity(p.foot_rotation_world, q.foot_rotation_world, dt_s),
                     (q.toe_bend_rad - p.toe_bend_rad) * f,
                     turn_between(p.swivel_rad, q.swivel_rad) * f};
        const ArmControl &u = a.arms[i], &v = b.arms[i];
        r.arms[i] = {linear(u.chest_from_hand.translation, v.chest_from_hand.translation),
                     angular_velocity(u.chest_from_hand.rotation, v.chest_from_hand.rotation, dt_s),
                     linear(u.world_from_hand.translation, v.world_from_hand.translation),
                     angular_velocity(u.world_from_hand.rotation, v.world_from_hand.rotation, dt_s),
                     turn_between(u.swivel_rad, v.swivel_rad) * f,
                     (v.relaxed - u.relaxed) * f,
                     (v.spread - u.spread) * f,
                     (v.grip - u.grip) * f,
                     (v.world_weight - u.world_weight) * f};
    }
    return r;
}

void copy_limbs(LimbSet limbs, const Controls& from, Controls& to) {
    if (limbs.has(Limb::kPelvis)) {
        to.pelvis = from.pelvis;
    }
    if (limbs.has(Limb::kBody)) {
        to.body = from.body;
    }
    for (const Side side : {Side::kLeft, Side::kRight}) {
        const int i = index_of(side);
        if (limbs.has(leg_of(side))) {
            to.legs[i] = from.legs[i];
        }
        if (limbs.has(arm_of(side))) {
            to.arms[i] = from.arms[i];
        }
    }
}

}  // namespace puppetri::motion
