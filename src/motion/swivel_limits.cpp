// SPDX-License-Identifier: MIT
// A ball joint whose rotation, relative to the centre of its limit, is c q0 + s q1 with
// (c, s) = (cos x/2, sin x/2) of the swivel x: q0 for swivel 0, q1 for half a turn more. Write a
// quaternion's components along the cone's side, other and twist axis as (p, r, z) and its scalar
// as w: each is linear in (c, s), so that every product of two is k0 + k1 cos x + k2 sin x.
//
// Twist: its half angle h has (cos h, sin h) in the ratio w : z. It is in [lo, hi], a range of at
// most a full turn, when sin(h - lo/2) sin(hi/2 - h) >= 0, that is
//   (z cos(lo/2) - w sin(lo/2)) (w sin(hi/2) - z cos(hi/2)) >= 0:    degree 1, one arc at most.
//
// Swing: the bone's direction, the image of the twist axis, is d = (2 (p z + r w), 2 (r z - p w),
// 2 (z^2 + w^2) - 1), each of degree 1. The swing's quaternion has the components
// p' = -d_r / sqrt(2 (1 + d_z)), r' = d_p / sqrt(2 (1 + d_z)), so that the ellipse of
// figure/limits.h is
//   2 (1 + d_z) - d_r^2 / sin^2(A/2) - d_p^2 / sin^2(B/2) >= 0:      degree 2, two arcs at most.
// A round cone, A = B, is d_z >= cos A: degree 1.
#include "swivel_limits.h"

#include <bit>

#include "puppetri/base/elementary.h"
#include "puppetri/math/rotation.h"

namespace puppetri::motion {
namespace {

// k0 + k1 cos x + k2 sin x.
struct First {
    double k0, k1, k2;
};
First operator+(First a, First b) { return {a.k0 + b.k0, a.k1 + b.k1, a.k2 + b.k2}; }
First operator-(First a, First b) { return {a.k0 - b.k0, a.k1 - b.k1, a.k2 - b.k2}; }
First operator*(First a, double k) { return {a.k0 * k, a.k1 * k, a.k2 * k}; }

// at0 cos(x/2) + at1 sin(x/2).
struct Half {
    double at0, at1;
};
Half operator*(Half a, double k) { return {a.at0 * k, a.at1 * k}; }
Half operator-(Half a, Half b) { return {a.at0 - b.at0, a.at1 - b.at1}; }
First operator*(Half a, Half b) {
    return {0.5 * (a.at0 * b.at0 + a.at1 * b.at1), 0.5 * (a.at0 * b.at0 - a.at1 * b.at1),
            0.5 * (a.at0 * b.at1 + a.at1 * b.at0)};
}

TrigPolynomial polynomial(First f) { return {.c0 = f.k0, .c1 = f.k1, .s1 = f.k2}; }
TrigPolynomial square(First f) { return square(polynomial(f)); }

constexpr double kRound = 1e-12;

void add_swing(const ConeTable& cone, First d_p, First d_r, First d_z, SwivelConstraints& out) {
    TrigPolynomial round = polynomial(d_z);
    round.c0 -= cone.cos_swing;
    if (cone.round) {
        out.add(round);
        return;
    }
    // Brought to about the size of the other limits' polynomials, so that one tolerance serves all.
    const double scale = 1 / std::fmax(cone.per_side2, cone.per_other2);
    TrigPolynomial f =
        (square(d_r) * -cone.per_side2) + (square(d_p) * -cone.per_other2) + polynomial(d_z) * 2;
    f.c0 += 2;
    out.add(f * scale);
    // The quadric also touches zero where the bone points straight back.
    out.guards[out.guard_count++] = round;
}

void add_cone(const ConeTable& cone, Quat q0, Quat q1, SwivelConstraints& out) {
    const Vec3 v0{q0.x, q0.y, q0.z}, v1{q1.x, q1.y, q1.z};
    const Half z{dot(v0, cone.axis), dot(v1, cone.axis)}, w{q0.w, q1.w};
    if (cone.twist_limited) {
        out.add(polynomial((z * cone.half_lo.cos - w * cone.half_lo.sin) *
                           (w * cone.half_hi.sin - z * cone.half_hi.cos)));
    }
    if (cone.swing_limited) {
        const Half p{dot(v0, cone.side), dot(v1, cone.side)},
            r{dot(v0, cone.other), dot(v1, cone.other)};
        First d_z = (z * z + w * w) * 2;
        d_z.k0 -= 1;
        add_swing(cone, (p * z + r * w) * 2, (r * z - p * w) * 2, d_z, out);
    }
}

Quat pure(Vec3 v) { return {v.x, v.y, v.z, 0}; }

}  // namespace

ConeTable cone_table(const figure::JointLimit& limit) {
    ConeTable t;
    t.centre_from_parent = conjugate(limit.parent_from_centre);
    t.axis = limit.axis_joint;
    t.side = limit.side_joint;
    t.other = cross(limit.axis_joint, limit.side_joint);
    if (limit.kind != figure::LimitKind::kCone) {
        return t;
    }
    t.twist_limited = limit.hi_rad - limit.lo_rad < 2 * kPi;
    t.half_lo = circle_point(limit.lo_rad / 2);
    t.half_hi = circle_point(limit.hi_rad / 2);
    const double a = limit.swing_side_rad, b = limit.swing_other_rad;
    t.swing_limited = std::fmin(a, b) < kPi - 1e-9;
    t.round = a == b;
    const double sin_a = puppetri::sin(a / 2), sin_b = puppetri::sin(b / 2);
    t.per_side2 = 1 / (sin_a * sin_a);
    t.per_other2 = 1 / (sin_b * sin_b);
    t.cos_swing = puppetri::cos(std::fmax(a, b));
    return t;
}

Quat turn_about(Vec3 axis, CirclePoint angle) {
    const CirclePoint half = angle.cos >= 0 ? circle_direction(1 + angle.cos, angle.sin)
                                            : circle_direction(angle.sin, 1 - angle.cos);
    return {axis.x * half.sin, axis.y * half.sin, axis.z * half.sin, half.cos};
}

Quat follow_direction(const figure::JointLimit& limit, Vec3 axis_end, Vec3 direction_parent) {
    const Vec3 direction = rotate(conjugate(limit.parent_from_centre), direction_parent);
    const Quat swing = shortest_arc(axis_end, direction, limit.side_joint);
    if (limit.kind != figure::LimitKind::kCone) {
        return limit.parent_from_centre * swing;
    }
    const double sign = dot(axis_end, limit.axis_joint) < 0 ? -1 : 1;
    const double twist = clamp(0, limit.lo_rad, limit.hi_rad);
    return limit.parent_from_centre * swing * from_axis_angle(axis_end, sign * twist);
}

void SwivelConstraints::add(const TrigPolynomial& g) {
    const double most = g.swing();
    if (g.c0 >= most) {
        return;
    }
    if (g.c0 < -most - kRound) {
        never = true;
    }
    f[count++] = g;
}

void SwivelConstraints::add_start(const ConeTable& cone, const LimbFamily& family) {
    if (cone.twist_limited || cone.swing_limited) {
        const Quat q0 = cone.centre_from_parent * family.start_zero,
                   q1 = cone.centre_from_parent * (pure(family.axis_parent) * family.start_zero);
        add_cone(cone, q0, q1, *this);
    }
}

void SwivelConstraints::add_end(const ConeTable& cone, const LimbFamily& family) {
    if (!cone.twist_limited && !cone.swing_limited) {
        return;
    }
    const Quat centre_from_parent =
        cone.centre_from_parent * conjugate(family.start_zero * family.hinge);
    if (family.end_turns) {
        const Quat q0 = centre_from_parent * family.rotation_parent,
                   q1 = centre_from_parent * (pure(-family.axis_parent) * family.rotation_parent);
        add_cone(cone, q0, q1, *this);
    } else if (family.end_follows && cone.swing_limited) {
        // The direction seen from the hinge turns back with the swivel; the twist is free.
        const double sign = dot(family.axis_end, cone.axis) < 0 ? -1 : 1;
        const Vec3 g = family.direction_parent * sign, b = family.axis_parent;
        const Vec3 along = b * dot(b, g);
        const Vec3 k0 = rotate(centre_from_parent, along),
                   k1 = rotate(centre_from_parent, g - along),
                   k2 = rotate(centre_from_parent, -cross(b, g));
        const auto part = [&](Vec3 e) { return First{dot(k0, e), dot(k1, e), dot(k2, e)}; };
        add_swing(cone, part(cone.side), part(cone.other), part(cone.axis), *this);
    }
}

bool SwivelConstraints::allow(CirclePoint swivel) const {
    for (int i = 0; i < count; ++i) {
        if (f[i].at(swivel) < -kRound) {
            return false;
        }
    }
    for (int i = 0; i < guard_count; ++i) {
        if (guards[i].at(swivel) < -kRound) {
            return false;
        }
    }
    return true;
}

namespace {

// The middle of a quarter that is not skipped.
CirclePoint somewhere(unsigned skip) {
    const int quarter = std::countr_one(skip);
    return quarter == 0   ? CirclePoint{1, 0}
           : quarter == 1 ? CirclePoint{0, 1}
           : quarter == 2 ? CirclePoint{-1, 0}
                          : CirclePoint{0, -1};
}

// A change of sign of one of the polynomials, by the order of its angle in [0, 4).
struct Event {
    double order;
    SignChange change;
};
struct Events {
    static constexpr int kMost = 4 * kMostSignChanges;
    std::array<Event, kMost> all;
    int count = 0;
    int negative_at_0 = 0;  // how many polynomials are
    bool never = false;     // one is negative everywhere

    // A polynomial that never changes its sign adds nothing.
    void add(const TrigPolynomial& f, unsigned skip) {
        std::array<SignChange, kMostSignChanges> roots;
        const int n = sign_changes(f, roots, skip);
        // Before the angle 0 comes, round the circle, the root with the greatest angle.
        double last_order = -1;
        bool positive = true;
        for (int i = 0; i < n; ++i) {
            const double order = circle_order(roots[i].at);
            if (order >= last_order) {
                last_order = order;
                positive = roots[i].rising;
            }
            int k = count++;
            for (; k > 0 && order < all[k - 1].order; --k) {
                all[k] = all[k - 1];
            }
            all[k] = {order, roots[i]};
        }
        negative_at_0 += !positive;
        never = never || (n == 0 && f.at(somewhere(skip)) < 0);
    }
};

}  // namespace

void append_arcs(const SwivelConstraints& limits, int family, SwivelIntervals& out) {
    if (limits.never) {
        return;
    }
    // Where a limit of degree one forbids a whole quarter of the circle, the others need not be
    // solved.
    unsigned skip = 0;
    for (int i = 0; i < limits.count; ++i) {
        if (limits.f[i].c2 == 0 && limits.f[i].s2 == 0) {
            skip |= limits.f[i].negative_quarters();
        }
    }
    if (skip == 0xf) {
        return;
    }
    Events events;
    for (int i = 0; i < limits.count; ++i) {
        events.add(limits.f[i], skip);
        if (events.never) {
            return;
        }
    }
    const auto append = [&](const Arc& arc) {
        if (out.count < SwivelIntervals::kMost) {
            out.intervals[out.count++] = {family, arc};
        }
    };
    if (events.count == 0) {
        append({.full = true});
        return;
    }
    // Once round the circle: inside where no polynomial is negative. An arc that is open at the end
    // began before the angle 0.
    int negative = events.negative_at_0;
    const Event* from = nullptr;
    const Event* to_of_first = nullptr;
    const bool begins_inside = negative <= 0;
    bool inside = begins_inside;
    for (int i = 0; i < events.count; ++i) {
        const Event& event = events.all[i];
        negative += event.change.rising ? -1 : 1;
        const bool now = negative <= 0;
        if (now && !inside) {
            from = &event;
        } else if (!now && inside) {
            if (from != nullptr) {
                // Ends that are one to double precision must not, by rounding, pass each other.
                const bool point = event.order - from->order < 1e-14;
                append({from->change.at, point ? from->change.at : event.change.at});
            } else {
                to_of_first = &event;
            }
        }
        inside = now;
    }
    if (begins_inside) {
        if (to_of_first == nullptr) {
            append({.full = true});
        } else if (from != nullptr && inside) {
            append({from->change.at, to_of_first->change.at});
        }
    }
}

void append_touching(const SwivelConstraints& limits, int family, SwivelIntervals& out) {
    for (int i = 0; i < limits.count; ++i) {
        for (const TrigPolynomial& f : {limits.f[i], limits.f[i].derivative()}) {
            std::array<SignChange, kMostSignChanges> roots;
            const int n = sign_changes(f, roots);
            for (int k = 0; k < n; ++k) {
                const CirclePoint at = roots[k].at;
                if (limits.allow(at) && out.count < SwivelIntervals::kMost) {
                    out.intervals[out.count++] = {family, {at, at}};
                }
            }
        }
    }
}

namespace {

// Whether `end_follows` says all of it: the hand's axis is the twist axis of the end joint's limit,
// and the tip is on it.
bool follows_exactly(const LimbShape& shape, const LimbGoal& goal) {
    const Vec3 axis = normalized(goal.axis_end);
    return length(cross(axis, goal.tip_end)) < 1e-12 &&
           (shape.end_limit.kind != figure::LimitKind::kCone ||
            length(cross(axis, shape.end_limit.axis_joint)) < 1e-9);
}

// Other axes: of this many rolls of the hand about it the one with the longest arcs; for each roll
// the rotation is given and the arcs are exact.
constexpr int kRolls = 48;

double all_arcs(const SwivelIntervals& s) {
    double sum = 0;
    for (int i = 0; i < s.count; ++i) {
        sum += length_rad(s.intervals[i].arc);
    }
    return sum;
}

}  // namespace

void LimbIk::intervals(const LimbGoal& goal, SwivelIntervals& out) const {
    if (goal.kind == LimbGoalKind::kDirection && !follows_exactly(shape_, goal)) {
        const Vec3 direction = normalized(goal.direction_parent);
        const Quat first = shortest_arc(normalized(goal.axis_end), direction, {0, 1, 0});
        double best = -1;
        SwivelIntervals found;
        for (int i = 0; i < kRolls; ++i) {
            LimbGoal fixed = goal;
            fixed.kind = LimbGoalKind::kPose;
            fixed.rotation_parent =
                normalized(from_axis_angle(direction, 2 * kPi * i / kRolls) * first);
            intervals(fixed, found);
            const double arcs = found.count > 0 ? all_arcs(found) : -1;
            if (arcs > best || i == 0) {
                best = arcs;
                out = found;
            }
        }
        return;
    }
    out.count = 0;
    out.family_count = families(goal, out.families);
    std::array<SwivelConstraints, kMaxLimbFamilies> limits;
    for (int i = 0; i < out.family_count; ++i) {
        limits[i].add_start(tables_.start, out.families[i]);
        limits[i].add_end(tables_.end, out.families[i]);
        append_arcs(limits[i], i, out);
    }
    for (int i = 0; out.count == 0 && i < out.family_count; ++i) {
        append_touching(limits[i], i, out);
    }
}

}  // namespace puppetri::motion
