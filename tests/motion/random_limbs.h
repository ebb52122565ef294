// SPDX-License-Identifier: MIT
// Random limbs, poses and limits for the tests of inverse kinematics.
#pragma once
#include "puppetri/base/random.h"
#include "puppetri/math/rotation.h"
#include "puppetri/motion/limb_ik.h"

namespace puppetri::test {

using motion::LimbPose;
using motion::LimbShape;

class LimbSource {
 public:
    explicit LimbSource(std::uint64_t seed) : random_{stream_key(seed, "", "limbs")} {}

    double unit() { return random_.uniform(); }  // (0, 1)
    double between(double lo, double hi) { return lo + (hi - lo) * unit(); }
    Vec3 vector() {  // in the cube [-1, 1]^3
        const double x = between(-1, 1), y = between(-1, 1), z = between(-1, 1);
        return {x, y, z};
    }
    Vec3 direction() {
        for (;;) {
            const Vec3 v = vector();
            if (const double n2 = dot(v, v); n2 > 0.01 && n2 <= 1) {
                return normalized(v);
            }
        }
    }
    Quat rotation() {
        for (;;) {
            const Vec3 v = vector();
            const Quat q{v.x, v.y, v.z, between(-1, 1)};
            if (const double n2 = dot(v, v) + q.w * q.w; n2 > 0.01 && n2 <= 1) {
                return normalized(q);
            }
        }
    }
    CirclePoint circle() { return circle_point(between(-kPi, kPi)); }

    figure::JointLimit cone(bool round = false) {
        const Vec3 axis = direction();
        const Vec3 side = normalized(cross(axis, direction()));
        const double a = between(0.3, 2.5), lo = between(-2.5, 0.5);
        return {.kind = figure::LimitKind::kCone,
                .axis_joint = axis,
                .side_joint = side,
                .parent_from_centre = rotation(),
                .lo_rad = lo,
                .hi_rad = lo + between(0.2, 3.5),
                .swing_side_rad = a,
                .swing_other_rad = round ? a : between(0.3, 2.5)};
    }
    struct Kind {
        bool limits = false, crooked = false;
    };
    // Crooked: bones askew to each other, a hinge that is not across them, rest rotations.
    LimbShape shape(Kind kind) {
        const Vec3 axis = direction(), h = normalized(cross(axis, direction()));
        LimbShape s{.start = vector() * 0.2,
                    .upper = axis * between(0.2, 0.4),
                    .lower = axis * between(0.2, 0.4),
                    .hinge = {.kind = figure::LimitKind::kFree, .axis_joint = h}};
        if (kind.crooked) {
            s.hinge.parent_from_centre = rotation();
            do {
                s.upper = direction() * between(0.2, 0.4);
                s.lower = direction() * between(0.2, 0.4);
            } while (!check(s, "").has_value());
        }
        if (kind.limits) {
            s.hinge.kind = figure::LimitKind::kHinge;
            s.hinge.lo_rad = between(-2.5, 0.5);
            s.hinge.hi_rad = s.hinge.lo_rad + between(0.3, 3);
            s.start_limit = cone(unit() < 0.3);
            s.end_limit = cone(unit() < 0.3);
        }
        return s;
    }
    Quat inside(const figure::JointLimit& limit) {
        if (limit.kind == figure::LimitKind::kCone) {
            return figure::clamp_to_limit(limit, rotation());
        }
        const bool hinge = limit.kind == figure::LimitKind::kHinge;
        return limit.parent_from_centre *
               from_axis_angle(limit.axis_joint,
                               hinge ? between(limit.lo_rad, limit.hi_rad) : between(-kPi, kPi));
    }
    // Within all limits.
    LimbPose pose(const LimbShape& s) {
        const Quat start =
            s.start_limit.kind == figure::LimitKind::kFree ? rotation() : inside(s.start_limit);
        const Quat end =
            s.end_limit.kind == figure::LimitKind::kFree ? rotation() : inside(s.end_limit);
        return {start, inside(s.hinge), end};
    }

 private:
    RandomStream random_;
};

}  // namespace puppetri::test
