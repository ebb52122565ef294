// SPDX-License-Identifier: MIT
// A hand, or two hands with a ball, that swings about the shoulder to where it shall be. It moves
// on a cylinder about the shoulder's lateral axis: an angle in the plane of the swing, a distance
// from the shoulder, a distance to the side. A fast hand so swings on along its arc, as after a
// throw, instead of running into the end of the arm.
#pragma once
#include "puppetri/math/quintic.h"
#include "puppetri/motion/inertialize.h"

namespace puppetri::motion {

// Place in the shoulder's cylinder, chest space: angle 0 hangs down, positive forward.
struct Cylinder {
    double angle_rad = 0, reach_m = 0, side_m = 0;
};
Cylinder to_cylinder(Vec3 from_shoulder);
Vec3 from_cylinder(const Cylinder& c);

struct SwingSpec {
    Vec3 shoulder;  // all in chest space
    Transform now;
    Vec3 velocity, angular;
    Transform target;       // at rest there in the end; what swings turns with the arm
    double longest_m = 0;   // no farther from the shoulder than this
    double duration_s = 0;  // > 0
};

class SwingingArm {
 public:
    SwingingArm() = default;
    explicit SwingingArm(const SwingSpec& spec);
    Transform at(double t_s) const;

 private:
    Vec3 shoulder_;
    Curve1 angle_, reach_, side_;
    Quat target_from_arm_;
    InertialOffset3 lie_, wrist_;
};

}  // namespace puppetri::motion
