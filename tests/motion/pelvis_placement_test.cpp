// SPDX-License-Identifier: MIT
// Where the pelvis goes when a leg is too short: against a cloud of other places, and as what feet
// of a figure keep of it.
#include "puppetri/motion/pelvis_placement.h"

#include <doctest/doctest.h>

#include <cmath>
#include <cstring>

#include "puppetri/math/rotation.h"
#include "puppetri/motion/idle.h"
#include "puppetri/motion/retarget.h"
#include "puppetri/motion/solve_controls.h"
#include "random_limbs.h"

using namespace puppetri;
using namespace puppetri::motion;
using puppetri::test::LimbSource;

namespace {

// By how much that leg is longer than `length_m` with the pelvis there.
double beyond(const PelvisPlacement& p, Vec3 at, std::size_t side, double length_m) {
    const LegReach& leg = p.legs[side];
    return length(at + rotate(p.wanted_world.rotation, leg.hip_pelvis) - leg.ankle_world) -
           length_m;
}

PelvisPlacement over_feet(const Transform& wanted, Vec3 left, Vec3 right, double easy,
                          double longest) {
    return {wanted,
            {LegReach{{0.1, -0.05, 0}, left, easy, longest},
             LegReach{{-0.1, -0.05, 0}, right, easy, longest}}};
}

Vec3 ankle_of(const figure::Figure& f, const figure::Pose& pose, std::size_t side) {
    std::vector<Transform> model(f.skeleton.joints.size());
    figure::to_model_space(f.skeleton, pose, model);
    return model[f.legs[side].ankle.value].translation;
}

// Feet apart by `ahead` and `wide`, flat on the floor, under a pelvis that stays at `height`.
Controls straddling(const figure::Figure& f, double ahead, double wide, double height) {
    Controls c = standing(f, {}, 0);
    c.legs[0].ankle_world = {wide / 2, f.ankle_height_m, ahead / 2};
    c.legs[1].ankle_world = {-wide / 2, f.ankle_height_m, -ahead / 2};
    c.pelvis.position_world = {0, height, 0};
    return c;
}

}  // namespace

TEST_CASE("the pelvis goes to the nearest place from which both feet reach [oracle]") {
    LimbSource random(3);
    int stayed = 0, one = 0, two = 0, apart = 0;
    for (int i = 0; i < 600; ++i) {
        PelvisPlacement p{
            .wanted_world = {about_y(random.between(-3, 3)), Vec3{0, 1, 0} + random.vector() * 0.3},
            .legs = {}};
        const double soft = i % 2 == 0 ? 0.001 : 0.02;
        for (int side = 0; side < 2; ++side) {
            const double longest = random.between(0.75, 0.95);
            p.legs[side] = {.hip_pelvis = {side == 0 ? 0.1 : -0.1, -0.05, 0},
                            .ankle_world = random.vector() * 0.7 + Vec3{0, 0.3, 0},
                            .easy_m = longest - soft,
                            .longest_m = longest};
        }
        const PlacedPelvis placed = place_pelvis(p);
        const Vec3 at = placed.position_world, wanted = p.wanted_world.translation;
        const auto easy = [&](Vec3 place, std::size_t side) {
            return beyond(p, place, side, p.legs[side].easy_m);
        };
        for (std::size_t side = 0; side < 2; ++side) {
            CHECK(std::fmax(0, beyond(p, at, side, p.legs[side].longest_m)) ==
                  doctest::Approx(placed.residual_m[side]).epsilon(1e-6));
        }
        if (easy(wanted, 0) <= 0 && easy(wanted, 1) <= 0) {
            CHECK(at == wanted);
            ++stayed;
            continue;
        }
        if (placed.residual_m[0] > 1e-4 || placed.residual_m[1] > 1e-4) {
            // Feet farther apart than two legs and the hips.
            const Vec3 hips =
                rotate(p.wanted_world.rotation, p.legs[0].hip_pelvis - p.legs[1].hip_pelvis);
            CHECK(length(p.legs[0].ankle_world - p.legs[1].ankle_world - hips) >
                  p.legs[0].longest_m + p.legs[1].longest_m);
            CHECK(std::fabs(placed.residual_m[0] - placed.residual_m[1]) < 1e-4);
            ++apart;
            continue;
        }
        CHECK(placed.residual_m[0] + placed.residual_m[1] < 1e-4);
        (easy(at, 0) > 0 && easy(at, 1) > 0 ? two : one) += 1;
        // No place from which both reach easily is nearer, anywhere in a cloud of others.
        for (int k = 0; k < 400; ++k) {
            const Vec3 other = wanted + random.vector() * length(at - wanted);
            if (length(other - wanted) < length(at - wanted) - 1e-9) {
                CHECK((easy(other, 0) > 0 || easy(other, 1) > 0));
            }
        }
    }
    CHECK(stayed > 20);
    CHECK(one > 50);
    CHECK(two > 50);
    CHECK(apart > 5);
}

TEST_CASE("the place follows what is wanted without a jump or a corner, and never faster [law]") {
    // Down one leg's reach, on where both pull, on where no place is left, and back over the feet.
    constexpr double kEasy = 0.83, kLongest = 0.84, kStep = 2e-5;
    const auto wanted = [](double s) {
        return Vec3{0.9 * std::sin(2.1 * s), 0.8 + 0.25 * std::sin(5 * s), 0.7 * std::sin(3 * s)};
    };
    const auto left = [](double s) { return Vec3{0.3 + 0.5 * std::sin(s), 0.1, 0.2 * s}; };
    const auto right = [](double s) { return Vec3{-0.3, 0.1, -0.2 * std::sin(4 * s)}; };
    const auto at = [&](double s) {
        const PelvisPlacement p = over_feet({{}, wanted(s)}, left(s), right(s), kEasy, kLongest);
        return place_pelvis(p).position_world;
    };
    Vec3 before = at(0), now = at(kStep);
    int pulled = 0;
    double widest = 0;
    for (double s = 2 * kStep; s < 2.5; s += kStep) {
        const Vec3 next = at(s);
        pulled += !(next == wanted(s));
        // A jump would be as large as the step of the goals (1e-5 m and more), and so would a
        // corner be in the second difference. The legs resist over 1 cm: what they bend the way by
        // is below 2 / 1 cm times the square of a step of less than 1e-4 m.
        widest = std::fmax(widest, length(next - now * 2 + before));
        before = now;
        now = next;
    }
    CHECK(pulled > 50'000);
    CHECK(widest < 2e-6);
    // Feet that stay: the place moves no farther than the wanted one.
    LimbSource random(5);
    for (int i = 0; i < 2000; ++i) {
        const Vec3 a = Vec3{0, 1, 0} + random.vector() * 0.5, b = a + random.vector() * 0.1;
        const auto place = [&](Vec3 p) {
            return place_pelvis(over_feet({{}, p}, left(0), right(1), kEasy, kLongest))
                .position_world;
        };
        CHECK(length(place(a) - place(b)) <= length(a - b) * (1 + 1e-9));
    }
}

TEST_CASE("feet stay where they are however far they are apart, until no pelvis reaches [law]") {
    for (const double height : {1.2, 1.75, 1.95}) {
        const figure::Figure f = figure::make_mannequin(height);
        figure::Pose pose, as_wanted;
        double stretched_mm = 0, moved_m = 0;
        int flat = 0;
        for (double u = 0; u <= 1; u += 0.01) {
            // A stride and a straddle, with hips that do not go down by themselves, and bow.
            Controls c = straddling(f, 1.2 * u * f.leg_m, 0.7 * u * f.leg_m,
                                    f.hips_height_m - 0.01 * f.leg_m);
            c.pelvis.rotation_world = about_x(0.6 * u);
            c.pelvis.position_world.z = 0.2 * u * f.leg_m;
            const SolveOutcome outcome = solve_controls(f, c, pose);
            const SolveOutcome wanted = solve_controls(f, c, as_wanted, PelvisRule::kAsWanted);
            CHECK(wanted.pelvis_moved_m == 0);
            for (std::size_t side = 0; side < 2; ++side) {
                // Slip and hover of the table: 1 mm.
                const Vec3 toes_wanted =
                    Transform{c.legs[side].foot_rotation_world, c.legs[side].ankle_world} *
                    f.legs[side].toes_foot;
                std::vector<Transform> model(f.skeleton.joints.size());
                figure::to_model_space(f.skeleton, pose, model);
                // Where an ankle bends no farther the heel rises, by iteration.
                const double most = outcome.clamped_rad == 0 ? 1e-3 : 5e-3;
                CHECK(length(model[f.legs[side].toes.value].translation - toes_wanted) < most);
                flat += outcome.clamped_rad == 0;
                stretched_mm = std::fmax(stretched_mm, 1000 * length(ankle_of(f, as_wanted, side) -
                                                                     c.legs[side].ankle_world));
            }
            moved_m = std::fmax(moved_m, outcome.pelvis_moved_m);
        }
        CHECK(stretched_mm > 100);  // what is mended here
        CHECK(moved_m > 0.1);
        CHECK(flat > 140);
    }
}

TEST_CASE("a pelvis from which both feet reach is not touched, to the bit [law]") {
    LimbSource random(11);
    const figure::Figure f = figure::make_mannequin(1.75);
    figure::Pose placed, given;
    int reached = 0;
    for (int i = 0; i < 500; ++i) {
        Controls c = standing(f, random.vector(), random.between(-3, 3));
        c.pelvis.position_world = c.pelvis.position_world + random.vector() * 0.15;
        bool reaches = true;
        for (std::size_t side = 0; side < 2; ++side) {
            const Vec3 hip =
                c.pelvis.position_world + rotate(c.pelvis.rotation_world, f.legs[side].hip_pelvis);
            reaches = reaches && length(hip - c.legs[side].ankle_world) < 0.999 * f.leg_m;
        }
        const SolveOutcome outcome = solve_controls(f, c, placed);
        solve_controls(f, c, given, PelvisRule::kAsWanted);
        if (reaches) {
            ++reached;
            CHECK(outcome.pelvis_moved_m == 0);
            CHECK(std::memcmp(placed.parent_from_joint.data(), given.parent_from_joint.data(),
                              placed.parent_from_joint.size() * sizeof(Transform)) == 0);
        } else {
            CHECK(outcome.pelvis_moved_m > 0);
        }
    }
    CHECK(reached > 100);
    CHECK(reached < 450);
}
