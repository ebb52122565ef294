// SPDX-License-Identifier: MIT
// Rotations as axis-angle, rotation vectors, headings, swing and twist.
#include "puppetri/math/rotation.h"

#include "puppetri/base/elementary.h"

namespace puppetri {

Quat from_axis_angle(Vec3 axis, double angle_rad) {
    const double s = puppetri::sin(angle_rad / 2);
    return {axis.x * s, axis.y * s, axis.z * s, puppetri::cos(angle_rad / 2)};
}
Quat about_x(double angle_rad) { return from_axis_angle({1, 0, 0}, angle_rad); }
Quat about_y(double angle_rad) { return from_axis_angle({0, 1, 0}, angle_rad); }
Quat about_z(double angle_rad) { return from_axis_angle({0, 0, 1}, angle_rad); }

Vec3 to_rotation_vector(Quat q) {
    if (q.w < 0) {
        q = {-q.x, -q.y, -q.z, -q.w};
    }
    const Vec3 v{q.x, q.y, q.z};
    const double s = length(v);
    // angle / sin(angle / 2) -> 2 / w (1 - s^2 / (3 w^2)) for small s; below 1e-8 the first term is
    // exact in doubles.
    const double factor = s < 1e-8 ? 2 / q.w : 2 * puppetri::atan2(s, q.w) / s;
    return v * factor;
}

Quat from_rotation_vector(Vec3 v) {
    const double angle = length(v);
    if (angle < 1e-12) {
        return normalized(Quat{v.x / 2, v.y / 2, v.z / 2, 1});
    }
    return from_axis_angle(v * (1 / angle), angle);
}

Quat normalized(Quat q) {
    const double n = std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
    const double k = n > 0 ? 1 / n : 0;
    return n > 0 ? Quat{q.x * k, q.y * k, q.z * k, q.w * k} : Quat{};
}

double angle_of(Quat q) { return 2 * puppetri::atan2(length({q.x, q.y, q.z}), std::fabs(q.w)); }

double angle_between(Quat a, Quat b) { return angle_of(conjugate(a) * b); }

Quat slerp(Quat a, Quat b, double ratio) {
    return normalized(a * from_rotation_vector(to_rotation_vector(conjugate(a) * b) * ratio));
}

Quat shortest_arc(Vec3 a, Vec3 b, Vec3 axis_if_opposite) {
    // Half the way: q = (cross(a, b), 1 + dot(a, b)), normalized; it vanishes for opposite vectors.
    const double w = 1 + dot(a, b);
    if (w < 1e-14) {
        const Vec3 axis = axis_if_opposite - a * dot(a, axis_if_opposite);
        const Vec3 any = std::fabs(a.x) < 0.9 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
        const Vec3 u = length(axis) > 1e-9 ? normalized(axis) : normalized(cross(a, any));
        return {u.x, u.y, u.z, 0};
    }
    const Vec3 c = cross(a, b);
    return normalized(Quat{c.x, c.y, c.z, w});
}

Quat from_basis(Vec3 x, Vec3 y, Vec3 z) {
    // Shepperd's method: divide by the largest of the four components.
    const double trace = x.x + y.y + z.z;
    Quat q;
    if (trace > 0) {
        const double s = 2 * std::sqrt(1 + trace);
        q = {(y.z - z.y) / s, (z.x - x.z) / s, (x.y - y.x) / s, s / 4};
    } else if (x.x >= y.y && x.x >= z.z) {
        const double s = 2 * std::sqrt(1 + x.x - y.y - z.z);
        q = {s / 4, (y.x + x.y) / s, (z.x + x.z) / s, (y.z - z.y) / s};
    } else if (y.y >= z.z) {
        const double s = 2 * std::sqrt(1 + y.y - x.x - z.z);
        q = {(y.x + x.y) / s, s / 4, (z.y + y.z) / s, (z.x - x.z) / s};
    } else {
        const double s = 2 * std::sqrt(1 + z.z - x.x - y.y);
        q = {(z.x + x.z) / s, (z.y + y.z) / s, s / 4, (x.y - y.x) / s};
    }
    return normalized(q);
}

SwingTwist to_swing_twist(Quat q, Vec3 axis) {
    if (q.w < 0) {
        q = {-q.x, -q.y, -q.z, -q.w};
    }
    const double along = q.x * axis.x + q.y * axis.y + q.z * axis.z;
    if (along * along + q.w * q.w < 1e-18) {
        return {q, 0};
    }
    // The twist's quaternion is the part of q along the axis; no angle is needed to take it out.
    const double k = 1 / std::sqrt(along * along + q.w * q.w);
    const double sine = along * k, cosine = q.w * k;
    const Quat untwist{-axis.x * sine, -axis.y * sine, -axis.z * sine, cosine};
    return {normalized(q * untwist), 2 * puppetri::atan2(along, q.w)};
}

double heading_of(Vec3 direction) { return puppetri::atan2(direction.x, direction.z); }
double heading_of(Quat q) { return heading_of(rotate(q, {0, 0, 1})); }

double turn_between(double a_rad, double b_rad) {
    double d = b_rad - a_rad;
    d -= 2 * kPi * std::floor(d / (2 * kPi));  // [0, 2 pi)
    return d > kPi ? d - 2 * kPi : d;
}

Vec3 angular_velocity(Quat a, Quat b, double dt_s) {
    return to_rotation_vector(b * conjugate(a)) * (1 / dt_s);
}

}  // namespace puppetri
