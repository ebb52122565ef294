// SPDX-License-Identifier: MIT
#include "puppetri/figure/mannequin_mesh.h"

#include <doctest/doctest.h>

#include <string>

#include "mesh_checks.h"
#include "puppetri/figure/mannequin.h"
#include "puppetri/math/rotation.h"

using namespace puppetri;
using namespace puppetri::figure;
using namespace puppetri::test;

namespace {

struct Body {
    Figure figure;
    Mesh mesh;
};

Body body(double height_m) {
    Figure f = make_mannequin(height_m);
    Mesh m = make_mannequin_mesh(f.skeleton, *find_palette("teal"));
    return {std::move(f), std::move(m)};
}

// Linear blend skinning written down once more, straight from its definition.
std::vector<std::array<float, 3>> skinned(const Body& b, const Pose& pose) {
    const std::size_t n = b.figure.skeleton.joints.size();
    std::vector<Transform> rest(n), now(n);
    to_model_space(b.figure.skeleton, rest_pose(b.figure.skeleton), rest);
    to_model_space(b.figure.skeleton, pose, now);
    std::vector<std::array<float, 3>> out;
    for (std::size_t v = 0; v < b.mesh.positions.size(); ++v) {
        Vec3 sum;
        for (std::size_t k = 0; k < 4; ++k) {
            const std::size_t j = b.mesh.joints[v][k];
            sum = sum + (now[j] * (inverse(rest[j]) * vec(b.mesh.positions[v]))) *
                            static_cast<double>(b.mesh.weights[v][k]);
        }
        out.push_back(
            {static_cast<float>(sum.x), static_cast<float>(sum.y), static_cast<float>(sum.z)});
    }
    return out;
}

}  // namespace

TEST_CASE("a mesh fitted to another height is the mesh made for it [agree]") {
    const Body small = body(1.5), tall = body(1.9);
    const Mesh fitted = fit_mannequin_mesh(small.mesh, 1.9 / 1.5, *find_palette("teal"));
    REQUIRE(fitted.positions.size() == tall.mesh.positions.size());
    // Rounding may turn a diagonal where both are as good.
    REQUIRE(fitted.triangles.size() == tall.mesh.triangles.size());
    std::size_t other = 0;
    for (std::size_t t = 0; t < fitted.triangles.size(); ++t) {
        other += fitted.triangles[t] != tall.mesh.triangles[t];
    }
    CHECK(other < fitted.triangles.size() / 200);
    CHECK(closed_manifold(fitted));
    double worst_m = 0;
    for (std::size_t v = 0; v < fitted.positions.size(); ++v) {
        worst_m =
            std::fmax(worst_m, length(vec(fitted.positions[v]) - vec(tall.mesh.positions[v])));
    }
    CHECK(worst_m < 1e-6);
    const Mesh amber = fit_mannequin_mesh(small.mesh, 1, *find_palette("amber"));
    CHECK(amber.materials[2].base_colour == find_palette("amber")->main);
}

TEST_CASE("the mannequin is one closed surface without handles, at any height [law]") {
    for (const double h : {1.2, 1.5, 1.68, 1.75, 1.9, 2.1}) {
        CAPTURE(h);
        const Body b = body(h);
        CHECK(closed_manifold(b.mesh));
        CHECK(components(b.mesh) == 1);
        CHECK(euler_number(b.mesh) == 2);
        CHECK(parts_cover(b.mesh));
        CHECK(b.mesh.triangles.size() < 14'000);
        CHECK(thinnest_triangle_m(b.mesh) > 5e-5 * h);
        CHECK(worst_normal_length(b.mesh) < 1e-5);
        CHECK(share_facing_inwards(b.mesh) < 2e-4);  // some grains in creases between fingers
    }
}

TEST_CASE("weights are at most four, fall in order and sum to one [law]") {
    const Body b = body(1.75);
    REQUIRE(b.mesh.weights.size() == b.mesh.positions.size());
    for (std::size_t v = 0; v < b.mesh.weights.size(); ++v) {
        const auto& w = b.mesh.weights[v];
        CHECK(std::fabs(w[0] + w[1] + w[2] + w[3] - 1.0f) < 1e-6f);
        for (std::size_t k = 0; k < 4; ++k) {
            CHECK(w[k] >= 0);
            CHECK((k == 0 || w[k] <= w[k - 1]));
            CHECK(b.mesh.joints[v][k] < b.figure.skeleton.joints.size());
        }
    }
}

TEST_CASE("every bone of the mannequin moves some skin, but the root none [unit]") {
    const Body b = body(1.75);
    std::vector<double> moved(b.figure.skeleton.joints.size());
    for (std::size_t v = 0; v < b.mesh.weights.size(); ++v) {
        for (std::size_t k = 0; k < 4; ++k) {
            moved[b.mesh.joints[v][k]] += static_cast<double>(b.mesh.weights[v][k]);
        }
    }
    // Joint 0 stands in unused slots, with weight 0.
    CHECK(moved[b.figure.root.value] == 0);
    for (std::size_t j = 1; j < moved.size(); ++j) {
        CAPTURE(b.figure.skeleton.joints[j].name);
        CHECK(moved[j] > 1);
    }
}

TEST_CASE("the mannequin stands on the floor and is as tall as its skeleton [unit]") {
    for (const double h : {1.2, 1.75, 2.1}) {
        CAPTURE(h);
        const Body b = body(h);
        double low = 1e9, high = -1e9;
        for (const auto& p : b.mesh.positions) {
            low = std::min(low, static_cast<double>(p[1]));
            high = std::max(high, static_cast<double>(p[1]));
        }
        CHECK(std::fabs(low) < 0.002);
        CHECK(std::fabs(high - h) < 0.01 * h);
    }
}

TEST_CASE("soles lie where the legs' contact points are, palms where the hands' are [unit]") {
    const Body b = body(1.75);
    std::vector<Transform> model_from_joint(b.figure.skeleton.joints.size());
    to_model_space(b.figure.skeleton, rest_pose(b.figure.skeleton), model_from_joint);
    for (int side = 0; side < 2; ++side) {
        const Leg& leg = b.figure.legs[static_cast<std::size_t>(side)];
        const Transform& foot = model_from_joint[leg.ankle.value];
        // A shoe is rounded at heel and tip; between them its sole is flat.
        CHECK(distance_to_surface_m(b.mesh, foot * (leg.heel_foot + Vec3{0, 0, 0.035})) < 0.002);
        CHECK(distance_to_surface_m(b.mesh, foot * leg.ball_foot) < 0.002);
        CHECK(distance_to_surface_m(b.mesh, foot * leg.heel_foot) < 0.02);
        CHECK(distance_to_surface_m(b.mesh, foot * leg.toe_tip_foot) < 0.03);
        const Arm& arm = b.figure.arms[static_cast<std::size_t>(side)];
        const Vec3 palm = model_from_joint[arm.hand.value] * arm.hand_from_palm.translation;
        CHECK(distance_to_surface_m(b.mesh, palm) < 0.004);
    }
}

TEST_CASE("left and right are mirror images, weights included [law]") {
    const Body b = body(1.75);
    const auto mirror_joint = [&](std::uint16_t j) {
        std::string name = b.figure.skeleton.joints[j].name;
        if (name.rfind("left", 0) == 0) {
            name = "right" + name.substr(4);
        } else if (name.rfind("right", 0) == 0) {
            name = "left" + name.substr(5);
        }
        return static_cast<std::uint16_t>(b.figure.skeleton.find(name).value);
    };
    // A grid of cells finds the mirrored vertex.
    std::map<std::array<long, 3>, std::vector<std::size_t>> cells;
    const auto cell = [](const std::array<float, 3>& p) {
        return std::array<long, 3>{std::lround(p[0] * 500), std::lround(p[1] * 500),
                                   std::lround(p[2] * 500)};
    };
    for (std::size_t v = 0; v < b.mesh.positions.size(); ++v) {
        cells[cell(b.mesh.positions[v])].push_back(v);
    }
    std::size_t lost = 0;
    for (std::size_t v = 0; v < b.mesh.positions.size(); ++v) {
        const auto& p = b.mesh.positions[v];
        const std::array<float, 3> wanted{-p[0], p[1], p[2]};
        double best = 1e9;
        std::size_t twin = 0;
        const auto c = cell(wanted);
        for (long x = -1; x <= 1; ++x) {
            for (long y = -1; y <= 1; ++y) {
                for (long z = -1; z <= 1; ++z) {
                    for (const std::size_t w : cells[{c[0] + x, c[1] + y, c[2] + z}]) {
                        const double d = length(vec(b.mesh.positions[w]) - vec(wanted));
                        if (d < best) {
                            best = d;
                            twin = w;
                        }
                    }
                }
            }
        }
        if (best > 1e-4) {
            lost += std::fabs(p[0]) > 0.01f
                        ? 1
                        : 0;  // triangles across the middle have no mirror image
            continue;
        }
        for (std::size_t k = 0; k < 4; ++k) {
            if (b.mesh.weights[v][k] > 0.01f) {
                double same = 0;
                for (std::size_t i = 0; i < 4; ++i) {
                    same += b.mesh.joints[twin][i] == mirror_joint(b.mesh.joints[v][k])
                                ? static_cast<double>(b.mesh.weights[twin][i])
                                : 0;
                }
                CHECK(std::fabs(same - static_cast<double>(b.mesh.weights[v][k])) < 0.02);
            }
        }
    }
    CHECK(lost == 0);
}

TEST_CASE("the mannequin's volume is that of a slim adult [oracle]") {
    // A body has about the density of water (985 kg/m3; J. Durnin, J. Womersley 1974). At a body
    // mass index of 20 to 27, clothed, 1.75 m means 61 to 83 kg.
    const Body b = body(1.75);
    const double mass_kg = 985 * volume_m3(b.mesh.positions, b.mesh.triangles);
    CHECK(mass_kg > 20 * 1.75 * 1.75);
    CHECK(mass_kg < 27 * 1.75 * 1.75);
    // It scales as a solid does.
    const double small_kg = 985 * volume_m3(body(1.2).mesh.positions, b.mesh.triangles);
    CHECK(std::fabs(small_kg / mass_kg - std::pow(1.2 / 1.75, 3)) < 1e-3);
}

TEST_CASE("bending keeps the volume of the body [law]") {
    const Body b = body(1.75);
    const double rest = volume_m3(b.mesh.positions, b.mesh.triangles);
    const auto bent = [&](std::initializer_list<std::pair<const char*, Quat>> turns) {
        Pose pose = rest_pose(b.figure.skeleton);
        for (const auto& [name, turn] : turns) {
            auto& joint = pose.parent_from_joint[b.figure.skeleton.find(name).value];
            joint.rotation = turn * joint.rotation;
        }
        return volume_m3(skinned(b, pose), b.mesh.triangles) / rest;
    };
    constexpr double d = kPi / 180;
    CHECK(std::fabs(bent({{"leftUpperArm", about_z(-80 * d)}, {"rightUpperArm", about_z(80 * d)}}) -
                    1) < 0.02);
    CHECK(std::fabs(bent({{"leftUpperLeg", about_x(-30 * d)}, {"rightUpperLeg", about_x(20 * d)}}) -
                    1) < 0.01);
    CHECK(std::fabs(bent({{"leftUpperLeg", about_x(-90 * d)}}) - 1) < 0.04);
    CHECK(std::fabs(bent({{"leftLowerLeg", about_x(70 * d)}}) - 1) < 0.02);
    CHECK(std::fabs(bent({{"leftLowerArm", about_y(-100 * d)}}) - 1) < 0.02);
    CHECK(std::fabs(bent({{"spine", about_x(25 * d)}, {"chest", about_y(20 * d)}}) - 1) < 0.02);
}

TEST_CASE("a turned hand does not wring the wrist [law]") {
    // Half of the hand's turn is given to the twist bone of the forearm, as the solver of controls
    // does.
    const Body b = body(1.75);
    constexpr double d = kPi / 180;
    Pose pose = rest_pose(b.figure.skeleton);
    pose.parent_from_joint[b.figure.skeleton.find("leftHand").value].rotation = about_x(90 * d);
    pose.parent_from_joint[b.figure.skeleton.find("leftLowerArmTwist").value].rotation =
        about_x(45 * d);
    const auto turned = skinned(b, pose);
    // The skin keeps its distance from the forearm's axis, all along it.
    std::vector<Transform> rest(b.figure.skeleton.joints.size());
    to_model_space(b.figure.skeleton, rest_pose(b.figure.skeleton), rest);
    const Vec3 elbow = rest[b.figure.skeleton.find("leftLowerArm").value].translation;
    const Vec3 wrist = rest[b.figure.skeleton.find("leftHand").value].translation;
    double thinned = 1;
    for (std::size_t v = 0; v < turned.size(); ++v) {
        const Vec3 before = vec(b.mesh.positions[v]), after = vec(turned[v]);
        if (before.x > elbow.x + 0.03 && before.x < wrist.x + 0.02) {
            const double r0 = length(Vec3{0, before.y - wrist.y, before.z - wrist.z});
            const double r1 = length(Vec3{0, after.y - wrist.y, after.z - wrist.z});
            thinned = std::min(thinned, r1 / r0);
        }
    }
    CHECK(thinned > 0.85);
}
