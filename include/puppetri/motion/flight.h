// SPDX-License-Identifier: MIT
// The flight of a ball: a parabola under gravity, without drag, from where it was let go to where
// it shall be caught. Nobody there to catch it: it goes on, bounces, and comes to rest on the floor
// at height 0.
#pragma once
#include <optional>

#include "puppetri/base/time.h"
#include "puppetri/math/transform.h"

namespace puppetri::motion {

inline constexpr double kGravity_m_s2 = 9.80665;  // standard gravity, ISO 80000-3

struct Flight {
    SimTime start = {};        // absolute
    SimTime duration = {};     // until it reaches its target
    Vec3 start_world = {};     // of the centre
    Vec3 velocity_world = {};  // at the start
    Quat start_rotation_world = {};
    Vec3 spin_world = {};  // angular velocity, constant in the air
    double radius_m = 0;

    Vec3 position(SimTime at) const;  // from the start on, also after the target
    Quat rotation(SimTime at) const;
    Vec3 velocity(SimTime at) const;
    // When it lies still: after the last bounce.
    SimTime rest() const;
};

// How long a ball flies over the horizontal distance d when nobody says: sqrt(2 d / g), which is a
// throw at 45 degrees between equal heights, v = sqrt(g d); a whole millisecond, rounded up. At
// least 1 ms.
SimTime flight_duration(Vec3 from_world, Vec3 to_world);

// The velocity that takes a ball there in that time. Needs duration > 0.
Vec3 launch_velocity(Vec3 from_world, Vec3 to_world, SimTime duration);

}  // namespace puppetri::motion
