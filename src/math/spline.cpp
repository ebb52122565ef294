// SPDX-License-Identifier: MIT
// Segments from their ends and the rates there; easing by solving its time curve.
#include "puppetri/math/spline.h"

namespace puppetri {
namespace {

// The four cubic Hermite polynomials and their slopes.
struct HermiteWeights {
    double a, rate_a, b, rate_b;
};
HermiteWeights weights(double u) {
    const double v = 1 - u;
    return {v * v * (1 + 2 * u), u * v * v, u * u * (3 - 2 * u), -u * u * v};
}
HermiteWeights slopes(double u) {
    const double v = 1 - u;
    return {-6 * u * v, v * (1 - 3 * u), 6 * u * v, u * (3 * u - 2)};
}

// The control vectors of the cumulative Bezier curve
//   q(u) = a exp(w1 B1(u)) exp(w2 B2(u)) exp(w3 B3(u)),
// with B1 = 1 - (1 - u)^3, B2 = 3 u^2 - 2 u^3, B3 = u^3: the outer ones give the rates at the ends,
// the middle one makes the curve arrive at b.
struct Controls3 {
    Vec3 w1, w2, w3;
};
Controls3 controls(Quat a, Vec3 rate_a, Quat b, Vec3 rate_b, double duration_s) {
    const Vec3 w1 = rate_a * (duration_s / 3), w3 = rate_b * (duration_s / 3);
    const Quat middle = conjugate(from_rotation_vector(w1)) * conjugate(a) * b *
                        conjugate(from_rotation_vector(w3));
    return {w1, to_rotation_vector(middle), w3};
}

double bezier(double p1, double p2, double s) {
    const double r = 1 - s;
    return 3 * r * r * s * p1 + 3 * r * s * s * p2 + s * s * s;
}
double bezier_slope(double p1, double p2, double s) {
    const double r = 1 - s;
    return 3 * r * r * p1 + 6 * r * s * (p2 - p1) + 3 * s * s * (1 - p2);
}

// The parameter at which the time curve is at `ratio`. It rises, so that there is one; Newton's
// steps that leave the bracket are replaced by halving it.
double parameter_at(const Easing& e, double ratio) {
    double lo = 0, hi = 1, s = ratio;
    for (int i = 0; i < 64; ++i) {
        const double error = bezier(e.x1, e.x2, s) - ratio;
        if (std::fabs(error) < 1e-15) {
            break;
        }
        (error > 0 ? hi : lo) = s;
        const double slope = bezier_slope(e.x1, e.x2, s);
        const double next = slope > 0 ? s - error / slope : lo;
        s = next > lo && next < hi ? next : (lo + hi) / 2;
    }
    return s;
}

}  // namespace

double hermite(double a, double rate_a, double b, double rate_b, double duration_s, double ratio) {
    const HermiteWeights w = weights(ratio);
    return a * w.a + b * w.b + (rate_a * w.rate_a + rate_b * w.rate_b) * duration_s;
}
Vec3 hermite(Vec3 a, Vec3 rate_a, Vec3 b, Vec3 rate_b, double duration_s, double ratio) {
    const HermiteWeights w = weights(ratio);
    return a * w.a + b * w.b + (rate_a * w.rate_a + rate_b * w.rate_b) * duration_s;
}
Quat hermite(Quat a, Vec3 rate_a, Quat b, Vec3 rate_b, double duration_s, double ratio) {
    const Controls3 c = controls(a, rate_a, b, rate_b, duration_s);
    const double u = ratio, v = 1 - u;
    return normalized(a * from_rotation_vector(c.w1 * (1 - v * v * v)) *
                      from_rotation_vector(c.w2 * (u * u * (3 - 2 * u))) *
                      from_rotation_vector(c.w3 * (u * u * u)));
}

double hermite_rate(double a, double rate_a, double b, double rate_b, double duration_s,
                    double ratio) {
    const HermiteWeights w = slopes(ratio);
    return (a * w.a + b * w.b) / duration_s + rate_a * w.rate_a + rate_b * w.rate_b;
}
Vec3 hermite_rate(Vec3 a, Vec3 rate_a, Vec3 b, Vec3 rate_b, double duration_s, double ratio) {
    const HermiteWeights w = slopes(ratio);
    return (a * w.a + b * w.b) * (1 / duration_s) + rate_a * w.rate_a + rate_b * w.rate_b;
}
// With E_i = exp(w_i B_i), q' = q * W where W = w3 B3' + E3^-1 (w2 B2' + E2^-1 (w1 B1') E2) E3:
// each factor commutes with its own vector, and what stands to its right turns it.
Vec3 hermite_rate(Quat a, Vec3 rate_a, Quat b, Vec3 rate_b, double duration_s, double ratio) {
    const Controls3 c = controls(a, rate_a, b, rate_b, duration_s);
    const double u = ratio, v = 1 - u;
    const Quat e2 = from_rotation_vector(c.w2 * (u * u * (3 - 2 * u)));
    const Quat e3 = from_rotation_vector(c.w3 * (u * u * u));
    const Vec3 inner = c.w2 * (6 * u * v) + rotate(conjugate(e2), c.w1 * (3 * v * v));
    return (c.w3 * (3 * u * u) + rotate(conjugate(e3), inner)) * (1 / duration_s);
}

Vec3 change_between(Quat a, Quat b) { return to_rotation_vector(conjugate(a) * b); }

// The slope of time is 3 ((1 - s)^2 x1 + 2 (1 - s) s (x2 - x1) + s^2 (1 - x2)); such a sum is
// nowhere negative on [0, 1] iff its outer coefficients are not, nor the middle one below minus
// their geometric mean. The slack is for rounding.
bool runs_forward(const Easing& e) {
    const double first = e.x1, last = 1 - e.x2;
    if (!(first >= -1e-9 && last >= -1e-9)) {
        return false;
    }
    return e.x2 - e.x1 >= -std::sqrt(std::fmax(first, 0) * std::fmax(last, 0)) - 1e-9;
}

double ease(const Easing& easing, double ratio) {
    if (ratio <= 0 || ratio >= 1) {
        return ratio <= 0 ? 0 : 1;
    }
    return bezier(easing.y1, easing.y2, parameter_at(easing, ratio));
}

double ease_rate(const Easing& easing, double ratio) {
    const double s = parameter_at(easing, clamp(ratio, 0, 1));
    const double slope = bezier_slope(easing.x1, easing.x2, s);
    return slope > 1e-12 ? bezier_slope(easing.y1, easing.y2, s) / slope : 0;
}

}  // namespace puppetri
