// SPDX-License-Identifier: MIT
// Roots of trigonometric polynomials. For degree two the circle is cut into four quarters around 0,
// pi/2, pi and 3 pi/2; in each, t = tan(y/2) runs over [-tan(pi/8), tan(pi/8)] and f (1 + t^2)^2 is
// a quartic in t. Its Bernstein coefficients there are a few additions, and the number of their
// sign changes bounds the number of roots (Descartes, for Bernstein's basis: Vincent, Collins):
// none, exactly one, or the interval is halved.
#include "puppetri/math/circle.h"

#include <array>

#include "puppetri/base/elementary.h"
#include "puppetri/math/rotation.h"

namespace puppetri {
namespace {

constexpr double kTau = 0.41421356237309504880;  // tan(pi/8)

using Quartic = std::array<double, 5>;    // by ascending power of t / kTau
using Bernstein = std::array<double, 5>;  // over t / kTau in the interval at hand

double value(const Quartic& a, double s) {
    return a[0] + s * (a[1] + s * (a[2] + s * (a[3] + s * a[4])));
}
double slope(const Quartic& a, double s) {
    return a[1] + s * (2 * a[2] + s * (3 * a[3] + s * (4 * a[4])));
}

// f(y) (1 + t^2)^2 with t = kTau s.
Quartic quartic_of(const TrigPolynomial& f) {
    constexpr double k2 = kTau * kTau;
    return {f.c0 + f.c1 + f.c2, kTau * (2 * f.s1 + 4 * f.s2), k2 * (2 * f.c0 - 6 * f.c2),
            kTau * k2 * (2 * f.s1 - 4 * f.s2), k2 * k2 * (f.c0 - f.c1 + f.c2)};
}

Bernstein bernstein_of(const Quartic& a) {
    const double even0 = a[0] + a[2] + a[4], even1 = a[0] - a[4], even2 = a[0] - a[2] / 3 + a[4];
    const double odd0 = a[1] + a[3], odd1 = (a[1] - a[3]) / 2;
    return {even0 - odd0, even1 - odd1, even2, even1 + odd1, even0 + odd0};
}

int variations(const Bernstein& b) {
    int count = 0;
    for (int i = 0; i < 4; ++i) {
        count += (b[i] >= 0) != (b[i + 1] >= 0);
    }
    return count;
}

// The root between lo and hi, where the values have different signs: Newton's steps, halving where
// one would leave the bracket.
double root_between(const Quartic& a, double lo, double hi, double at_lo, double at_hi) {
    const bool rising = at_hi >= 0;
    double s = lo - at_lo * (hi - lo) / (at_hi - at_lo);
    for (int i = 0; i < 80; ++i) {
        const double y = value(a, s);
        if (y == 0) {
            return s;
        }
        ((y > 0) == rising ? hi : lo) = s;
        double next = s - y / slope(a, s);
        if (!(next > lo && next < hi)) {
            next = 0.5 * (lo + hi);
            if (next <= lo || next >= hi) {
                return s;
            }
        }
        // Newton's error squares: what a step of 1e-9 leaves is beyond the digits.
        if (std::fabs(next - s) < 1e-9) {
            return clamp(next - value(a, next) / slope(a, next), lo, hi);
        }
        s = next;
    }
    return s;
}

class RootsOfQuarter {
 public:
    RootsOfQuarter(const Quartic& a, int quarter, std::span<SignChange, 4> roots, int& count)
        : a_(a), quarter_(quarter), roots_(roots), count_(count) {}

    // `b` belongs to s in [lo, hi].
    void find(const Bernstein& b, double lo, double hi) {
        const int changes = variations(b);
        if (changes == 0) {
            return;
        }
        if (changes == 1) {
            add(root_between(a_, lo, hi, b[0], b[4]), b[4] >= 0);
            return;
        }
        // Two roots that are one to double precision: f touches zero, or almost.
        if (hi - lo < 1e-9) {
            if (changes == 2) {
                add(lo, b[0] < 0);
                add(hi, b[4] >= 0);
            } else {
                add(lo, b[4] >= 0);
            }
            return;
        }
        Bernstein left, right, row = b;
        for (int k = 0; k < 5; ++k) {
            left[k] = row[0];
            right[4 - k] = row[4 - k];
            for (int i = 0; i + k < 4; ++i) {
                row[i] = 0.5 * (row[i] + row[i + 1]);
            }
        }
        const double middle_s = 0.5 * (lo + hi);
        find(left, lo, middle_s);
        find(right, middle_s, hi);
    }

 private:
    void add(double s, bool rising) {
        if (count_ == 4) {
            return;  // rounding has split a touching root
        }
        const double t = kTau * s, k = 1 / (1 + t * t);
        const double c = (1 - t * t) * k, n = 2 * t * k;
        const CirclePoint at = quarter_ == 0   ? CirclePoint{c, n}
                               : quarter_ == 1 ? CirclePoint{-n, c}
                               : quarter_ == 2 ? CirclePoint{-c, -n}
                                               : CirclePoint{n, -c};
        roots_[count_++] = {at, rising};
    }

    const Quartic& a_;
    int quarter_;
    std::span<SignChange, 4> roots_;
    int& count_;
};

}  // namespace

CirclePoint circle_point(double angle_rad) {
    return {puppetri::cos(angle_rad), puppetri::sin(angle_rad)};
}
double radians_of(CirclePoint p) { return puppetri::atan2(p.sin, p.cos); }

namespace {
// Of the arc from a to b, in [0, 4).
double order_between(CirclePoint a, CirclePoint b) {
    const double order = circle_order(b * conjugate(a));
    return order < 4 ? order : 0;
}
}  // namespace

bool contains(const Arc& arc, CirclePoint p) {
    return arc.full || order_between(arc.from, p) <= order_between(arc.from, arc.to);
}

CirclePoint middle(const Arc& arc) {
    if (arc.full) {
        return {-arc.from.cos, -arc.from.sin};
    }
    // Half of the turn x in [0, 2 pi): the direction (sin x, 1 - cos x), or (1 + cos x, sin x)
    // where that keeps more digits.
    const CirclePoint x = arc.to * conjugate(arc.from);
    const CirclePoint half = x.cos <= 0   ? circle_direction(x.sin, 1 - x.cos)
                             : x.sin >= 0 ? circle_direction(1 + x.cos, x.sin)
                                          : circle_direction(-1 - x.cos, -x.sin);
    return arc.from * half;
}

double length_rad(const Arc& arc) {
    if (arc.full) {
        return 2 * kPi;
    }
    const double angle = radians_of(arc.to * conjugate(arc.from));
    return angle < 0 ? angle + 2 * kPi : angle;
}
double length_order(const Arc& arc) { return arc.full ? 4 : order_between(arc.from, arc.to); }

CirclePoint nearest(const Arc& arc, CirclePoint p) {
    return contains(arc, p) ? p : (dot(p, arc.from) >= dot(p, arc.to) ? arc.from : arc.to);
}

int sign_changes(const TrigPolynomial& f, std::span<SignChange, 4> roots) {
    int count = 0;
    if (f.c2 == 0 && f.s2 == 0) {
        const double n = std::sqrt(f.c1 * f.c1 + f.s1 * f.s1);
        if (!(std::fabs(f.c0) < n)) {
            return 0;
        }
        const CirclePoint toward{f.c1 / n, f.s1 / n};
        const CirclePoint off{-f.c0 / n, std::sqrt((n - f.c0) * (n + f.c0)) / n};
        roots[count++] = {toward * conjugate(off), true};
        roots[count++] = {toward * off, false};
        return count;
    }
    TrigPolynomial turned = f;
    for (int quarter = 0; quarter < 4; ++quarter) {
        const Quartic a = quartic_of(turned);
        RootsOfQuarter(a, quarter, roots, count).find(bernstein_of(a), -1, 1);
        turned = {turned.c0, turned.s1, -turned.c1, -turned.c2, -turned.s2};
    }
    return count;
}

}  // namespace puppetri
