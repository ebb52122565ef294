// SPDX-License-Identifier: MIT
// Affine maps, for what files have before it is made rigid: scales of nodes, inverse bind matrices.
#pragma once
#include <cmath>

#include "puppetri/base/elementary.h"
#include "puppetri/math/rotation.h"
#include "puppetri/math/transform.h"

namespace puppetri::io {

struct Affine {
    Vec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1}, translation;  // columns

    Vec3 turn(Vec3 v) const { return x * v.x + y * v.y + z * v.z; }
    Vec3 operator*(Vec3 p) const { return translation + turn(p); }
    Affine operator*(const Affine& b) const {
        return {turn(b.x), turn(b.y), turn(b.z), *this * b.translation};
    }
    double determinant() const { return dot(x, cross(y, z)); }
};

inline Affine to_affine(const Transform& t, Vec3 scale = {1, 1, 1}) {
    return {rotate(t.rotation, {scale.x, 0, 0}), rotate(t.rotation, {0, scale.y, 0}),
            rotate(t.rotation, {0, 0, scale.z}), t.translation};
}

// Needs a determinant that is not zero.
inline Affine inverse(const Affine& a) {
    const double d = 1 / a.determinant();
    const Vec3 u = cross(a.y, a.z) * d, v = cross(a.z, a.x) * d, w = cross(a.x, a.y) * d;
    Affine i{{u.x, v.x, w.x}, {u.y, v.y, w.y}, {u.z, v.z, w.z}, {}};
    i.translation = -i.turn(a.translation);
    return i;
}

// The rotation nearest to it in the order x, y, z; a mirror image loses its z.
inline Quat rotation_of(const Affine& a) {
    const Vec3 x = normalized(a.x), y = normalized(a.y - x * dot(x, a.y), {0, 1, 0});
    return normalized(from_basis(x, y, cross(x, y)));
}

// The third root of the volume: by how much lengths grow.
inline double scale_of(const Affine& a) { return pow(std::fabs(a.determinant()), 1.0 / 3); }

}  // namespace puppetri::io
