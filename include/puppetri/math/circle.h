// SPDX-License-Identifier: MIT
// Angles as points of the unit circle, and trigonometric polynomials of degree two on it. Solvers
// of limbs live here: their limits are such polynomials of the swivel angle, and no sine is
// computed until somebody asks for radians.
#pragma once
#include <cmath>
#include <span>

namespace puppetri {

// An angle x as (cos x, sin x); unit.
struct CirclePoint {
    double cos = 1, sin = 0;
    bool operator==(const CirclePoint&) const = default;
};
CirclePoint circle_point(double angle_rad);
double radians_of(CirclePoint p);                                // in [-pi, pi]
constexpr CirclePoint operator*(CirclePoint a, CirclePoint b) {  // adds the angles
    return {a.cos * b.cos - a.sin * b.sin, a.sin * b.cos + a.cos * b.sin};
}
constexpr CirclePoint conjugate(CirclePoint a) { return {a.cos, -a.sin}; }
constexpr double dot(CirclePoint a, CirclePoint b) { return a.cos * b.cos + a.sin * b.sin; }
// The point in the direction (c, s); (0, 0) gives the angle 0.
inline CirclePoint circle_direction(double c, double s) {
    const double n = std::sqrt(c * c + s * s);
    return n > 0 ? CirclePoint{c / n, s / n} : CirclePoint{};
}

// Grows with the angle in [0, 2 pi), from 0 to 4: sorts points without an arc tangent, with the
// same precision everywhere.
inline double circle_order(CirclePoint p) {
    const double s = p.sin / (std::fabs(p.cos) + std::fabs(p.sin));
    return p.cos >= 0 ? (s >= 0 ? s : 4 + s) : 2 - s;
}

// The arc from `from` counterclockwise to `to`; equal ends are a single point, unless `full`.
struct Arc {
    CirclePoint from, to;
    bool full = false;
    bool operator==(const Arc&) const = default;
};
bool contains(const Arc& arc, CirclePoint p);
CirclePoint middle(const Arc& arc);
// In [0, 2 pi], 2 pi for the full one; `order` grows with the length, in [0, 4], and is cheap.
double length_rad(const Arc& arc);
double length_order(const Arc& arc);
// The point of the arc that is nearest to p.
CirclePoint nearest(const Arc& arc, CirclePoint p);

// c0 + c1 cos x + s1 sin x + c2 cos 2x + s2 sin 2x.
struct TrigPolynomial {
    double c0 = 0, c1 = 0, s1 = 0, c2 = 0, s2 = 0;
    constexpr double at(CirclePoint p) const {
        // cos 2x = 1 - 2 sin^2 x.
        return c0 + c2 + p.cos * (c1 + 2 * s2 * p.sin) + p.sin * (s1 - 2 * c2 * p.sin);
    }
    constexpr TrigPolynomial derivative() const { return {0, s1, -c1, 2 * s2, -2 * c2}; }
    // Needs degree 1. A bit i for each quarter of the circle, around i pi/2, where f is negative.
    unsigned negative_quarters() const {
        constexpr double k = 0.70710678118654752440;
        const double a = k * (c1 + s1), b = k * (c1 - s1), rest = -c0;
        // At 45, -45, 135 and 225 degrees, and the crest, where it is within the quarter.
        const bool e = a < rest, se = b < rest, ne = -b < rest, ne2 = -a < rest;
        const bool crest = c1 * c1 + s1 * s1 < rest * rest && rest > 0;
        const bool x = std::fabs(c1) >= std::fabs(s1);
        return static_cast<unsigned>(e & se & (crest | !(x & (c1 > 0)))) |
               static_cast<unsigned>(e & ne & (crest | !(!x & (s1 > 0)))) << 1 |
               static_cast<unsigned>(ne & ne2 & (crest | !(x & (c1 < 0)))) << 2 |
               static_cast<unsigned>(se & ne2 & (crest | !(!x & (s1 < 0)))) << 3;
    }
    // An upper bound of |f - c0|.
    double swing() const { return std::sqrt(c1 * c1 + s1 * s1) + std::sqrt(c2 * c2 + s2 * s2); }
};
constexpr TrigPolynomial operator+(TrigPolynomial a, TrigPolynomial b) {
    return {a.c0 + b.c0, a.c1 + b.c1, a.s1 + b.s1, a.c2 + b.c2, a.s2 + b.s2};
}
constexpr TrigPolynomial operator*(TrigPolynomial a, double k) {
    return {a.c0 * k, a.c1 * k, a.s1 * k, a.c2 * k, a.s2 * k};
}
// Needs f of degree 1.
constexpr TrigPolynomial square(TrigPolynomial f) {
    return {f.c0 * f.c0 + 0.5 * (f.c1 * f.c1 + f.s1 * f.s1), 2 * f.c0 * f.c1, 2 * f.c0 * f.s1,
            0.5 * (f.c1 * f.c1 - f.s1 * f.s1), f.c1 * f.s1};
}

// A root where f, along growing angles, goes from negative to positive or back.
struct SignChange {
    CirclePoint at;
    bool rising = false;
};
inline constexpr int kMostSignChanges = 6;  // four, and what rounding may split
// All points where f changes its sign, rising and falling in turn, in the order of their angles
// from -pi/4 on (degree 1: in no order). Roots where f touches zero are not told, or told as two.
// Needs f that is not zero everywhere (then none). `skip` has a bit i for each quarter of the
// circle, that around i pi/2, in which nobody wants to know: a change there is told at some place
// there. Gives   each root to about an ulp over the slope of f there. Cost    degree 1 about 10 ns;
// degree 2 about 0.1 us. No allocation. Source  degree 1: cos(x - p) = k. Degree 2: Bernstein
// coefficients of the quartic in tan(x/2) over
//         each quarter of the circle, their changes of sign (Descartes' rule for Bernstein's basis:
//         Lane and Riesenfeld, BIT 21 (1981) 112-117), and Newton's steps in a bracket.
int sign_changes(const TrigPolynomial& f, std::span<SignChange, kMostSignChanges> roots,
                 unsigned skip = 0);

}  // namespace puppetri
