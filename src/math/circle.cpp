// SPDX-License-Identifier: MIT
// Roots of trigonometric polynomials. For degree two the circle is cut into four quarters around 0,
// pi/2, pi and 3 pi/2; in each, t = tan(y/2) runs over [-tan(pi/8), tan(pi/8)] and f (1 + t^2)^2 is
// a quartic in t. Its Bernstein coefficients there are a few additions, and the number of their
// sign changes bounds the number of roots (Descartes, for Bernstein's basis: Vincent, Collins):
// none, exactly one, or the interval is halved.
#include "puppetri/math/circle.h"

#include <array>
#include <bit>

#include "puppetri/base/elementary.h"
#include "puppetri/math/rotation.h"

namespace puppetri {
namespace {

constexpr double kTau = 0.41421356237309504880;  // tan(pi/8)

using Quartic = std::array<double, 5>;    // by ascending power of t / kTau
using Bernstein = std::array<double, 5>;  // over t / kTau in the interval at hand

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

// How often the signs of the coefficients change; without branches, which nobody could predict.
int variations(const Bernstein& b) {
    unsigned negative = 0;
    for (int i = 0; i < 5; ++i) {
        negative |= static_cast<unsigned>(b[i] < 0) << i;
    }
    return std::popcount((negative ^ (negative >> 1)) & 0xfu);
}

// One of Halley's steps (their error cubes) inside a bracket, which it narrows; to the middle where
// it would leave it. The sums are split so that the processor can do their halves side by side.
struct Bracket {
    double lo, hi, at, step;
    bool rising, near;  // near: a small part of the way to the next root or extremum

    void narrow(const Quartic& a) {
        const double s = at, s2 = s * s;
        const double y = (a[0] + a[1] * s) + s2 * ((a[2] + a[3] * s) + s2 * a[4]);
        const double d = (a[1] + 2 * a[2] * s) + s2 * (3 * a[3] + 4 * a[4] * s);
        const double half_dd = (a[2] + 3 * a[3] * s) + 6 * a[4] * s2;
        const bool above = (y >= 0) == rising;
        hi = above ? s : hi;
        lo = above ? lo : s;
        const double bend = y * half_dd, next = s - y * d / (d * d - bend);
        // Near an extremum a step says nothing.
        const bool good = (next >= lo) & (next <= hi) & (std::fabs(bend) < 0.5 * d * d);
        at = good ? next : 0.5 * (lo + hi);
        step = at - s;
        near = std::fabs(bend) < 1e-4 * d * d;
    }
};

// The root between lo and hi, where the values have different signs.
double root_between(const Quartic& a, double lo, double hi, double at_lo, double at_hi) {
    // What a step of this size leaves, near a root, is beyond the digits.
    const double last = 1e-6 * (hi - lo);
    Bracket b{lo, hi, lo - at_lo * (hi - lo) / (at_hi - at_lo), 0, at_hi >= 0, false};
    // Almost always enough.
    b.narrow(a);
    b.narrow(a);
    b.narrow(a);
    for (int i = 0; i < 80 && !(b.near && std::fabs(b.step) <= last); ++i) {
        b.narrow(a);
    }
    return b.at;
}

class RootsOfQuarter {
 public:
    RootsOfQuarter(const Quartic& a, int quarter, std::span<SignChange, kMostSignChanges> roots,
                   int& count)
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

    void add(double s, bool rising) {
        if (count_ == kMostSignChanges) {
            return;
        }
        const double t = kTau * s, k = 1 / (1 + t * t);
        const double c = (1 - t * t) * k, n = 2 * t * k;
        const CirclePoint at = quarter_ == 0   ? CirclePoint{c, n}
                               : quarter_ == 1 ? CirclePoint{-n, c}
                               : quarter_ == 2 ? CirclePoint{-c, -n}
                                               : CirclePoint{n, -c};
        roots_[count_++] = {at, rising};
    }

 private:
    const Quartic& a_;
    int quarter_;
    std::span<SignChange, kMostSignChanges> roots_;
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

int sign_changes(const TrigPolynomial& f, std::span<SignChange, kMostSignChanges> roots,
                 unsigned skip) {
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
    int first = -1;
    bool first_positive = false, positive = false;
    for (int quarter = 0; quarter < 4; ++quarter) {
        if (((skip >> quarter) & 1) == 0) {
            const Quartic a = quartic_of(turned);
            const Bernstein b = bernstein_of(a);
            RootsOfQuarter here(a, quarter, roots, count);
            // Between quarters f may have changed in a skipped one, or by rounding.
            if (first < 0) {
                first = quarter;
                first_positive = b[0] >= 0;
            } else if (positive != (b[0] >= 0)) {
                here.add(-1, !positive);
            }
            here.find(b, -1, 1);
            positive = b[4] >= 0;
        }
        turned = {turned.c0, turned.s1, -turned.c1, -turned.c2, -turned.s2};
    }
    if (first >= 0 && positive != first_positive) {
        RootsOfQuarter({}, first, roots, count).add(-1, first_positive);
    }
    return count;
}

}  // namespace puppetri
