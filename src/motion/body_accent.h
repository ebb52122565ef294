// SPDX-License-Identifier: MIT
// What throwing, waiting and catching add to a standing body: bent knees, weight forward, a bent
// trunk. Added to what another movement writes for pelvis and trunk; feet stay where that movement
// has them.
#pragma once
#include "puppetri/figure/mannequin.h"
#include "puppetri/math/quintic.h"
#include "puppetri/math/rotation.h"
#include "puppetri/motion/controls.h"

namespace puppetri::motion {

struct BodyAccent {
    Vec3 ahead_world{0, 0, 1};  // horizontal, unit
    Curve1 lift_m;              // of the pelvis; negative bends the knees
    Curve1 ahead_m;             // of the pelvis
    Curve1 pitch_rad;           // of the pelvis about the axis to the left; positive bows
    Curve1 twist_rad;  // of the trunk about the spine; positive turns the chest to the left
    Curve1 lean_rad;   // of the trunk against the pelvis; positive bends forward

    void apply(double t_s, Controls& out) const {
        const Vec3 left = cross(Vec3{0, 1, 0}, ahead_world);
        out.pelvis.position_world = out.pelvis.position_world +
                                    ahead_world * ahead_m.at(t_s).position +
                                    Vec3{0, lift_m.at(t_s).position, 0};
        out.pelvis.rotation_world = normalized(from_axis_angle(left, pitch_rad.at(t_s).position) *
                                               out.pelvis.rotation_world);
        const double lean = lean_rad.at(t_s).position;
        out.body.pelvis_from_chest = normalized(about_y(twist_rad.at(t_s).position) *
                                                about_x(lean) * out.body.pelvis_from_chest);
        // The head keeps looking ahead.
        out.body.chest_from_head = normalized(about_x(-0.8 * (lean + pitch_rad.at(t_s).position)) *
                                              out.body.chest_from_head);
    }
};

// In parts of what knees bend: the height of a mannequin with legs of this length, where these are
// short for the figure. In parts of the whole height its ankles would come to their limits.
inline double crouching_height_m(const figure::Figure& figure) {
    constexpr double kLegOfMannequin = 0.4909;  // of the height, a hair less than it is
    return std::fmin(figure.height_m, figure.leg_m / kLegOfMannequin);
}

// A curve through rests: (time, value) with no speed at each.
inline Curve1 through_rests(std::initializer_list<Waypoint1> points) {
    std::vector<Key1> keys;
    for (const Waypoint1& p : points) {
        keys.push_back({p.t_s, {p.position, 0, 0}});
    }
    return Curve1(std::move(keys));
}

}  // namespace puppetri::motion
