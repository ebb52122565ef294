// SPDX-License-Identifier: MIT
// The geometry of one limb, written once for every number type of base/simd_double.h and
// base/simd_float.h, so that one limb and a crowd get the same bits.
#pragma once
#include "puppetri/base/simd_double.h"
#include "puppetri/base/simd_float.h"
#include "puppetri/motion/limb_tables.h"

namespace puppetri::motion::kernel {

template <class N>
struct V3 {
    N x, y, z;
};
template <class N>
struct Q4 {
    N x, y, z, w;
};

template <class N>
inline V3<N> operator+(V3<N> a, V3<N> b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class N>
inline V3<N> operator-(V3<N> a, V3<N> b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class N>
inline V3<N> operator*(V3<N> a, N s) {
    return {a.x * s, a.y * s, a.z * s};
}
template <class N>
inline N dot(V3<N> a, V3<N> b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class N>
inline V3<N> cross(V3<N> a, V3<N> b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class N>
inline Q4<N> operator*(Q4<N> a, Q4<N> b) {
    return {a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
            a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
            a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w,
            a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z};
}
template <class N>
inline V3<N> where_negative(N x, V3<N> a, V3<N> b) {
    return {where_negative(x, a.x, b.x), where_negative(x, a.y, b.y), where_negative(x, a.z, b.z)};
}
template <class N>
inline N greater_of(N a, N b) {
    return where_negative(a - b, b, a);
}
template <class N>
inline N lesser_of(N a, N b) {
    return where_negative(b - a, b, a);
}

// A unit vector across the unit vector `a`: the direction of `wanted` as far as it is across, or
// any where `wanted` is zero or along `a`.
template <class N>
[[gnu::always_inline]] inline V3<N> across(V3<N> wanted, V3<N> a) {
    const N one = N::all(1), none = N::all(0);
    const V3<N> part = wanted - a * dot(wanted, a);
    const N n2 = dot(part, part), whole2 = dot(wanted, wanted);
    // The axis of coordinates that is most across: never nearer than 54 degrees to `a`.
    const N x2 = a.x * a.x, y2 = a.y * a.y, z2 = a.z * a.z;
    const N x_least = x2 - lesser_of(y2, z2), y_least = y2 - z2;
    const V3<N> any{where_negative(x_least, one, none),
                    where_negative(x_least, none, where_negative(y_least, one, none)),
                    where_negative(x_least, none, where_negative(y_least, none, one))};
    const V3<N> other = any - a * dot(any, a);
    // Below, the direction is lost to rounding: 1e-6 squared of the wanted length is 1e-12.
    const N lost = n2 - greater_of(whole2 * N::all(1e-12f), N::all(1e-30f));
    const V3<N> v = where_negative(lost, other, part);
    return v * (one / sqrt(dot(v, v)));
}

// The rotation that takes the unit vectors a, p (across a) to b, z (across b).
// Source  the sum of outer products, and the quaternion of a matrix by its largest component
//         (Shepperd 1978), without branches.
template <class N>
[[gnu::always_inline]] inline Q4<N> rotation_between(V3<N> a, V3<N> p, V3<N> b, V3<N> z) {
    const V3<N> q = cross(a, p), y = cross(b, z);
    const N m00 = b.x * a.x + z.x * p.x + y.x * q.x, m01 = b.x * a.y + z.x * p.y + y.x * q.y,
            m02 = b.x * a.z + z.x * p.z + y.x * q.z;
    const N m10 = b.y * a.x + z.y * p.x + y.y * q.x, m11 = b.y * a.y + z.y * p.y + y.y * q.y,
            m12 = b.y * a.z + z.y * p.z + y.y * q.z;
    const N m20 = b.z * a.x + z.z * p.x + y.z * q.x, m21 = b.z * a.y + z.z * p.y + y.z * q.y,
            m22 = b.z * a.z + z.z * p.z + y.z * q.z;
    const N one = N::all(1), half = N::all(0.5f);
    // Four times the square of each component.
    const N tw = one + m00 + m11 + m22, tx = one + m00 - m11 - m22, ty = one - m00 + m11 - m22,
            tz = one - m00 - m11 + m22;
    const N xy = m10 + m01, xz = m02 + m20, yz = m21 + m12;
    const N xw = m21 - m12, yw = m02 - m20, zw = m10 - m01;
    const N x_over_w = tw - tx, z_over_y = ty - tz;  // negative where so
    const N t1 = where_negative(x_over_w, tx, tw), t2 = where_negative(z_over_y, tz, ty);
    const N second = t1 - t2;
    const auto pick = [&](N z_, N y_, N x_, N w_) {
        return where_negative(second, where_negative(z_over_y, z_, y_),
                              where_negative(x_over_w, x_, w_));
    };
    const N t = where_negative(second, t2, t1);
    const N qx = pick(xz, xy, tx, xw), qy = pick(yz, ty, xy, yw), qz = pick(tz, yz, xz, zw),
            qw = pick(zw, yw, xw, tw);
    const N k = half / sqrt(t);
    return {qx * k, qy * k, qz * k, qw * k};
}

// LimbTriangle in the number type N.
template <class N>
struct Triangle {
    V3<N> line, along, across, hinge_axis;
    Q4<N> straight, turn;
    N least2, most2, per_span, nearest2, farthest2;
};
template <class N>
inline Triangle<N> triangle_of(const LimbTriangle& t) {
    const auto n = [](double x) { return N::all(static_cast<typename N::Scalar>(x)); };
    const auto v = [&](Vec3 a) { return V3<N>{n(a.x), n(a.y), n(a.z)}; };
    const auto q = [&](Quat a) { return Q4<N>{n(a.x), n(a.y), n(a.z), n(a.w)}; };
    return {v(t.line),           v(t.along),      v(t.across),   v(t.hinge_axis_start),
            q(t.hinge_straight), q(t.hinge_turn), n(t.least2),   n(t.most2),
            n(t.per_span),       n(t.nearest2),   n(t.farthest2)};
}

// The bend with which the end is as far from the first joint as asked, or as near to that as the
// hinge allows. `sign` is 1 or -1.
template <class N>
struct Bend {
    Q4<N> hinge;
    V3<N> line_start, pole_start;  // unit: to the end joint; where a positive bend has the elbow
    N distance;                    // that the bend has
};
template <class N>
[[gnu::always_inline]] inline Bend<N> bend_for(const Triangle<N>& t, N distance2, N sign) {
    const N none = N::all(0), one = N::all(1), two = N::all(2);
    const N d2 = greater_of(t.nearest2, lesser_of(t.farthest2, distance2));
    const N cos2 = greater_of(none, (d2 - t.least2) * t.per_span);
    const N sin2 = greater_of(none, (t.most2 - d2) * t.per_span);
    const N c = sqrt(cos2), s = sqrt(sin2) * sign;
    const N cos_bend = cos2 - sin2, sin_bend = two * c * s;
    Bend<N> bend;
    bend.hinge = {t.straight.x * c + t.turn.x * s, t.straight.y * c + t.turn.y * s,
                  t.straight.z * c + t.turn.z * s, t.straight.w * c + t.turn.w * s};
    bend.distance = sqrt(d2);
    // Folded onto the first joint the end has no direction: the one in which it leaves.
    const N folded = d2 - t.most2 * N::all(1e-12f);  // negative where so
    const V3<N> end = t.line + t.along * cos_bend + t.across * sin_bend;
    const V3<N> line = where_negative(folded, t.across, end);
    bend.line_start = line * (one / sqrt(dot(line, line)));
    bend.pole_start = across(cross(bend.line_start, t.hinge_axis) * sign, bend.line_start);
    return bend;
}

template <class N>
struct Solved {
    Q4<N> start, hinge, end;
    N residual;
};

// The limb with its end at `target` (seen from its first joint) and the swivel (cosine, sine)
// counted from `zero`. With `rotation` the end joint takes what is left of it.
template <class N, bool kRotation>
[[gnu::always_inline]] inline Solved<N> solve(const Triangle<N>& t, V3<N> target, V3<N> on_root,
                                              Q4<N> rotation, V3<N> zero, N swivel_cos,
                                              N swivel_sin, N sign) {
    const N one = N::all(1);
    const N distance2 = dot(target, target);
    const N lost = distance2 - N::all(1e-30f);  // negative where so
    const V3<N> to = where_negative(lost, on_root, target);
    const N distance = sqrt(distance2);
    const V3<N> b = to * (one / sqrt(dot(to, to)));
    const Bend<N> bend = bend_for(t, distance2, sign);
    const V3<N> z = across(zero, b);
    const V3<N> pole = z * swivel_cos + cross(b, z) * swivel_sin;
    Solved<N> out;
    out.start = rotation_between(bend.line_start, bend.pole_start, b, pole);
    out.hinge = bend.hinge;
    out.residual = greater_of(distance - bend.distance, bend.distance - distance);
    if constexpr (kRotation) {
        const Q4<N> fore = out.start * out.hinge;
        out.end = Q4<N>{-fore.x, -fore.y, -fore.z, fore.w} * rotation;
    }
    return out;
}

}  // namespace puppetri::motion::kernel
