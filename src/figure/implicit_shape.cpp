// SPDX-License-Identifier: MIT
// Distances and gradients of round cones, and their smooth union.
//
// Source  the round cone after I. Quilez, "distance functions"; written here with the foot s of the surface normal on
//         the axis: with sin t = (ra - rb) / L, a point x along and y beside the axis has s = x - y tan t, clamped to
//         the axis, and the distance to the sphere around s is the distance to the hull.
//         A squashed frame changes distances; dividing by the length of the gradient in model space makes the value a
//         distance again to first order (G. Taubin, "Distance approximations for rasterizing implicit curves", 1994).
//         The smooth minimum is Quilez's quadratic one: min(a, b) - k h^2 / 4 with h = max(0, 1 - |a - b| / k).
#include "implicit_shape.h"

#include <algorithm>

namespace puppetri::figure {
namespace {

FieldSample sample_cone(const RoundCone& c, Vec3 p_model) {
    const Vec3 turned = rotate(conjugate(c.model_from_local), p_model - c.origin_model);
    const Vec3 p{turned.x / c.scale.x, turned.y / c.scale.y, turned.z / c.scale.z};
    const Vec3 axis = c.b - c.a;
    const double length_m = length(axis);
    Vec3 centre = c.a;
    double radius = c.radius_a;
    if (length_m > 1e-9) {
        const Vec3 along = axis * (1 / length_m);
        const Vec3 from_a = p - c.a;
        const double x = dot(from_a, along);
        const double y = length(from_a - along * x);
        const double sine = std::clamp((c.radius_a - c.radius_b) / length_m, -0.98, 0.98);
        const double s = std::clamp(x - y * sine / std::sqrt(1 - sine * sine), 0.0, length_m);
        centre = c.a + along * s;
        radius = c.radius_a + (c.radius_b - c.radius_a) * (s / length_m);
    }
    const Vec3 away = p - centre;
    const double d = length(away);
    const Vec3 n = normalized(away, {0, 1, 0});
    const Vec3 g{n.x / c.scale.x, n.y / c.scale.y, n.z / c.scale.z};
    const double steepness = std::max(length(g), 1e-9);
    return {(d - radius) / steepness, rotate(c.model_from_local, g * (1 / steepness))};
}

FieldSample smooth_min(const FieldSample& a, const FieldSample& b, double k) {
    const double h = k > 0 ? std::max(0.0, 1 - std::fabs(a.distance - b.distance) / k) : 0.0;
    const FieldSample& nearer = a.distance <= b.distance ? a : b;
    const FieldSample& farther = a.distance <= b.distance ? b : a;
    const double w = h / 2;  // weight of the farther one's gradient
    return {nearer.distance - k * h * h / 4, nearer.gradient * (1 - w) + farther.gradient * w};
}

FieldSample negative(const FieldSample& s) { return {-s.distance, -s.gradient}; }

}  // namespace

void Bounds::add(Vec3 p) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
}

bool Bounds::overlaps(const Bounds& o) const {
    return low.x <= o.high.x && high.x >= o.low.x && low.y <= o.high.y && high.y >= o.low.y &&
           low.z <= o.high.z && high.z >= o.low.z;
}

Bounds Bounds::grown(double by) const {
    const Vec3 d{by, by, by};
    return {low - d, high + d};
}

void ImplicitShape::add(const RoundCone& cone) {
    cones_.push_back(cone);
    Bounds box;
    for (const Vec3 end : {cone.a, cone.b}) {
        const double r = end == cone.a ? cone.radius_a : cone.radius_b;
        for (int corner = 0; corner < 8; ++corner) {
            const Vec3 q = end + Vec3{(corner & 1) ? r : -r, (corner & 2) ? r : -r, (corner & 4) ? r : -r};
            const Vec3 scaled{q.x * cone.scale.x, q.y * cone.scale.y, q.z * cone.scale.z};
            box.add(cone.origin_model + rotate(cone.model_from_local, scaled));
        }
    }
    tight_.push_back(box);
    // The smooth minimum acts where two distances differ by less than `blend`; what is twice as far cannot move the
    // sign even through a second seam.
    reach_.push_back(box.grown(2 * cone.blend_m));
}

double ImplicitShape::distance(Vec3 p, std::span<const std::uint16_t> active) const {
    return sample(p, active).distance;
}

FieldSample ImplicitShape::sample(Vec3 p, std::span<const std::uint16_t> active) const {
    FieldSample all{1e3, {0, 1, 0}};
    for (const std::uint16_t i : active) {
        const RoundCone& c = cones_[i];
        const FieldSample one = sample_cone(c, p);
        all = c.carve ? negative(smooth_min(negative(all), one, c.blend_m)) : smooth_min(all, one, c.blend_m);
    }
    return all;
}

}  // namespace puppetri::figure
