// SPDX-License-Identifier: MIT
// Segments against polynomials, finite differences and each other; tangents against the formulas of
// the splines that they are named after; easing against bisection.
#include "puppetri/math/spline.h"

#include <doctest/doctest.h>

#include <random>

using namespace puppetri;

namespace {

std::mt19937 g_random(3);
double real(double lo, double hi) {
    return std::uniform_real_distribution<double>(lo, hi)(g_random);
}
Vec3 vector(double size) { return {real(-size, size), real(-size, size), real(-size, size)}; }
Quat rotation() { return from_rotation_vector(vector(1.5)); }

double difference(Quat a, Quat b) { return angle_between(a, b); }

}  // namespace

TEST_CASE("a segment of numbers is the cubic that has its ends and rates [oracle]") {
    for (int round = 0; round < 100; ++round) {
        const double c0 = real(-2, 2), c1 = real(-2, 2), c2 = real(-2, 2), c3 = real(-2, 2);
        const double h = real(0.1, 3);
        const auto cubic = [&](double t) { return c0 + t * (c1 + t * (c2 + t * c3)); };
        const auto slope = [&](double t) { return c1 + t * (2 * c2 + t * 3 * c3); };
        for (const double u : {0.0, 0.2, 0.5, 0.9, 1.0}) {
            CHECK(hermite(cubic(0), slope(0), cubic(h), slope(h), h, u) ==
                  doctest::Approx(cubic(u * h)).epsilon(1e-12).scale(10));
            CHECK(hermite_rate(cubic(0), slope(0), cubic(h), slope(h), h, u) ==
                  doctest::Approx(slope(u * h)).epsilon(1e-12).scale(10));
        }
    }
}

TEST_CASE("a segment of rotations has its ends, its rates, and the rate that it says [law]") {
    for (int round = 0; round < 200; ++round) {
        const Quat a = rotation(), b = a * from_rotation_vector(vector(1.0));
        const Vec3 ra = vector(3), rb = vector(3);
        const double h = real(0.05, 0.6);
        CHECK(difference(hermite(a, ra, b, rb, h, 0), a) < 1e-12);
        CHECK(difference(hermite(a, ra, b, rb, h, 1), b) < 1e-12);
        CHECK(length(hermite_rate(a, ra, b, rb, h, 0) - ra) < 1e-9);
        CHECK(length(hermite_rate(a, ra, b, rb, h, 1) - rb) < 1e-9);
        const double d = 1e-5;
        for (const double u : {0.1, 0.37, 0.5, 0.81}) {
            const Quat before = hermite(a, ra, b, rb, h, u - d);
            const Quat after = hermite(a, ra, b, rb, h, u + d);
            const Vec3 measured = change_between(before, after) * (1 / (2 * d * h));
            CHECK(length(measured - hermite_rate(a, ra, b, rb, h, u)) < 1e-5);
        }
    }
}

TEST_CASE("about one axis rotations move as the numbers of their angles do [oracle]") {
    for (int round = 0; round < 100; ++round) {
        const Vec3 axis = normalized(vector(1));
        const double a = real(-1, 1), b = a + real(-1.2, 1.2), ra = real(-2, 2), rb = real(-2, 2);
        const double h = real(0.1, 0.5);
        for (const double u : {0.0, 0.25, 0.6, 1.0}) {
            const Quat q = hermite(from_axis_angle(axis, a), axis * ra, from_axis_angle(axis, b),
                                   axis * rb, h, u);
            CHECK(difference(q, from_axis_angle(axis, hermite(a, ra, b, rb, h, u))) < 1e-12);
        }
    }
}

TEST_CASE("a turn of the frame turns the curve and changes no rate [law]") {
    for (int round = 0; round < 50; ++round) {
        const Quat a = rotation(), b = rotation(), turn = rotation();
        const Vec3 ra = vector(2), rb = vector(2);
        CHECK(difference(hermite(turn * a, ra, turn * b, rb, 0.4, 0.3),
                         turn * hermite(a, ra, b, rb, 0.4, 0.3)) < 1e-12);
        CHECK(length(change_between(turn * a, turn * b) - change_between(a, b)) < 1e-12);
    }
}

TEST_CASE("rates of keys are those of the named splines [oracle]") {
    for (int round = 0; round < 100; ++round) {
        const double p0 = real(-1, 1), p1 = real(-1, 1), p2 = real(-1, 1);
        const double t = real(-1, 1), c = real(-1, 1), b = real(-1, 1), h = real(0.1, 2);
        // Catmull-Rom: half of the line between the neighbours.
        const KeyRates<double> plain = key_rates<double>({}, p1 - p0, h, p2 - p1, h);
        CHECK(plain.in == doctest::Approx((p2 - p0) / (2 * h)));
        CHECK(plain.out == doctest::Approx((p2 - p0) / (2 * h)));
        // Cardinal: less by the tension.
        const KeyRates<double> tense = key_rates<double>({.tension = t}, p1 - p0, h, p2 - p1, h);
        CHECK(tense.in == doctest::Approx((1 - t) * (p2 - p0) / (2 * h)));
        CHECK(tense.out == doctest::Approx(tense.in));
        // Kochanek and Bartels as printed, at equal spacing: derivatives by the segment's own
        // parameter, that is, times h.
        const KeyRates<double> all = key_rates<double>({t, c, b}, p1 - p0, h, p2 - p1, h);
        const double ds = (1 - t) * (1 - c) * (1 + b) / 2 * (p1 - p0) +
                          (1 - t) * (1 + c) * (1 - b) / 2 * (p2 - p1);
        const double dd = (1 - t) * (1 + c) * (1 + b) / 2 * (p1 - p0) +
                          (1 - t) * (1 - c) * (1 - b) / 2 * (p2 - p1);
        CHECK(all.in * h == doctest::Approx(ds));
        CHECK(all.out * h == doctest::Approx(dd));
        // At unequal spacing the printed correction, 2 N / (N_before + N_after), per own parameter.
        const double g = real(0.1, 2);
        const KeyRates<double> uneven = key_rates<double>({t, c, b}, p1 - p0, h, p2 - p1, g);
        CHECK(uneven.in * h == doctest::Approx(ds * 2 * h / (h + g)));
        CHECK(uneven.out * g == doctest::Approx(dd * 2 * g / (h + g)));
    }
}

TEST_CASE("easing solves its curve, starts at 0, ends at 1 and rises in time [oracle]") {
    CHECK(ease({}, 0) == 0);
    CHECK(ease({}, 1) == 1);
    const auto at = [](double p1, double p2, double s) {
        return 3 * (1 - s) * (1 - s) * s * p1 + 3 * (1 - s) * s * s * p2 + s * s * s;
    };
    std::vector<Easing> curves = {{}, {0, 0, 1, 1}, {1, 0, 0, 1}, {0, 1, 0, 1}, {1, -2, 1, 3}};
    for (int i = 0; i < 100; ++i) {
        curves.push_back({real(0, 1), real(-1, 2), real(0, 1), real(-1, 2)});
    }
    for (const Easing& e : curves) {
        for (int k = 1; k < 20; ++k) {
            const double x = k / 20.0;
            double lo = 0, hi = 1;
            for (int i = 0; i < 200; ++i) {
                (at(e.x1, e.x2, (lo + hi) / 2) < x ? lo : hi) = (lo + hi) / 2;
            }
            const double slack = 1e-9 + 1e-9 * std::fabs(ease_rate(e, x));
            CHECK(std::fabs(ease(e, x) - at(e.y1, e.y2, lo)) < slack + 1e-5 * (e.x1 == 1));
        }
    }
    // Handles on the diagonal change nothing.
    const Easing straight{1.0 / 3, 1.0 / 3, 2.0 / 3, 2.0 / 3};
    CHECK(ease(straight, 0.3) == doctest::Approx(0.3));
    CHECK(ease_rate(straight, 0.3) == doctest::Approx(1));
    for (const double x : {0.1, 0.5, 0.7}) {
        CHECK((ease({}, x + 1e-6) - ease({}, x - 1e-6)) / 2e-6 ==
              doctest::Approx(ease_rate({}, x)).epsilon(1e-6));
    }
}
