// SPDX-License-Identifier: MIT
#include "puppetri/math/rotation.h"

#include <doctest/doctest.h>

#include <cstdint>

using namespace puppetri;

namespace {
struct Lcg {
    std::uint32_t state = 7;
    double next() {
        return ((state = state * 1664525u + 1013904223u) >> 8) / double(1 << 24) * 2 - 1;
    }
    Quat rotation() {
        const double x = next(), y = next(), z = next(), w = next();
        return normalized(Quat{x, y, z, w});
    }
};
}  // namespace

TEST_CASE("a rotation vector and back is the same rotation [law]") {
    Lcg random;
    for (int i = 0; i < 1000; ++i) {
        const Quat q = random.rotation();
        CHECK(angle_between(q, from_rotation_vector(to_rotation_vector(q))) < 1e-7);
    }
    CHECK(length(to_rotation_vector(about_x(1e-10)) - Vec3{1e-10, 0, 0}) < 1e-20);
    CHECK(to_rotation_vector(Quat{}) == Vec3{});
}

TEST_CASE(
    "swing times twist is the rotation, and the swing's axis is orthogonal to the twist's [law]") {
    Lcg random;
    const Vec3 axis = normalized(Vec3{1, 2, -0.5});
    for (int i = 0; i < 1000; ++i) {
        const Quat q = random.rotation();
        const SwingTwist st = to_swing_twist(q, axis);
        CHECK(angle_between(q, st.swing * from_axis_angle(axis, st.twist_rad)) < 1e-7);
        CHECK(std::fabs(dot({st.swing.x, st.swing.y, st.swing.z}, axis)) < 1e-9);
        CHECK(std::fabs(st.twist_rad) <= kPi + 1e-12);
    }
    CHECK(to_swing_twist(about_x(kPi), {0, 1, 0}).twist_rad == 0);
}

TEST_CASE("headings are 0 for +Z and a quarter turn for +X [unit]") {
    CHECK(heading_of(Vec3{0, 0, 1}) == 0);
    CHECK(heading_of(Vec3{1, 0, 0}) == doctest::Approx(kPi / 2));
    CHECK(heading_of(about_y(0.3)) == doctest::Approx(0.3));
    CHECK(turn_between(3, -3) == doctest::Approx(2 * kPi - 6));
    CHECK(turn_between(-3, 3) == doctest::Approx(6 - 2 * kPi));
}

TEST_CASE("a basis becomes the rotation that makes it, in all four branches [law]") {
    Lcg random;
    for (int i = 0; i < 1000; ++i) {
        const Quat q = random.rotation();
        const Quat r = from_basis(rotate(q, {1, 0, 0}), rotate(q, {0, 1, 0}), rotate(q, {0, 0, 1}));
        CHECK(angle_between(q, r) < 1e-7);
    }
}

TEST_CASE("the shortest arc carries one direction to the other, also to the opposite one [law]") {
    Lcg random;
    for (int i = 0; i < 1000; ++i) {
        const Vec3 a = rotate(random.rotation(), {1, 0, 0}),
                   b = rotate(random.rotation(), {1, 0, 0});
        CHECK(length(rotate(shortest_arc(a, b, {0, 1, 0}), a) - b) < 1e-12);
        CHECK(length(rotate(shortest_arc(a, -a, {0, 1, 0}), a) + a) < 1e-12);
    }
}

TEST_CASE("slerp moves at constant speed along the shorter arc [law]") {
    const Quat a = about_x(0.2), b = about_y(1.1) * about_x(0.2);
    CHECK(angle_between(a, slerp(a, b, 0.25)) == doctest::Approx(1.1 / 4));
    CHECK(angle_between(b, slerp(a, b, 1)) < 1e-7);
    CHECK(angle_between(a, slerp(a, {-b.x, -b.y, -b.z, -b.w}, 0.5)) == doctest::Approx(0.55));
}
