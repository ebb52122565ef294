// SPDX-License-Identifier: MIT
// The triangle of a limb and its goals up to the swivel.
//
// Seen from the first joint, in its own space, the end joint is at u + H(x) l: u the upper bone, l
// the lower one, H(x) the hinge's rotation by x. Split l (brought into the space of the first joint
// at x = 0) along the hinge's axis h: H(x) l = l_h + cos x l_c + sin x l_s with l_s = h x l. Then
//   |u + H(x) l|^2 = |u|^2 + |l|^2 + 2 u.l_h + 2 (u.l_c) cos x + 2 (u.l_s) sin x,
// which is largest at the angle x0 of (u.l_c, u.l_s), the straight limb, and depends on the bend
// d = x - x0 by 2 r cos d alone, r = |(u.l_c, u.l_s)|. That is Tolani's law of cosines without the
// assumption that the hinge is across the bones. The first joint's rotation must then take the
// direction a of u + H(x) l to that of the target; what is free is a turn about it.
//
// Source  Tolani, Goswami and Badler, "Real-time inverse kinematics techniques for anthropomorphic
//         limbs", Graphical Models 62 (2000) 353-388, sections 2 to 4.
#include "puppetri/motion/limb_ik.h"

#include <string>

#include "limb_kernel.h"
#include "puppetri/base/elementary.h"
#include "puppetri/math/rotation.h"
#include "swivel_limits.h"

namespace puppetri::motion {
namespace {

constexpr double kShortest_m = 1e-6;

using Number = simd::Double1;
kernel::V3<Number> pack(Vec3 v) { return {{v.x}, {v.y}, {v.z}}; }
kernel::Q4<Number> pack(Quat q) { return {{q.x}, {q.y}, {q.z}, {q.w}}; }
Vec3 unpack(kernel::V3<Number> v) { return {v.x.v, v.y.v, v.z.v}; }
Quat unpack(kernel::Q4<Number> q) { return {q.x.v, q.y.v, q.z.v, q.w.v}; }

Vec3 across(Vec3 wanted, Vec3 unit) { return unpack(kernel::across(pack(wanted), pack(unit))); }

LimbTriangle triangle_of(Vec3 upper, Vec3 lower, const figure::JointLimit& hinge) {
    const Quat centre = hinge.parent_from_centre;
    const Vec3 h = hinge.axis_joint;
    LimbTriangle t;
    t.hinge_axis_start = rotate(centre, h);
    const Vec3 l = rotate(centre, lower), l_h = t.hinge_axis_start * dot(t.hinge_axis_start, l),
               l_c = l - l_h, l_s = cross(t.hinge_axis_start, l);
    const CirclePoint straight = circle_direction(dot(upper, l_c), dot(upper, l_s));
    t.line = upper + l_h;
    t.along = l_c * straight.cos + l_s * straight.sin;
    t.across = l_s * straight.cos - l_c * straight.sin;
    const double r = dot(upper, t.along),
                 middle = dot(upper, upper) + dot(l, l) + 2 * dot(upper, l_h);
    t.most2 = middle + 2 * r;
    t.least2 = std::fmax(0, middle - 2 * r);
    t.per_span = 1 / (4 * r);
    // Half of the straight angle, for the quaternion.
    const CirclePoint half = straight.cos >= 0 ? circle_direction(1 + straight.cos, straight.sin)
                                               : circle_direction(straight.sin, 1 - straight.cos);
    t.hinge_straight = centre * Quat{h.x * half.sin, h.y * half.sin, h.z * half.sin, half.cos};
    t.hinge_turn = t.hinge_straight * Quat{h.x, h.y, h.z, 0};
    t.nearest2 = t.least2;
    t.farthest2 = t.most2;
    const double half_range = (hinge.hi_rad - hinge.lo_rad) / 2;
    if (hinge.kind != figure::LimitKind::kHinge || half_range >= kPi) {
        t.cos_half_range = -2;
        return t;
    }
    const CirclePoint range_middle = circle_point((hinge.lo_rad + hinge.hi_rad) / 2),
                      to_end = circle_point(half_range);
    t.straight_from_middle = straight * conjugate(range_middle);
    t.cos_half_range = to_end.cos;
    // The range's middle, seen from the straight limb, is on the side of the bends that will do:
    // of d and -d the one on that side is never farther from it.
    t.sign = t.straight_from_middle.sin <= 0 ? 1 : -1;
    const CirclePoint lo = conjugate(t.straight_from_middle) * conjugate(to_end),
                      hi = conjugate(t.straight_from_middle) * to_end;
    const double at_lo = middle + 2 * r * lo.cos, at_hi = middle + 2 * r * hi.cos;
    const bool has_straight = t.straight_from_middle.cos >= to_end.cos;
    const bool has_folded = -t.straight_from_middle.cos >= to_end.cos;
    t.farthest2 = has_straight ? t.most2 : std::fmax(at_lo, at_hi);
    t.nearest2 = has_folded ? t.least2 : std::fmax(t.least2, std::fmin(at_lo, at_hi));
    return t;
}

// A bend within the hinge's range, with room for rounding.
bool in_range(const LimbTriangle& t, CirclePoint bend) {
    return (t.straight_from_middle * bend).cos >= t.cos_half_range - 1e-14;
}

struct BentLimb {
    Quat hinge;
    Vec3 line_start, pole_start;
};
BentLimb bent(const kernel::Bend<Number>& b) {
    return {unpack(b.hinge), unpack(b.line_start), unpack(b.pole_start)};
}

Quat rotation_between(Vec3 a, Vec3 p, Vec3 b, Vec3 z) {
    return unpack(kernel::rotation_between(pack(a), pack(p), pack(b), pack(z)));
}

}  // namespace

Status check(const LimbShape& shape, std::string_view element) {
    Diagnostics all;
    const auto defect = [&](const char* code, const char* message, const char* remedy) {
        all.push_back({Severity::kError, code, {}, std::string(element), message, remedy});
    };
    const auto add = [&](const figure::JointLimit& limit, const char* joint) {
        Status status = figure::check(limit, std::string(element) + "." + joint);
        if (!status.has_value()) {
            all.insert(all.end(), status.error().begin(), status.error().end());
        }
    };
    add(shape.start_limit, "start");
    add(shape.hinge, "hinge");
    add(shape.end_limit, "end");
    const bool long_upper = length(shape.upper) > kShortest_m,
               long_lower = length(shape.lower) > kShortest_m;
    if (!long_upper || !long_lower) {
        defect("zero-length-bone", "a bone of the limb has no length",
               "move the joint, or take the limb out of the figure's map");
    }
    if (shape.start_limit.kind == figure::LimitKind::kHinge ||
        shape.end_limit.kind == figure::LimitKind::kHinge ||
        shape.hinge.kind == figure::LimitKind::kCone) {
        defect("limb-limit",
               "a limb's first and last joint are ball joints, the one between a hinge",
               "limit the first and the last by cones and the middle one by a range");
    }
    const Vec3 h = shape.hinge.axis_joint;
    const Vec3 u = rotate(conjugate(shape.hinge.parent_from_centre), shape.upper);
    if (long_upper && long_lower &&
        length(cross(h, u)) * length(cross(h, shape.lower)) <
            1e-6 * length(u) * length(shape.lower)) {
        defect("stiff-limb", "a bone lies along the hinge's axis, so that bending moves nothing",
               "give the hinge an axis across the bones");
    }
    if (!all.empty()) {
        return Unexpected(std::move(all));
    }
    return Ok{};
}

LimbShape limb_shape(const figure::Figure& f, Limb limb) {
    const auto limit = [&](figure::JointIndex joint) { return f.limits[joint.value]; };
    if (limb == Limb::kLeftArm || limb == Limb::kRightArm) {
        const figure::Arm& arm = f.arms[limb == Limb::kLeftArm ? figure::kLeft : figure::kRight];
        const double s = limb == Limb::kLeftArm ? 1 : -1;
        return {.start = arm.shoulder_clavicle,
                .upper = {s * arm.upper_m, 0, 0},
                .lower = {s * arm.fore_m, 0, 0},
                .start_limit = limit(arm.shoulder),
                .hinge = limit(arm.elbow),
                .end_limit = limit(arm.hand)};
    }
    PUP_REQUIRE(limb == Limb::kLeftLeg || limb == Limb::kRightLeg);
    const figure::Leg& leg = f.legs[limb == Limb::kLeftLeg ? figure::kLeft : figure::kRight];
    return {.start = leg.hip_pelvis,
            .upper = {0, -leg.thigh_m, 0},
            .lower = {0, -leg.shank_m, 0},
            .start_limit = limit(leg.hip),
            .hinge = limit(leg.knee),
            .end_limit = limit(leg.ankle)};
}

Transform parent_from_end(const LimbShape& shape, const LimbPose& pose) {
    return Transform{pose.start, shape.start} * Transform{pose.hinge, shape.upper} *
           Transform{pose.end, shape.lower};
}
Vec3 elbow_parent(const LimbShape& shape, const LimbPose& pose) {
    return shape.start + rotate(pose.start, shape.upper);
}
double hinge_angle(const LimbShape& shape, const LimbPose& pose) {
    const Quat turn = conjugate(shape.hinge.parent_from_centre) * pose.hinge;
    const Vec3 h = shape.hinge.axis_joint;
    const double angle = 2 * puppetri::atan2(turn.x * h.x + turn.y * h.y + turn.z * h.z, turn.w);
    return angle > kPi ? angle - 2 * kPi : (angle <= -kPi ? angle + 2 * kPi : angle);
}

LimbIk::LimbIk(const LimbShape& shape) : shape_(shape) {
    PUP_REQUIRE(length(shape.upper) > kShortest_m && length(shape.lower) > kShortest_m);
    tables_.triangle = triangle_of(shape.upper, shape.lower, shape.hinge);
    tables_.start = cone_table(shape.start_limit);
    tables_.end = cone_table(shape.end_limit);
    nearest_m_ = std::sqrt(tables_.triangle.nearest2);
    farthest_m_ = std::sqrt(tables_.triangle.farthest2);
}

namespace {

// Families of a goal whose end joint, or a point fixed to the lower bone, goes to a point.
int bend_families(const LimbTriangle& triangle, const LimbGoal& goal, Vec3 target,
                  std::span<LimbFamily, kMaxLimbFamilies> out) {
    const auto t = kernel::triangle_of<Number>(triangle);
    const double distance2 = dot(target, target);
    const double distance = std::sqrt(distance2);
    const Vec3 b = distance2 < 1e-30f ? normalized(goal.line_on_root) : target * (1 / distance);
    const Vec3 zero = across(goal.swivel_zero_parent, b);
    const auto add = [&](LimbFamily& family, const kernel::Bend<Number>& bend) {
        const BentLimb limb = bent(bend);
        family.axis_parent = b;
        family.start_zero = rotation_between(limb.line_start, limb.pole_start, b, zero);
        family.hinge = limb.hinge;
        family.residual_m = std::fabs(distance - bend.distance.v);
    };
    add(out[0], kernel::bend_for(t, Number{distance2}, Number{triangle.sign}));
    const double d2 = clamp(distance2, triangle.nearest2, triangle.farthest2);
    const double cos_bend =
        clamp((2 * d2 - triangle.least2 - triangle.most2) * triangle.per_span, -1, 1);
    const CirclePoint other{cos_bend, -triangle.sign * std::sqrt(1 - cos_bend * cos_bend)};
    // Straight and folded limbs have one family.
    if (other.sin == 0 || !in_range(triangle, other)) {
        return 1;
    }
    add(out[1], kernel::bend_for(t, Number{distance2}, Number{-triangle.sign}));
    return 2;
}

// Of the hinge's angle: itself where it is within the range, else the nearer end.
double hinge_within(const figure::JointLimit& hinge, double angle) {
    if (hinge.kind != figure::LimitKind::kHinge) {
        return angle;
    }
    const Quat inside = figure::clamp_to_limit({.kind = figure::LimitKind::kHinge,
                                                .axis_joint = {1, 0, 0},
                                                .lo_rad = hinge.lo_rad,
                                                .hi_rad = hinge.hi_rad},
                                               about_x(angle));
    return 2 * puppetri::atan2(inside.x, inside.w);
}

// Aiming. With the hinge's rotation H the ray, seen from the first joint in its space, is
// o + s v, s >= 0; the first joint can turn the target to any point at the target's distance, so
// that s is a root of |o + s v|^2 = |target|^2.
struct Ray {
    Vec3 o, v;
};
struct RayHits {
    double s[2];
    int count;
    double miss_m;  // how far the ray passes the target at best
};
RayHits hits(const Ray& ray, double distance2) {
    const double ov = dot(ray.o, ray.v), o2 = dot(ray.o, ray.o);
    const double inside = distance2 - o2 + ov * ov;
    RayHits h{{0, 0}, 0, 0};
    const double distance = std::sqrt(distance2);
    if (inside < 0 || (ov > 0 && o2 > distance2)) {
        h.s[0] = std::fmax(0, -ov);
        h.count = 1;
        h.miss_m = std::fabs(length(ray.o + ray.v * h.s[0]) - distance);
        return h;
    }
    // The larger root first: the target is ahead of the hand, not between shoulder and hand.
    const double root = std::sqrt(inside);
    h.s[h.count++] = ov > 0 ? (distance2 - o2) / (root + ov) : root - ov;
    if (const double other = -ov - root; other >= 0 && root > 0) {
        h.s[h.count++] = other;
    }
    return h;
}

class Aim {
 public:
    Aim(const LimbShape& shape, const LimbTriangle& triangle, const LimbGoal& goal)
        : shape_(shape), triangle_(triangle), goal_(goal) {
        end_ = figure::clamp_to_limit(shape.end_limit, goal.end_rotation);
        tip_hinge_ = shape.lower + rotate(end_, goal.tip_end);
        axis_hinge_ = normalized(rotate(end_, goal.axis_end));
    }
    Quat end() const { return end_; }
    Quat hinge_at(double angle) const {
        return shape_.hinge.parent_from_centre * from_axis_angle(shape_.hinge.axis_joint, angle);
    }
    Ray ray_at(double angle) const {
        const Quat h = hinge_at(angle);
        return {shape_.upper + rotate(h, tip_hinge_), rotate(h, axis_hinge_)};
    }

    // The hinge's angle nearest to the wanted one with which the ray can hit: the three conditions
    // (the sphere of the target is met; not behind the tip) are trigonometric polynomials of it.
    double free_angle(double distance2) const {
        const double wanted = hinge_within(shape_.hinge, goal_.hinge_rad);
        if (hits(ray_at(wanted), distance2).miss_m == 0) {
            return wanted;
        }
        const TrigPolynomial o2 = distance2_of(tip_hinge_), ov = along_of();
        const TrigPolynomial ov2 = square(ov);
        const TrigPolynomial outside = o2 * -1 + TrigPolynomial{.c0 = distance2};
        const TrigPolynomial meets = outside + ov2;
        double best = wanted, best_miss = hits(ray_at(wanted), distance2).miss_m, best_way = 0;
        const auto consider = [&](double angle) {
            const double inside = hinge_within(shape_.hinge, angle);
            const double miss = hits(ray_at(inside), distance2).miss_m;
            const double way = std::fabs(turn_between(wanted, inside));
            const bool hit = miss < 1e-9, best_hit = best_miss < 1e-9;
            if (hit != best_hit ? hit : (hit ? way < best_way : miss < best_miss)) {
                best = inside;
                best_miss = miss;
                best_way = way;
            }
        };
        for (const TrigPolynomial& f :
             {meets, outside, ov, meets.derivative(), outside.derivative()}) {
            std::array<SignChange, kMostSignChanges> roots;
            const int count = sign_changes(f, roots);
            for (int i = 0; i < count; ++i) {
                consider(radians_of(roots[i].at));
            }
        }
        consider(shape_.hinge.lo_rad);
        consider(shape_.hinge.hi_rad);
        return best;
    }

 private:
    // a.(H(x) b) for a in the space of the first joint, b in the hinge's.
    TrigPolynomial product(Vec3 a, Vec3 b) const {
        const Quat c = shape_.hinge.parent_from_centre;
        const Vec3 h = triangle_.hinge_axis_start, b0 = rotate(c, b), along = h * dot(h, b0);
        return {.c0 = dot(a, along), .c1 = dot(a, b0 - along), .s1 = dot(a, cross(h, b0))};
    }
    TrigPolynomial distance2_of(Vec3 point_hinge) const {
        return product(shape_.upper, point_hinge) * 2 +
               TrigPolynomial{.c0 =
                                  dot(shape_.upper, shape_.upper) + dot(point_hinge, point_hinge)};
    }
    TrigPolynomial along_of() const {
        return product(shape_.upper, axis_hinge_) +
               TrigPolynomial{.c0 = dot(tip_hinge_, axis_hinge_)};
    }

    const LimbShape& shape_;
    const LimbTriangle& triangle_;
    const LimbGoal& goal_;
    Quat end_;
    Vec3 tip_hinge_, axis_hinge_;
};

}  // namespace

int LimbIk::families(const LimbGoal& goal, std::span<LimbFamily, kMaxLimbFamilies> out) const {
    const Vec3 target = goal.position_parent - shape_.start;
    int count = 0;
    if (goal.kind == LimbGoalKind::kPose) {
        count = bend_families(tables_.triangle, goal,
                              target - rotate(goal.rotation_parent, goal.tip_end), out);
        for (int i = 0; i < count; ++i) {
            out[i].end_turns = true;
            out[i].rotation_parent = goal.rotation_parent;
            out[i].end_zero = conjugate(out[i].start_zero * out[i].hinge) * goal.rotation_parent;
        }
        return count;
    }
    if (goal.kind == LimbGoalKind::kDirection) {
        const Vec3 direction = normalized(goal.direction_parent), axis = normalized(goal.axis_end);
        count = bend_families(tables_.triangle, goal, target - direction * dot(goal.tip_end, axis),
                              out);
        for (int i = 0; i < count; ++i) {
            out[i].end_follows = true;
            out[i].direction_parent = direction;
            out[i].axis_end = axis;
        }
        return count;
    }
    if (goal.kind == LimbGoalKind::kPosition) {
        const Quat end = figure::clamp_to_limit(shape_.end_limit, goal.end_rotation);
        const Vec3 tip = rotate(end, goal.tip_end);
        count = tip == Vec3{}
                    ? bend_families(tables_.triangle, goal, target, out)
                    : bend_families(triangle_of(shape_.upper, shape_.lower + tip, shape_.hinge),
                                    goal, target, out);
        for (int i = 0; i < count; ++i) {
            out[i].end_zero = end;
        }
        return count;
    }
    const Aim aim(shape_, tables_.triangle, goal);
    const bool pointing = goal.kind == LimbGoalKind::kPoint;
    const double distance2 = dot(target, target);
    const double angle = pointing || goal.hinge_given ? hinge_within(shape_.hinge, goal.hinge_rad)
                                                      : aim.free_angle(distance2);
    const Ray ray = aim.ray_at(angle);
    const RayHits h = pointing ? RayHits{{0, 0}, 1, 0} : hits(ray, distance2);
    const Vec3 b = pointing ? normalized(goal.direction_parent)
                            : normalized(target, normalized(goal.line_on_root));
    const Vec3 zero = across(goal.swivel_zero_parent, b);
    for (int i = 0; i < h.count; ++i) {
        const Vec3 a = pointing ? ray.v : normalized(ray.o + ray.v * h.s[i], ray.v);
        const Vec3 pole = across(cross(a, tables_.triangle.hinge_axis_start), a);
        out[i] = {.axis_parent = b,
                  .start_zero = rotation_between(a, pole, b, zero),
                  .hinge = aim.hinge_at(angle),
                  .end_zero = aim.end(),
                  .residual_m = h.miss_m};
    }
    return h.count;
}

LimbPose LimbIk::at(const LimbFamily& family, CirclePoint swivel) const {
    const Quat turn = turn_about(family.axis_parent, swivel);
    LimbPose pose{turn * family.start_zero, family.hinge, family.end_zero};
    if (family.end_turns) {
        pose.end = conjugate(pose.start * pose.hinge) * family.rotation_parent;
    } else if (family.end_follows) {
        pose.end =
            follow_direction(shape_.end_limit, family.axis_end,
                             rotate(conjugate(pose.start * pose.hinge), family.direction_parent));
    }
    return pose;
}

Vec3 LimbIk::elbow_at(const LimbFamily& family, CirclePoint swivel) const {
    return shape_.start +
           rotate(turn_about(family.axis_parent, swivel) * family.start_zero, shape_.upper);
}

CirclePoint LimbIk::swivel_of_elbow(const LimbFamily& family, Vec3 elbow) const {
    const Vec3 b = family.axis_parent, u = rotate(family.start_zero, shape_.upper),
               e = elbow - shape_.start;
    const Vec3 u_across = u - b * dot(u, b);
    const double c = dot(e, u_across), s = dot(e, cross(b, u_across));
    const double sure = 1e-12 * length(shape_.upper);
    return c * c + s * s < sure * sure * sure * sure ? CirclePoint{} : circle_direction(c, s);
}

LimbSolution LimbIk::solve_free(const LimbGoal& goal, CirclePoint swivel) const {
    LimbSolution solution;
    solution.family = 0;
    solution.swivel = swivel;
    if (goal.kind != LimbGoalKind::kPose) {
        std::array<LimbFamily, kMaxLimbFamilies> all;
        families(goal, all);
        solution.pose = at(all[0], swivel);
        solution.residual_m = all[0].residual_m;
        return solution;
    }
    const Vec3 target =
        goal.position_parent - shape_.start - rotate(goal.rotation_parent, goal.tip_end);
    const auto solved = kernel::solve<Number, true>(
        kernel::triangle_of<Number>(tables_.triangle), pack(target), pack(goal.line_on_root),
        pack(goal.rotation_parent), pack(goal.swivel_zero_parent), Number{swivel.cos},
        Number{swivel.sin}, Number{tables_.triangle.sign});
    solution.pose = {unpack(solved.start), unpack(solved.hinge), unpack(solved.end)};
    solution.residual_m = solved.residual.v;
    return solution;
}

}  // namespace puppetri::motion
