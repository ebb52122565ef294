// SPDX-License-Identifier: MIT
// The ruler for joins against motions whose jumps are known.
#include "puppetri/motion/join.h"

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "puppetri/figure/mannequin.h"
#include "puppetri/math/rotation.h"
#include "puppetri/motion/idle.h"
#include "puppetri/motion/inertialize.h"

using namespace puppetri;
using namespace puppetri::motion;

namespace {

// The rest pose, carried along Z by polynomials that differ on both sides of the join; the left
// elbow turns likewise.
struct Made {
    figure::Figure figure = figure::make_mannequin(1.75);
    double at_s = 0.7;
    double jump_m = 0, jump_m_s = 0, jump_rad_s = 0, acceleration_rad_s2 = 0;
    mutable int samples = 0;

    static void sample(void* context, double t_s, std::span<Transform> world) {
        const Made& m = *static_cast<const Made*>(context);
        ++m.samples;
        const double t = t_s - m.at_s;
        const bool after = t >= 0;
        figure::Pose pose = figure::rest_pose(m.figure.skeleton);
        pose.parent_from_joint[0].translation.z +=
            0.5 * t + 2 * t * t + (after ? m.jump_m + m.jump_m_s * t : 0);
        const double angle = 0.5 * m.acceleration_rad_s2 * t * t + (after ? m.jump_rad_s * t : 0);
        Transform& elbow = pose.parent_from_joint[m.figure.arms[0].elbow.value];
        elbow.rotation = elbow.rotation * about_y(angle);
        figure::to_model_space(m.figure.skeleton, pose, world);
    }
    JoinMeasures measured(const JoinLimits* enough = nullptr) const {
        samples = 0;
        return measure_join({.figure = figure,
                             .sample = sample,
                             .context = const_cast<Made*>(this),
                             .at_s = at_s,
                             .begin_s = 0,
                             .end_s = 2},
                            enough);
    }
};

}  // namespace

TEST_CASE("jumps of position and velocity are measured as they are [oracle]") {
    Made made;
    JoinMeasures m = made.measured();
    CHECK(m.measured);
    CHECK(m.position_m.value < 1e-8);
    CHECK(m.pelvis_m_s.value < 1e-3);
    CHECK(fault_of(m, {}).quantity == nullptr);

    made.jump_m = 0.003;
    m = made.measured();
    CHECK(m.position_m.value == doctest::Approx(0.003).epsilon(1e-4));
    CHECK(fault_of(m, {}).limit == 1e-6);

    made.jump_m = 0;
    made.jump_m_s = 0.3;
    m = made.measured();
    CHECK(m.position_m.value < 1e-8);
    CHECK(m.pelvis_m_s.value == doctest::Approx(0.3).epsilon(1e-3));
    CHECK(m.hand_m_s.value == doctest::Approx(0.3).epsilon(1e-3));
    CHECK(m.foot_m_s.value == doctest::Approx(0.3).epsilon(1e-3));
    const JoinFault fault = fault_of(m, {});
    CHECK(fault.limit == 0.05);
    CHECK(fault.joint == made.figure.hips);
}

TEST_CASE("a jump of angular velocity is an acceleration of one grid step [oracle]") {
    Made made;
    made.acceleration_rad_s2 = 100;
    CHECK(made.measured().acceleration_ratio.value == doctest::Approx(1).epsilon(0.01));
    // 480 Hz: 0.2 rad/s in 1/480 s are 96 rad/s^2 more.
    made.at_s = 336.0 / 480;
    made.jump_rad_s = 0.2;
    const JoinMeasures m = made.measured();
    CHECK(m.acceleration_ratio.value == doctest::Approx(1.96).epsilon(0.02));
    CHECK(m.acceleration_ratio.joint == made.figure.arms[0].elbow);
    CHECK(fault_of(m, {}).limit == 1.5);
    // What is slow all the same is no jerk.
    made.acceleration_rad_s2 = 1;
    made.jump_rad_s = 0.02;
    CHECK(fault_of(made.measured(), {}).quantity == nullptr);
}

TEST_CASE(
    "the short measure judges as the long one, from few samples where a join is good [agree]") {
    int few = 0;
    for (int i = 0; i < 200; ++i) {
        Made made;
        made.at_s = 0.5 + 0.0007 * i;
        made.acceleration_rad_s2 = 40.0 * (i % 7);
        made.jump_rad_s = 0.01 * (i % 11);
        const JoinLimits limits;
        const JoinMeasures whole = made.measured(), quick = made.measured(&limits);
        few += made.samples <= 10 ? 1 : 0;
        const bool bad = whole.acceleration_ratio.value > limits.acceleration_ratio;
        CHECK(bad == (quick.acceleration_ratio.value > limits.acceleration_ratio));
        if (bad) {
            CHECK(quick.acceleration_ratio.value == whole.acceleration_ratio.value);
        }
    }
    CHECK(few > 20);
    CHECK(few < 200);
}

TEST_CASE("elbows and knees that differ across the half turn join the short way [unit]") {
    const figure::Figure f = figure::make_mannequin(1.75);
    ArmControl now = hanging_arm(f, Side::kLeft), own = now;
    now.swivel_rad = 3.1;
    own.swivel_rad = -3.1;
    const double short_way = 2 * kPi - 6.2;
    const InertialArm arm(f, Side::kLeft, now, {}, own, {}, 0.4);
    LegControl now_leg, own_leg;
    now_leg.swivel_rad = 3.1;
    own_leg.swivel_rad = -3.1;
    const InertialLeg leg(now_leg, {}, own_leg, {}, 0.4);
    for (double t = 0; t < 0.5; t += 0.01) {
        ArmControl a = own;
        LegControl l = own_leg;
        arm.apply(t, a);
        leg.apply(t, l);
        CHECK(std::fabs(a.swivel_rad - own.swivel_rad) <= short_way + 1e-9);
        CHECK(std::fabs(l.swivel_rad - own_leg.swivel_rad) <= short_way + 1e-9);
    }
    // So are their rates.
    Controls a, b;
    a.arms[0].swivel_rad = a.legs[0].swivel_rad = 3.14;
    b.arms[0].swivel_rad = b.legs[0].swivel_rad = -3.14;
    const ControlsRate rate = rate_between(a, b, 0.1);
    CHECK(rate.arms[0].swivel_rad_s == doctest::Approx((2 * kPi - 6.28) / 0.1));
    CHECK(rate.legs[0].swivel_rad_s == doctest::Approx((2 * kPi - 6.28) / 0.1));
}

TEST_CASE("a join with nothing on one side is not measured [unit]") {
    Made made;
    made.at_s = 0;
    CHECK_FALSE(made.measured().measured);
    CHECK(fault_of(made.measured(), {}).quantity == nullptr);
}
