// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include "mesh_checks.h"
#include "puppetri/figure/mannequin.h"
#include "puppetri/figure/palette.h"
#include "puppetri/figure/prop_mesh.h"
#include "puppetri/figure/stick_mesh.h"
#include "puppetri/math/rotation.h"

using namespace puppetri;
using namespace puppetri::figure;
using namespace puppetri::test;

TEST_CASE("palettes have names of their own and colours in range [unit]") {
    std::set<std::string_view> names;
    for (const Palette& p : palettes()) {
        CHECK(names.insert(p.name).second);
        CHECK(find_palette(p.name) == &p);
        for (const Colour& c : {p.main, p.second, p.accent, p.skin, p.hair}) {
            for (const float channel : c) {
                CHECK(channel >= 0);
                CHECK(channel <= 1);
            }
        }
    }
    CHECK(find_palette("teal") != nullptr);
    CHECK(find_palette("amber") != nullptr);
    CHECK(find_palette("no such colour") == nullptr);
}

TEST_CASE("sRGB bytes become linear light by the standard's curve [oracle]") {
    for (int byte = 0; byte <= 255; ++byte) {
        const double c = byte / 255.0;
        const double linear = c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
        CHECK(std::fabs(static_cast<double>(linear_from_srgb(byte, 0, 0)[0]) - linear) < 1e-6);
    }
}

TEST_CASE("a ball is closed, round and of the size asked for [oracle]") {
    for (const double diameter : {0.05, 0.22, 1.0}) {
        const Mesh ball = make_ball_mesh(diameter, *find_palette("red"));
        CHECK(closed_manifold(ball));
        CHECK(euler_number(ball) == 2);
        CHECK(parts_cover(ball));
        CHECK(worst_normal_length(ball) < 1e-5);
        CHECK(share_facing_inwards(ball) == 0);
        for (std::size_t v = 0; v < ball.positions.size(); ++v) {
            CHECK(std::fabs(length(vec(ball.positions[v])) - diameter / 2) < 1e-6 * diameter);
            CHECK(dot(vec(ball.positions[v]), vec(ball.normals[v])) > 0.4999 * diameter);
        }
        const double sphere = kPi / 6 * diameter * diameter * diameter;
        CHECK(volume_m3(ball.positions, ball.triangles) > 0.98 * sphere);
        CHECK(ball.joints.empty());
        CHECK(ball.weights.empty());
    }
}

TEST_CASE("a cylinder and a fork are closed and fill their sizes [oracle]") {
    const Mesh disc = make_cylinder_mesh(0.24, 0.02, *find_palette("white"));
    CHECK(parts_cover(disc));
    CHECK(worst_normal_length(disc) < 1e-5);
    CHECK(share_facing_inwards(disc) == 0);
    // A 48-gon loses 0.29 % of the disc, the bevels below 1 %.
    const double volume = volume_m3(disc.positions, disc.triangles);
    CHECK(volume < kPi * 0.12 * 0.12 * 0.02);
    CHECK(volume > 0.98 * kPi * 0.12 * 0.12 * 0.02);
    const Vec3 size{0.026, 0.006, 0.19};
    const Mesh fork = make_fork_mesh(size, *find_palette("white"));
    CHECK(parts_cover(fork));
    CHECK(share_facing_inwards(fork) == 0);
    for (int axis = 0; axis < 3; ++axis) {
        const double half = axis == 0 ? size.x / 2 : axis == 1 ? size.y / 2 : size.z / 2;
        float low = 0, high = 0;
        for (const auto& p : fork.positions) {
            low = std::min(low, p[static_cast<std::size_t>(axis)]);
            high = std::max(high, p[static_cast<std::size_t>(axis)]);
        }
        CHECK(high <= half + 1e-6);
        CHECK(high > 0.97 * half);
        CHECK(low == doctest::Approx(-high).epsilon(0.03));
    }
}

TEST_CASE("a box fills its size but for bevelled edges [oracle]") {
    const Vec3 size{0.4, 0.2, 0.3};
    const Mesh box = make_box_mesh(size, *find_palette("clay"));
    Vec3 low{1e9, 1e9, 1e9}, high{-1e9, -1e9, -1e9};
    for (const auto& p : box.positions) {
        low = {std::min<double>(low.x, p[0]), std::min<double>(low.y, p[1]),
               std::min<double>(low.z, p[2])};
        high = {std::max<double>(high.x, p[0]), std::max<double>(high.y, p[1]),
                std::max<double>(high.z, p[2])};
    }
    CHECK(length(high - low - size) < 1e-6);
    CHECK(length(high + low) < 1e-6);
    CHECK(parts_cover(box));
    CHECK(worst_normal_length(box) < 1e-5);
    CHECK(share_facing_inwards(box) == 0);
    // Twelve bevels of b^2 / 2 each, less what the corners share: between 93 and 100 % of the
    // volume.
    const double volume = volume_m3(box.positions, box.triangles);
    CHECK(volume < size.x * size.y * size.z);
    CHECK(volume > 0.93 * size.x * size.y * size.z);
}

TEST_CASE("grounds look up, lie at height 0 and are as large as asked for [unit]") {
    for (const Mesh& ground : {make_road_mesh(60, 6), make_floor_mesh(10, 8)}) {
        CHECK(parts_cover(ground));
        for (const auto& p : ground.positions) {
            CHECK(p[1] >= 0);
            CHECK(p[1] <= 0.003f);
        }
        for (const auto& t : ground.triangles) {
            const Vec3 a = vec(ground.positions[t[0]]);
            CHECK(cross(vec(ground.positions[t[1]]) - a, vec(ground.positions[t[2]]) - a).y > 0);
        }
    }
    const Mesh road = make_road_mesh(60, 6);
    double longest = 0;
    for (const auto& p : road.positions) {
        longest = std::max(longest, std::fabs(static_cast<double>(p[2])));
    }
    CHECK(longest == 30);
}

TEST_CASE("a stick figure is made of closed pieces, each bound to one joint [law]") {
    for (const double h : {1.2, 1.75, 2.1}) {
        const Figure f = make_mannequin(h);
        const Mesh stick = make_stick_mesh(f.skeleton, *find_palette("coral"));
        CHECK(closed_manifold(stick));
        CHECK(euler_number(stick) == 2 * components(stick));
        CHECK(parts_cover(stick));
        CHECK(worst_normal_length(stick) < 1e-5);
        CHECK(share_facing_inwards(stick) == 0);
        for (std::size_t v = 0; v < stick.positions.size(); ++v) {
            CHECK(stick.weights[v] == std::array<float, 4>{1, 0, 0, 0});
        }
        for (const auto& t : stick.triangles) {
            CHECK(stick.joints[t[0]][0] == stick.joints[t[1]][0]);
            CHECK(stick.joints[t[0]][0] == stick.joints[t[2]][0]);
        }
        double high = 0;
        for (const auto& p : stick.positions) {
            high = std::max(high, static_cast<double>(p[1]));
        }
        CHECK(std::fabs(high - h) < 0.01 * h);
    }
}
