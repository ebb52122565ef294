// SPDX-License-Identifier: MIT
// Vectors, unit quaternions (stored x y z w) and rigid transforms in double precision.
// Right-handed, +Y up, metres, radians. Transforms read right to left and neighbours cancel:
// world_from_joint = world_from_model * model_from_joint.
#pragma once
#include <cmath>

namespace puppetri {

struct Vec3 {
    double x = 0, y = 0, z = 0;
    bool operator==(const Vec3&) const = default;
};
constexpr Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
constexpr Vec3 operator-(Vec3 a, Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
constexpr Vec3 operator-(Vec3 a) { return {-a.x, -a.y, -a.z}; }
constexpr Vec3 operator*(Vec3 a, double s) { return {a.x * s, a.y * s, a.z * s}; }
constexpr Vec3 operator*(double s, Vec3 a) { return a * s; }
constexpr double dot(Vec3 a, Vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
constexpr Vec3 cross(Vec3 a, Vec3 b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double length(Vec3 a) { return std::sqrt(dot(a, a)); }
// A zero vector gives `otherwise`.
inline Vec3 normalized(Vec3 a, Vec3 otherwise = {1, 0, 0}) {
    const double n = length(a);
    return n > 0 ? a * (1 / n) : otherwise;
}

// A rotation; x y z w with w = cos(angle / 2). q and -q are the same rotation.
struct Quat {
    double x = 0, y = 0, z = 0, w = 1;
    bool operator==(const Quat&) const = default;
};
// First b, then a.
constexpr Quat operator*(Quat a, Quat b) {
    return {a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
            a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
            a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w,
            a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z};
}
constexpr Quat conjugate(Quat q) { return {-q.x, -q.y, -q.z, q.w}; }
constexpr Vec3 rotate(Quat q, Vec3 v) {
    const Vec3 u{q.x, q.y, q.z};
    const Vec3 t = cross(u, v) * 2;
    return v + t * q.w + cross(u, t);
}

// Rotation, then translation; no scale.
struct Transform {
    Quat rotation;
    Vec3 translation;
    bool operator==(const Transform&) const = default;
};
constexpr Transform operator*(const Transform& a, const Transform& b) {
    return {a.rotation * b.rotation, a.translation + rotate(a.rotation, b.translation)};
}
constexpr Vec3 operator*(const Transform& a, Vec3 point) {
    return a.translation + rotate(a.rotation, point);
}
constexpr Transform inverse(const Transform& a) {
    const Quat r = conjugate(a.rotation);
    return {r, rotate(r, -a.translation)};
}

}  // namespace puppetri
