// SPDX-License-Identifier: MIT
// Distances and gradients of round cones, and their smooth union.
//
// Source  the round cone after I. Quilez, "distance functions"; written here with the foot s of the
// surface normal on
//         the axis: with sin t = (ra - rb) / L, a point x along and y beside the axis has s = x - y
//         tan t, clamped to the axis, and the distance to the sphere around s is the distance to
//         the hull. A squashed frame changes distances; dividing by the length of the gradient in
//         model space makes the value a distance again to first order (G. Taubin, "Distance
//         approximations for rasterizing implicit curves", 1994). The smooth minimum is Quilez's
//         quadratic one: min(a, b) - k h^2 / 4 with h = max(0, 1 - |a - b| / k).
#include "implicit_shape.h"

#include <algorithm>

namespace puppetri::figure {
namespace {

FieldSample smooth_min(const FieldSample& a, const FieldSample& b, double k) {
    const double h = k > 0 ? std::max(0.0, 1 - std::fabs(a.distance - b.distance) / k) : 0.0;
    const FieldSample& nearer = a.distance <= b.distance ? a : b;
    const FieldSample& farther = a.distance <= b.distance ? b : a;
    const double w = h / 2;  // weight of the farther one's gradient
    return {nearer.distance - k * h * h / 4, nearer.gradient * (1 - w) + farther.gradient * w};
}

double smooth_min(double a, double b, double k) {
    const double h = std::max(0.0, 1 - std::fabs(a - b) / k);
    return std::min(a, b) - k * h * h / 4;
}

Vec3 mirrored(Vec3 p) { return {-p.x, p.y, p.z}; }

FieldSample negative(const FieldSample& s) { return {-s.distance, -s.gradient}; }

}  // namespace

// Where the nearest sphere of a cone stands, seen in the cone's own frame.
struct ImplicitShape::Foot {
    Vec3 away;  // from the sphere's centre to the point
    double distance = 0, radius = 0;
};

ImplicitShape::Foot ImplicitShape::foot_of(const Prepared& c, Vec3 p_model) {
    Vec3 p = p_model - c.origin_model;
    if (c.turned) {
        p = rotate(c.local_from_model, p);
    }
    if (c.squashed) {
        p = {p.x * c.inverse_scale.x, p.y * c.inverse_scale.y, p.z * c.inverse_scale.z};
    }
    Vec3 from_a = p - c.a;
    if (c.length_m == 0) {
        return {from_a, length(from_a), c.radius_a};
    }
    const double x = dot(from_a, c.along);
    const double y = std::sqrt(std::max(0.0, dot(from_a, from_a) - x * x));
    const double s = std::clamp(x - y * c.tangent, 0.0, c.length_m);
    const Vec3 away = from_a - c.along * s;
    return {away, length(away), c.radius_a + c.widening * s};
}

double ImplicitShape::distance_to(const Prepared& c, Vec3 p_model) {
    const Foot f = foot_of(c, p_model);
    if (!c.squashed) {
        return f.distance - f.radius;
    }
    const Vec3 g{f.away.x * c.inverse_scale.x, f.away.y * c.inverse_scale.y,
                 f.away.z * c.inverse_scale.z};
    return (f.distance - f.radius) * f.distance / std::max(length(g), 1e-12);
}

FieldSample ImplicitShape::sample_of(const Prepared& c, Vec3 p_model) {
    const Foot f = foot_of(c, p_model);
    const Vec3 n = f.distance > 0 ? f.away * (1 / f.distance) : Vec3{0, 1, 0};
    if (!c.squashed) {
        return {f.distance - f.radius, c.turned ? rotate(conjugate(c.local_from_model), n) : n};
    }
    Vec3 g{n.x * c.inverse_scale.x, n.y * c.inverse_scale.y, n.z * c.inverse_scale.z};
    const double steepness = std::max(length(g), 1e-9);
    g = g * (1 / steepness);
    return {(f.distance - f.radius) / steepness,
            c.turned ? rotate(conjugate(c.local_from_model), g) : g};
}

double ImplicitShape::pair_distance(const Prepared& c, Vec3 p) {
    return c.paired ? smooth_min(distance_to(c, p), distance_to(c, mirrored(p)), c.blend_m)
                    : distance_to(c, p);
}

FieldSample ImplicitShape::pair_sample(const Prepared& c, Vec3 p) {
    if (!c.paired) {
        return sample_of(c, p);
    }
    FieldSample other = sample_of(c, mirrored(p));
    other.gradient = mirrored(other.gradient);
    return smooth_min(sample_of(c, p), other, c.blend_m);
}

bool ImplicitShape::near(int i, Vec3 p, double slack_m) const {
    const Prepared& c = prepared_[static_cast<std::size_t>(i)];
    return pair_distance(c, p) < 2 * c.blend_m + slack_m;
}

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
            const Vec3 q =
                end + Vec3{(corner & 1) ? r : -r, (corner & 2) ? r : -r, (corner & 4) ? r : -r};
            const Vec3 scaled{q.x * cone.scale.x, q.y * cone.scale.y, q.z * cone.scale.z};
            const Vec3 at = cone.origin_model + rotate(cone.model_from_local, scaled);
            box.add(at);
            if (cone.paired) {
                box.add(mirrored(at));
            }
        }
    }
    Prepared c;
    c.origin_model = cone.origin_model;
    c.a = cone.a;
    c.inverse_scale = {1 / cone.scale.x, 1 / cone.scale.y, 1 / cone.scale.z};
    c.local_from_model = conjugate(cone.model_from_local);
    c.turned = !(cone.model_from_local == Quat{});
    c.squashed = !(cone.scale == Vec3{1, 1, 1});
    c.carve = cone.carve;
    c.paired = cone.paired;
    c.radius_a = cone.radius_a;
    c.blend_m = cone.blend_m;
    const double l = length(cone.b - cone.a);
    if (l > 1e-9) {
        const double sine = std::clamp((cone.radius_a - cone.radius_b) / l, -0.98, 0.98);
        c.length_m = l;
        c.along = (cone.b - cone.a) * (1 / l);
        c.tangent = sine / std::sqrt(1 - sine * sine);
        c.widening = (cone.radius_b - cone.radius_a) / l;
    }
    prepared_.push_back(c);
    tight_.push_back(box);
    // The smooth minimum acts where two distances differ by less than `blend`; what is twice as far
    // cannot move the sign even through a second seam.
    reach_.push_back(box.grown(2 * cone.blend_m));
}

void ImplicitShape::set_relief(double (*relief)(const void*, Vec3), const void* context) {
    relief_ = relief;
    relief_context_ = context;
}

double ImplicitShape::distance(Vec3 p, std::span<const std::uint16_t> active) const {
    double all = 1e3;
    for (const std::uint16_t i : active) {
        const Prepared& c = prepared_[i];
        const double one = pair_distance(c, p);
        all = c.carve ? -smooth_min(-all, one, c.blend_m) : smooth_min(all, one, c.blend_m);
    }
    return relief_ == nullptr || std::fabs(all) > 0.02 ? all : all - relief_(relief_context_, p);
}

FieldSample ImplicitShape::sample(Vec3 p, std::span<const std::uint16_t> active) const {
    FieldSample all{1e3, {0, 1, 0}};
    for (const std::uint16_t i : active) {
        const Prepared& c = prepared_[i];
        const FieldSample one = pair_sample(c, p);
        all = c.carve ? negative(smooth_min(negative(all), one, c.blend_m))
                      : smooth_min(all, one, c.blend_m);
    }
    if (relief_ != nullptr && std::fabs(all.distance) < 0.02) {
        // Central differences over half a millimetre: the steps of the relief are a few millimetres
        // wide.
        constexpr double kStep = 0.0005;
        const auto at = [&](Vec3 way) { return relief_(relief_context_, p + way); };
        const auto slope = [&](Vec3 way) { return (at(way) - at(-way)) / (2 * kStep); };
        all.distance -= at({});
        all.gradient =
            all.gradient - Vec3{slope({kStep, 0, 0}), slope({0, kStep, 0}), slope({0, 0, kStep})};
    }
    return all;
}

}  // namespace puppetri::figure
