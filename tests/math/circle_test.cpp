// SPDX-License-Identifier: MIT
// Points of the circle, arcs, and roots of trigonometric polynomials against dense scans.
#include "puppetri/math/circle.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <vector>

#include "puppetri/base/random.h"
#include "puppetri/math/rotation.h"

using namespace puppetri;

namespace {

double value(const TrigPolynomial& f, double x) {
    return f.c0 + f.c1 * std::cos(x) + f.s1 * std::sin(x) + f.c2 * std::cos(2 * x) +
           f.s2 * std::sin(2 * x);
}

}  // namespace

TEST_CASE("the order of a point grows with its angle [law]") {
    double before = -1;
    for (double x = 0; x < 2 * kPi; x += 1e-3) {
        const double order = circle_order({std::cos(x), std::sin(x)});
        CHECK(order > before);
        before = order;
    }
    CHECK(before < 4);
}

TEST_CASE("arcs know their length, their middle, what they contain and what is nearest [unit]") {
    RandomStream random{3};
    for (int i = 0; i < 5000; ++i) {
        const double from = 2 * kPi * random.uniform(), length = 2 * kPi * random.uniform(),
                     x = 2 * kPi * random.uniform();
        const Arc arc{circle_point(from), circle_point(from + length)};
        CHECK(length_rad(arc) == doctest::Approx(length));
        const double half = turn_between(from, radians_of(middle(arc)));
        CHECK((half < 0 ? half + 2 * kPi : half) == doctest::Approx(length / 2));
        const double way =
            turn_between(from, x) < 0 ? turn_between(from, x) + 2 * kPi : turn_between(from, x);
        CHECK(contains(arc, circle_point(x)) == (way <= length));
        const double at = radians_of(nearest(arc, circle_point(x)));
        const double gap = way <= length ? 0 : std::fmin(way - length, 2 * kPi - way);
        CHECK(std::fabs(turn_between(x, at)) == doctest::Approx(gap));
    }
    const Arc full{.full = true}, point{circle_point(1), circle_point(1)};
    CHECK(length_rad(full) == doctest::Approx(2 * kPi));
    CHECK(contains(full, circle_point(2)));
    CHECK(length_rad(point) == 0);
    CHECK(radians_of(middle(point)) == doctest::Approx(1));
}

TEST_CASE(
    "every change of sign that a scan of 7 200 angles sees is a root, and no other point is "
    "[oracle]") {
    RandomStream random{5};
    const auto number = [&] { return 2 * random.uniform() - 1; };
    int most = 0;
    for (int i = 0; i < 1500; ++i) {
        TrigPolynomial f{number(), number(), number(), number(), number()};
        if (i % 3 == 0) {
            f.c2 = f.s2 = 0;
        } else if (i % 3 == 1) {
            f.c0 *= 0.1;  // often four roots
            f.c1 *= 0.1;
        }
        std::array<SignChange, kMostSignChanges> roots;
        const int count = sign_changes(f, roots);
        most = std::max(most, count);
        std::vector<double> at;
        for (int k = 0; k < count; ++k) {
            CHECK(std::fabs(f.at(roots[k].at)) < 1e-14);
            CHECK(std::fabs(dot(roots[k].at, roots[k].at) - 1) < 1e-15);
            at.push_back(radians_of(roots[k].at));
            CHECK((f.derivative().at(roots[k].at) > 0) == roots[k].rising);
        }
        std::sort(at.begin(), at.end());
        int seen = 0;
        for (int k = 0; k < 7200; ++k) {
            const double x = -kPi + 2 * kPi * k / 7200, y = x + 2 * kPi / 7200;
            if ((value(f, x) < 0) == (value(f, y) < 0)) {
                continue;
            }
            ++seen;
            CHECK(std::any_of(at.begin(), at.end(),
                              [&](double r) { return r >= x - 1e-12 && r <= y + 1e-12; }));
        }
        CHECK(count >= seen);
        CHECK(count % 2 == 0);
        // A pair that the scan steps over is closer than its step.
        CHECK((count == seen || std::adjacent_find(at.begin(), at.end(), [](double a, double b) {
                                    return b - a < 2 * kPi / 7200;
                                }) != at.end()));
    }
    CHECK(most == 4);
}

TEST_CASE("roots that are nearly one, and roots on the borders of the quarters, are found [unit]") {
    std::array<SignChange, kMostSignChanges> roots;
    for (int quarter = 0; quarter < 8; ++quarter) {
        const double a = quarter * kPi / 4;
        for (const double gap : {1e-2, 1e-4, 1e-6}) {
            // (cos x - cos gap) turned by a, times a factor that never vanishes.
            const TrigPolynomial pair{-std::cos(gap), std::cos(a), std::sin(a), 0, 0};
            const TrigPolynomial squared = square(TrigPolynomial{0, 1, 0, 0, 0});
            CHECK(sign_changes(pair, roots) == 2);
            CHECK(std::fabs(std::fabs(turn_between(a, radians_of(roots[0].at))) - gap) <
                  1e-9 / gap * 1e-6);
            // cos^2 (x - a) - cos^2 gap: four roots, two close ones each side.
            TrigPolynomial four{0.5 - std::cos(gap) * std::cos(gap), 0, 0, 0.5 * std::cos(2 * a),
                                0.5 * std::sin(2 * a)};
            CHECK(sign_changes(four, roots) == 4);
            for (int k = 0; k < 4; ++k) {
                CHECK(std::fabs(four.at(roots[k].at)) < 1e-14);
            }
            CHECK(squared.at(circle_point(0.3)) == doctest::Approx(std::cos(0.3) * std::cos(0.3)));
        }
    }
    CHECK(sign_changes(TrigPolynomial{1, 0.5, 0, 0, 0.2}, roots) == 0);
    CHECK(sign_changes(TrigPolynomial{0, 0, 0, 0, 0}, roots) == 0);
}

TEST_CASE("quarters told as negative are so, and nothing else is left out by skipping [oracle]") {
    RandomStream random{11};
    const auto number = [&] { return 2 * random.uniform() - 1; };
    int told = 0;
    for (int i = 0; i < 3000; ++i) {
        const TrigPolynomial line{number(), number(), number(), 0, 0};
        const unsigned negative = line.negative_quarters();
        for (int quarter = 0; quarter < 4; ++quarter) {
            bool all = true;
            for (int k = 0; k <= 900; ++k) {
                all = all && value(line, kPi / 2 * (quarter + k / 900.0 - 0.5)) < 0;
            }
            CHECK((((negative >> quarter) & 1) == 0 || all));
            told += (negative >> quarter) & 1;
        }
        const TrigPolynomial f{number(), number(), number(), number(), number()};
        std::array<SignChange, kMostSignChanges> roots, some;
        const int count = sign_changes(f, roots), found = sign_changes(f, some, negative);
        int rising = 0;
        for (int k = 0; k < found; ++k) {
            rising += some[k].rising ? 1 : -1;
        }
        CHECK(rising == 0);
        for (int k = 0; k < count; ++k) {
            const double quarters = radians_of(roots[k].at) / (kPi / 2) + 0.5;
            const int quarter = static_cast<int>(std::floor(quarters)) & 3;
            if (((negative >> quarter) & 1) == 0) {
                CHECK(std::any_of(some.begin(), some.begin() + found, [&](const SignChange& c) {
                    return c.at == roots[k].at && c.rising == roots[k].rising;
                }));
            }
        }
    }
    CHECK(told > 1000);
}
