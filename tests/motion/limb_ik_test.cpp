// SPDX-License-Identifier: MIT
// The seven-degree limb: goals against forward kinematics on random limbs of any hinge and
// proportion, its singular places, its check.
#include "puppetri/motion/limb_ik.h"

#include <doctest/doctest.h>

#include "puppetri/math/rotation.h"
#include "random_limbs.h"

using namespace puppetri;
using namespace puppetri::motion;
using test::LimbSource;

TEST_CASE("every family of a pose goal meets it exactly, at every swivel, for any limb [law]") {
    LimbSource random(1);
    int two = 0;
    for (int i = 0; i < 4000; ++i) {
        const LimbShape shape = random.shape({.limits = i % 2 == 0, .crooked = i % 3 == 0});
        const LimbIk ik(shape);
        const Transform wanted = parent_from_end(shape, random.pose(shape));
        const Vec3 tip = random.vector() * 0.1;
        const LimbGoal goal{.kind = LimbGoalKind::kPose,
                            .position_parent = wanted * tip,
                            .rotation_parent = wanted.rotation,
                            .tip_end = tip,
                            .swivel_zero_parent = random.vector()};
        std::array<LimbFamily, kMaxLimbFamilies> families;
        const int count = ik.families(goal, families);
        REQUIRE(count > 0);
        two += count == 2;
        for (int f = 0; f < count; ++f) {
            const LimbPose pose = ik.at(families[f], random.circle());
            const Transform hand = parent_from_end(shape, pose);
            CHECK(length(hand * tip - goal.position_parent) < 1e-9);
            CHECK(angle_between(hand.rotation, wanted.rotation) < 1e-9);
            CHECK(families[f].residual_m < 1e-9);
            CHECK(figure::limit_excess_rad(shape.hinge, pose.hinge) < 2e-8);
        }
    }
    CHECK(two > 500);
}
