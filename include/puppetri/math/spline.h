// SPDX-License-Identifier: MIT
// Curves through keys: one segment from its two ends and the rates there, for numbers, vectors and
// rotations; what the named splines say these rates are; easing. A rate is a change per second. The
// rate of a rotation is its angular velocity in the turning body's own space (rad/s), so that turns
// of the frame in which the body turns change nothing.
#pragma once
#include "puppetri/math/rotation.h"

namespace puppetri {

// A segment as a function of ratio in [0, 1], its duration and the rates at both ends. At 0 and 1
// it has exactly the values and rates given.
// Source  cubic Hermite: the polynomial of degree three. Rotations: the cumulative cubic Bezier
//         curve whose outer control vectors are a third of the end rates; M.-J. Kim, M.-S. Kim and
//         S. Y. Shin, "A general construction scheme for unit quaternion curves with simple high
//         order derivatives", SIGGRAPH 1995, sections 4.1 and 5.1.
double hermite(double a, double rate_a, double b, double rate_b, double duration_s, double ratio);
Vec3 hermite(Vec3 a, Vec3 rate_a, Vec3 b, Vec3 rate_b, double duration_s, double ratio);
Quat hermite(Quat a, Vec3 rate_a, Quat b, Vec3 rate_b, double duration_s, double ratio);

// The rate within such a segment. Of rotations: the angular velocity in the body's own space.
double hermite_rate(double a, double rate_a, double b, double rate_b, double duration_s,
                    double ratio);
Vec3 hermite_rate(Vec3 a, Vec3 rate_a, Vec3 b, Vec3 rate_b, double duration_s, double ratio);
Vec3 hermite_rate(Quat a, Vec3 rate_a, Quat b, Vec3 rate_b, double duration_s, double ratio);

// What takes a to b: the difference, or the body's rotation vector along the shorter arc.
inline double change_between(double a, double b) { return b - a; }
inline Vec3 change_between(Vec3 a, Vec3 b) { return b - a; }
Vec3 change_between(Quat a, Quat b);

// How a curve passes through a key. All zero is the Catmull-Rom spline; tension alone, the cardinal
// splines. Each usually in [-1, 1].
struct KeyShape {
    double tension = 0;     // 1: the curve stops turning at the key (rate 0)
    double continuity = 0;  // other than 0: a corner
    double bias = 0;        // 1: looks back (overshoots), -1: looks ahead
};

// The rates with which a curve arrives at a key and leaves it, from the changes of value and the
// durations of the segments before and after it. With all parameters zero both are
// (before + after) / (before_s + after_s).
// Needs   before_s, after_s > 0.
// Source  D. Kochanek and R. Bartels, "Interpolating splines with local tension, continuity, and
//         bias control", SIGGRAPH 1984, equations 8 and 9 with the correction for unequal spacing
//         of section 4.
template <class Change>
struct KeyRates {
    Change in{}, out{};
};
template <class Change>
constexpr KeyRates<Change> key_rates(const KeyShape& shape, Change before, double before_s,
                                     Change after, double after_s) {
    const double t = 1 - shape.tension, c = shape.continuity, b = shape.bias;
    const double per_s = 1 / (before_s + after_s);
    return {before * (t * (1 - c) * (1 + b) * per_s) + after * (t * (1 + c) * (1 - b) * per_s),
            before * (t * (1 + c) * (1 + b) * per_s) + after * (t * (1 - c) * (1 - b) * per_s)};
}

// A cubic Bezier curve from (0, 0) over (x1, y1) and (x2, y2) to (1, 1): how far the value has come
// (y) when so much of the time is over (x). The defaults ease in and out.
struct Easing {
    double x1 = 0.42, y1 = 0, x2 = 0.58, y2 = 1;
    bool operator==(const Easing&) const = default;
};
// Whether time never runs back along it; so with x1 and x2 in [0, 1], as CSS wants, and a little
// beyond (parts of such curves, stretched to the unit square, need it).
bool runs_forward(const Easing& easing);

// Needs   runs_forward.
// Gives   y with an error of x below 1e-12; ease(0) = 0, ease(1) = 1.
// Source  CSS Easing Functions Level 1, section 2.2; the equation is solved by Newton's method
//         within a bracket.
double ease(const Easing& easing, double ratio);
// The slope dy/dx there; 0 where the curve stands upright.
double ease_rate(const Easing& easing, double ratio);

}  // namespace puppetri
