// SPDX-License-Identifier: MIT
// Rotations in the forms that animation needs: axis and angle, rotation vectors (whose differences
// are angular velocities), headings about +Y, and the split into swing and twist. All in radians;
// all quaternions unit.
#pragma once
#include <utility>

#include "puppetri/math/transform.h"

namespace puppetri {

inline constexpr double kPi = 3.14159265358979323846;
constexpr double radians(double degrees) { return degrees * (kPi / 180); }

// Needs a unit axis.
Quat from_axis_angle(Vec3 axis, double angle_rad);
Quat about_x(double angle_rad);
Quat about_y(double angle_rad);
Quat about_z(double angle_rad);

// The rotation vector (axis times angle) of q, with angle in [0, pi], and back.
Vec3 to_rotation_vector(Quat q);
Quat from_rotation_vector(Vec3 v);

Quat normalized(Quat q);

// The rotation by at most pi that q and -q stand for; angle of the rotation between a and b.
double angle_of(Quat q);
double angle_between(Quat a, Quat b);

// Along the shorter arc; ratio in [0, 1], values outside go on along it.
Quat slerp(Quat a, Quat b, double ratio);

// The smallest rotation that takes unit vector a to unit vector b. Opposite vectors turn about
// `axis_if_opposite`.
Quat shortest_arc(Vec3 a, Vec3 b, Vec3 axis_if_opposite);

// The rotation whose columns are the images of +X, +Y, +Z; needs a right-handed orthonormal basis.
Quat from_basis(Vec3 x, Vec3 y, Vec3 z);

// q = swing * twist, twist about the unit `axis` by an angle in (-pi, pi], swing about an axis
// orthogonal to it. When q turns `axis` by exactly pi the twist is not defined; it is then 0.
struct SwingTwist {
    Quat swing;
    double twist_rad = 0;
};
SwingTwist to_swing_twist(Quat q, Vec3 axis);

// Heading: the turn about +Y that takes +Z to the horizontal direction of q's +Z (0 faces +Z, pi/2
// faces +X).
double heading_of(Quat q);
double heading_of(Vec3 direction);
// Difference b - a of angles, in (-pi, pi].
double turn_between(double a_rad, double b_rad);

// Angular velocity, in the frame that both rotations map into, that takes a to b in dt_s > 0
// seconds.
Vec3 angular_velocity(Quat a, Quat b, double dt_s);

constexpr double clamp(double x, double lo, double hi) { return x < lo ? lo : (x > hi ? hi : x); }
constexpr double lerp(double a, double b, double ratio) { return a + (b - a) * ratio; }
constexpr Vec3 lerp(Vec3 a, Vec3 b, double ratio) { return a + (b - a) * ratio; }

}  // namespace puppetri
