// SPDX-License-Identifier: MIT
// Implicit shapes: a solid as the set of points where a smooth function is negative. Round cones
// and ellipsoids, squashed and turned at will, are joined one after the other by a smooth minimum,
// which rounds the seams as flesh does.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "puppetri/math/transform.h"

namespace puppetri::figure {

struct FieldSample {
    double distance = 0;  // about metres; negative inside
    Vec3 gradient;        // about unit length, pointing outwards
};

// The hull of two spheres, in a frame of its own that may be squashed: the point p of model space
// is seen at (u . (p - origin) / scale.x, v . ... / scale.y, w . ... / scale.z), where u, v, w =
// rotation of the model axes.
struct RoundCone {
    Vec3 a, b;  // in the local frame before scaling, metres
    double radius_a = 0, radius_b = 0;
    Vec3 origin_model;
    Quat model_from_local;
    Vec3 scale{1, 1, 1};
    double blend_m = 0.01;  // how far the seam to what came before is rounded
    std::uint8_t level =
        0;  // how many times finer than the coarsest cells it is to be meshed (powers of two)
    bool carve = false;   // taken away instead of added
    bool paired = false;  // joined with its mirror image in x = 0 before both join the rest
};

// A box along the axes.
struct Bounds {
    Vec3 low{1e9, 1e9, 1e9}, high{-1e9, -1e9, -1e9};
    void add(Vec3 p);
    bool overlaps(const Bounds& other) const;
    Bounds grown(double by) const;
};

// Primitives in the order in which they are joined.
class ImplicitShape {
 public:
    void add(const RoundCone& cone);
    int size() const { return static_cast<int>(cones_.size()); }
    const RoundCone& cone(int i) const { return cones_[static_cast<std::size_t>(i)]; }

    // Where cone i is; and where it can matter for the sign of the whole.
    const Bounds& tight(int i) const { return tight_[static_cast<std::size_t>(i)]; }
    const Bounds& reach(int i) const { return reach_[static_cast<std::size_t>(i)]; }

    // The joined function of the cones listed, in that order. An empty list gives a large distance.
    double distance(Vec3 p_model, std::span<const std::uint16_t> active) const;
    // False when cone i cannot matter for the sign or the surface within `slack_m` of a point.
    bool near(int i, Vec3 p_model, double slack_m) const;
    FieldSample sample(Vec3 p_model, std::span<const std::uint16_t> active) const;

    // Metres by which the surface stands out at a point; context outlives the shape. None: nowhere.
    void set_relief(double (*relief)(const void* context, Vec3 p_model), const void* context);

 private:
    // What every evaluation needs of a cone, worked out once.
    struct Prepared {
        Vec3 origin_model, a, along, inverse_scale;
        Quat local_from_model;
        double length_m = 0, tangent = 0, radius_a = 0, widening = 0, blend_m = 0;
        bool turned = false, squashed = false, carve = false, paired = false;
    };
    struct Foot;
    static Foot foot_of(const Prepared& c, Vec3 p_model);
    static double distance_to(const Prepared& c, Vec3 p_model);
    static FieldSample sample_of(const Prepared& c, Vec3 p_model);
    static double pair_distance(const Prepared& c, Vec3 p_model);
    static FieldSample pair_sample(const Prepared& c, Vec3 p_model);

    double (*relief_)(const void*, Vec3) = nullptr;
    const void* relief_context_ = nullptr;
    std::vector<RoundCone> cones_;
    std::vector<Prepared> prepared_;
    std::vector<Bounds> tight_, reach_;
};

}  // namespace puppetri::figure
