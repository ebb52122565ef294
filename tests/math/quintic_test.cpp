// SPDX-License-Identifier: MIT
#include "puppetri/math/quintic.h"

#include <doctest/doctest.h>

using namespace puppetri;

TEST_CASE("a quintic piece meets position, velocity and acceleration at both ends [unit]") {
    const Motion1 a{1, -2, 3}, b{-0.5, 4, -7};
    const Quintic q = Quintic::between(a, b, 0.7);
    for (const auto& [t, want] : {std::pair{0.0, a}, std::pair{0.7, b}}) {
        CHECK(q.at(t).position == doctest::Approx(want.position));
        CHECK(q.at(t).velocity == doctest::Approx(want.velocity));
        CHECK(q.at(t).acceleration == doctest::Approx(want.acceleration));
    }
}

TEST_CASE("minimum jerk from rest to rest is the polynomial 10 t^3 - 15 t^4 + 6 t^5 [oracle]") {
    const Curve1 c = minimum_jerk({0, {}}, {}, {1, {1, 0, 0}});
    CHECK(c.at(0.3).position == doctest::Approx(10 * 0.027 - 15 * 0.0081 + 6 * 0.00243));
}

TEST_CASE("minimum jerk through points of one quintic is that quintic [oracle]") {
    auto p = [](double t) {
        return Motion1{1 + t * (2 + t * (-3 + t * (1 + t * (0.5 - t * 0.2)))), 0, 0}.position;
    };
    auto v = [](double t) { return 2 - 6 * t + 3 * t * t + 2 * t * t * t - t * t * t * t; };
    auto a = [](double t) { return -6 + 6 * t + 6 * t * t - 4 * t * t * t; };
    const Curve1 c =
        minimum_jerk({0, {p(0), v(0), a(0)}}, {{0.5, p(0.5)}, {0.8, p(0.8)}, {1.7, p(1.7)}},
                     {2, {p(2), v(2), a(2)}});
    for (double t = 0; t <= 2; t += 0.1) {
        CHECK(c.at(t).position == doctest::Approx(p(t)));
        CHECK(c.at(t).velocity == doctest::Approx(v(t)));
        CHECK(c.at(t).acceleration == doctest::Approx(a(t)));
    }
}

TEST_CASE("a curve holds its ends [unit]") {
    const Curve1 c = minimum_jerk({1, {2, 0, 0}}, {}, {2, {3, 0, 0}});
    CHECK(c.at(0).position == 2);
    CHECK(c.at(5).position == 3);
    CHECK(c.at(5).velocity == 0);
}
