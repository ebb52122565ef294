// SPDX-License-Identifier: MIT
#include "puppetri/motion/turn.h"

#include <doctest/doctest.h>

#include "chain.h"
#include "puppetri/figure/humanoid.h"
#include "puppetri/math/rotation.h"
#include "puppetri/motion/ball_game.h"
#include "puppetri/motion/gait.h"

using namespace puppetri;
using namespace puppetri::motion;
using namespace puppetri::test;

TEST_CASE(
    "a quarter turn in half a second steps around without sliding, and turning back cancels it "
    "[law]") {
    for (const double height : {1.5, 1.68, 1.75, 1.9}) {
        const figure::Figure f = figure::make_mannequin(height);
        for (const double degrees :
             {90.0, -90.0, 60.0, 25.0, -75.0, 95.0, 104.0, -108.0, 120.0, -124.0}) {
            Chain chain(f, standing(f, {0.3, 0, -1}, 0.4));
            chain.run({make_idle(chain.context(), {})}, 0.7);
            chain.run({make_turn(chain.context(0.5), {.heading_rad = 0.4 + radians(degrees)})},
                      0.5);
            const Controls turned = chain.at(chain.now_s());
            chain.run({make_turn(chain.context(0.5), {.heading_rad = 0.4})}, 1.5);
            const Measures m = chain.measured();
            CAPTURE(height);
            CAPTURE(degrees);
            INFO(report(m));
            CHECK(m.slip_mm.value < 1);
            CHECK(m.sink_mm.value < 2);
            CHECK(m.hover_mm.value < 2);
            CHECK(m.limit_excess_deg.value < 1e-4);
            CHECK(m.knee.speed_rad_s.value <= 10);
            CHECK(m.hip.speed_rad_s.value <= 6);
            CHECK(m.pelvis_acceleration.value <= 4);
            CHECK(m.ankle.speed_rad_s.value <= 8);
            CHECK(m.spine.speed_rad_s.value <= 3);
            for (const JointMeasures* j : {&m.knee, &m.hip, &m.ankle, &m.spine, &m.neck, &m.arm}) {
                CHECK(j->acceleration_rad_s2.value <= 400);
            }
            CHECK(m.join_acceleration_ratio.value <= 1.5);
            CHECK(m.join_position_m.value <= 1e-6);
            CHECK(m.join_pelvis_m_s.value <= 0.05);
            CHECK(m.join_foot_m_s.value <= 0.2);
            for (int i = 0; i < 2; ++i) {
                CHECK(std::fabs(turn_between(heading_of(turned.legs[i].foot_rotation_world),
                                             0.4 + radians(degrees))) < 1e-9);
            }
            const Controls back = chain.at(chain.now_s());
            const Vec3 middle = (back.legs[0].ankle_world + back.legs[1].ankle_world) * 0.5;
            CHECK(std::fabs(middle.x - 0.3) < 1e-9);
            CHECK(std::fabs(middle.z + 1) < 1e-9);
        }
    }
}

TEST_CASE("a half turn takes two pairs of steps and ends facing the other way [unit]") {
    const figure::Figure f = figure::make_mannequin(1.75);
    Chain chain(f, standing(f, {}, 0));
    chain.run({make_idle(chain.context(), {})}, 0.5);
    chain.run(
        {make_turn(chain.context(), {.heading_rad = kPi, .duration_s = turn_duration_s(kPi)})},
        1.5);
    const Measures m = chain.measured();
    INFO(report(m));
    CHECK(m.steps.size() == 4);
    CHECK(m.slip_mm.value < 1);
    CHECK(m.limit_excess_deg.value < 1e-4);
    CHECK(std::fabs(turn_between(heading_of(chain.at(2).pelvis.rotation_world), kPi)) < 0.1);
}

TEST_CASE("a turn by less than three degrees moves no foot [unit]") {
    const figure::Figure f = figure::make_mannequin(1.75);
    const MotionContext context{.figure = f, .now = standing(f, {}, 0), .rate = {}, .at = {}};
    const MovementPtr turn = make_turn(context, {.heading_rad = radians(2)});
    Controls c = context.now;
    for (double t = 0; t < 1; t += 0.05) {
        turn->sample(t, c);
        for (int i = 0; i < 2; ++i) {
            CHECK(length(c.legs[i].ankle_world - context.now.legs[i].ankle_world) < 1e-12);
        }
    }
    CHECK(turn->events.empty());
}

TEST_CASE("the heading to a point is from the middle of the feet [unit]") {
    const figure::Figure f = figure::make_mannequin(1.75);
    CHECK(heading_to(standing(f, {1, 0, 1}, 2), {3, 1, 1}) == doctest::Approx(kPi / 2));
    CHECK(heading_to(standing(f, {1, 0, 1}, 2), {1, 1, 1}) == doctest::Approx(2));
}

TEST_CASE("movements that start in the middle of a step put the feet down and stand [law]") {
    const figure::Figure f = figure::make_mannequin(1.75);
    for (const double cut : {0.05, 0.15, 0.25, 0.38}) {
        for (const bool turns : {false, true}) {
            Chain chain(f, standing(f, {}, 0));
            chain.run({make_step(chain.context(),
                                 {.transfer = Side::kRight, .kind = StepKind::kFirstHalf})},
                      cut);
            if (turns) {
                chain.run({make_turn(chain.context(), {.heading_rad = 1.0, .duration_s = 1.0})}, 2);
            } else {
                chain.run({make_idle(chain.context(), {})}, 2);
            }
            const Measures m = chain.measured();
            CAPTURE(cut);
            CAPTURE(turns);
            INFO(report(m));
            CHECK(m.slip_mm.value < 1);
            CHECK(m.sink_mm.value < 2);
            CHECK(m.hover_mm.value < 2);
            CHECK(m.join_position_m.value < 1e-6);
            CHECK(m.join_pelvis_m_s.value < 0.05);
            CHECK(m.join_foot_m_s.value < 0.2);
            CHECK(m.limit_excess_deg.value < 1e-4);
        }
    }
}

TEST_CASE(
    "legs of 0.6 m with feet of a quarter of a metre turn to a ball that comes, and wait for it, "
    "without a jerk [law]") {
    figure::HumanoidMeasures measures = figure::mannequin_measures(1.7);
    measures.leg_m = 0.606;
    measures.ankle_height_m = 0.096;
    measures.hips_height_m = 0.725;
    for (figure::HumanoidMeasures::Leg& leg : measures.legs) {
        leg.thigh_m = 0.298;
        leg.shank_m = 0.308;
        const double lower = leg.ball_foot.y + 0.096;
        leg.toes.y -= lower;
        leg.heel_foot = {0, -0.096, -0.084};
        leg.ball_foot.y = leg.toe_tip_foot.y = -0.096;
        const double ahead = 0.203 - leg.ball_foot.z;
        leg.ball_foot.z += ahead;
        leg.toes.z += ahead;
        leg.toe_tip_foot.z += ahead;
    }
    const figure::Figure f = figure::make_humanoid(measures);
    for (const double degrees : {90.0, -90.0, 20.0, -20.0}) {
        Chain chain(f, standing(f, {}, 0));
        chain.run({make_idle(chain.context(), {})}, 0.7);
        chain.run({make_ready(chain.context(0.5),
                              {.grip = ball_grip(0.11), .heading_rad = radians(degrees)})
                       .movement},
                  2);
        const Measures m = chain.measured();
        CAPTURE(degrees);
        INFO(report(m));
        CHECK(m.slip_mm.value < 1);
        CHECK(m.sink_mm.value < 2);
        CHECK(m.pelvis_acceleration.value <= 4);
        for (const JointMeasures* j : {&m.knee, &m.hip, &m.ankle, &m.spine, &m.neck, &m.arm}) {
            CHECK(j->acceleration_rad_s2.value <= 400);
        }
    }
}
