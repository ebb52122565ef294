// SPDX-License-Identifier: MIT
// The limits of a limb's ball joints as trigonometric polynomials of its swivel.
#pragma once
#include "puppetri/motion/limb_ik.h"

namespace puppetri::motion {

ConeTable cone_table(const figure::JointLimit& limit);

// The turn about a unit axis, as a quaternion.
Quat turn_about(Vec3 axis, CirclePoint angle);

// The rotation within the twist's range that takes `axis_end` to a direction (unit, in the parent's
// space), with the least twist. Exactly so where axis_end is along the limit's axis; otherwise by
// the shortest arc from the centre.
Quat follow_direction(const figure::JointLimit& limit, Vec3 axis_end, Vec3 direction_parent);

// Inside the limits where none of them is negative.
struct SwivelConstraints {
    std::array<TrigPolynomial, 4> f;
    int count = 0;
    // Implied by the others but for single points, which only `allow` could mistake.
    std::array<TrigPolynomial, 2> guards;
    int guard_count = 0;
    bool never = false;  // one is negative everywhere

    void add(const TrigPolynomial& g);
    void add_start(const ConeTable& cone, const LimbFamily& family);
    void add_end(const ConeTable& cone, const LimbFamily& family);
    // With room for rounding.
    bool allow(CirclePoint swivel) const;
};

// Appends the arcs of one family.
void append_arcs(const SwivelConstraints& limits, int family, SwivelIntervals& out);

// For goals out of all limits: the swivels that at least touch them.
void append_touching(const SwivelConstraints& limits, int family, SwivelIntervals& out);

}  // namespace puppetri::motion
