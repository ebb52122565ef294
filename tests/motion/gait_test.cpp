// SPDX-License-Identifier: MIT
#include "puppetri/motion/gait.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstdint>
#include <string>

#include "chain.h"
#include "puppetri/figure/humanoid.h"
#include "puppetri/math/rotation.h"
#include "puppetri/motion/turn.h"

using namespace puppetri;
using namespace puppetri::motion;
using namespace puppetri::test;

namespace {

struct Walk {
    double height_m = 1.75, stroke_m = 0.6, n_s = 20.0 / 24, duty = 0.62;
    int steps = 3;
};

// The net of scene 2 by hand: P2, then P4 and P6 in turn, then P7 or P8.
Chain walked(const figure::Figure& f, const Walk& w) {
    Chain chain(f, standing(f, {}, 0));
    auto step = [&](Side transfer, StepKind kind) {
        const StepSpec spec{transfer, kind, w.stroke_m, w.n_s, w.duty, kAllLimbs};
        chain.run({make_step(chain.context(), spec)}, step_duration_s(spec));
    };
    Side side = Side::kRight;
    step(side, StepKind::kFirstHalf);
    for (int k = 1; k < w.steps; ++k) {
        step(side = other(side), StepKind::kWhole);
    }
    // Steady: all but the half steps and the first whole one.
    chain.steady_begin_s = 1.5 * w.n_s;
    chain.steady_end_s = (w.steps - 0.5) * w.n_s;
    step(other(side), StepKind::kLastHalf);
    return chain;
}

}  // namespace

TEST_CASE("the walk keeps every figure of good motion, at all heights and step counts [law]") {
    std::vector<Walk> walks;
    for (const double height : {1.5, 1.6, 1.75, 1.9}) {
        for (const int steps : {1, 2, 3, 4, 6}) {
            walks.push_back({.height_m = height, .steps = steps});
        }
    }
    // Quick short steps, no double support, a long one, slow: as the examples have them.
    for (const int steps : {1, 2, 4, 6}) {
        walks.push_back({.stroke_m = 0.5, .n_s = 16.0 / 24, .steps = std::max(steps, 2)});
        walks.push_back({.duty = 0.5, .steps = steps});
        walks.push_back({.duty = 0.75, .steps = steps});
        walks.push_back({.n_s = 28.0 / 24, .steps = steps});
    }
    for (const Walk& w : walks) {
        const figure::Figure f = figure::make_mannequin(w.height_m);
        const Chain chain = walked(f, w);
        const Measures m = chain.measured();
        CAPTURE(w.height_m);
        CAPTURE(w.stroke_m);
        CAPTURE(w.n_s);
        CAPTURE(w.duty);
        CAPTURE(w.steps);
        INFO(report(m));
        CHECK(chain.now_s() == doctest::Approx(w.steps * w.n_s));
        CHECK(m.slip_mm.value < 1);
        CHECK(m.sink_mm.value < 2);
        CHECK(m.hover_mm.value < 2);
        CHECK(m.swing_sink_mm.value < 2);
        CHECK(m.knee_stance_deg.value <= 25);
        CHECK(m.pelvis_acceleration.value <= 4.0);
        CHECK(m.pelvis_steady.value <= 2.5);
        CHECK(m.sway_mm >= 20);
        CHECK(m.sway_mm <= 50);
        CHECK(m.knee.speed_rad_s.value <= 10);
        CHECK(m.hip.speed_rad_s.value <= 6);
        CHECK(m.ankle.speed_rad_s.value <= 8);
        CHECK(m.spine.speed_rad_s.value <= 3);
        for (const JointMeasures* j : {&m.knee, &m.hip, &m.ankle, &m.spine, &m.neck, &m.arm}) {
            CHECK(j->acceleration_rad_s2.value <= 400);
        }
        CHECK(m.join_acceleration_ratio.value <= 1.5);
        CHECK(m.join_position_m.value <= 1e-6);
        CHECK(m.join_pelvis_m_s.value <= 0.05);
        CHECK(m.join_hand_m_s.value <= 0.2);
        CHECK(m.join_foot_m_s.value <= 0.2);
        CHECK(m.limit_excess_deg.value <= 1e-4);
        REQUIRE(m.steps.size() == static_cast<std::size_t>(w.steps + 1));
        for (std::size_t k = 0; k < m.steps.size(); ++k) {
            const test::Step& s = m.steps[k];
            CAPTURE(s.begin_s);
            CHECK(s.knee_deg >= 50);
            CHECK(s.knee_deg <= 70);
            CHECK(s.clearance_mm >= 10);
            CHECK(s.highest_mm <= 60);
            // From one whole step's middle to the next one's.
            if (k > 0 && k + 2 < m.steps.size()) {
                CHECK(s.pelvis_rise_mm >= 20);
                CHECK(s.pelvis_rise_mm <= 60);
            }
        }
    }
}

TEST_CASE("a walk whose next step is late comes to rest, and goes on, within the table [law]") {
    for (const double height : {1.5, 1.6, 1.75, 1.9}) {
        for (const double pause_s : {0.05, 0.2, 0.6, 2.0}) {
            const figure::Figure f = figure::make_mannequin(height);
            Chain chain(f, standing(f, {}, 0));
            Side side = Side::kRight;
            for (const StepKind kind :
                 {StepKind::kFirstHalf, StepKind::kWhole, StepKind::kWhole, StepKind::kLastHalf}) {
                // A stroke that suits the legs; long ones for short legs stop up to twice as hard.
                const StepSpec spec{
                    .transfer = side, .kind = kind, .stroke_m = 0.6 * std::fmin(1, height / 1.75)};
                chain.run({make_step(chain.context(), spec)}, step_duration_s(spec) + pause_s);
                side = other(side);
            }
            const Measures m = chain.measured();
            CAPTURE(height);
            CAPTURE(pause_s);
            INFO(report(m));
            CHECK(m.slip_mm.value < 1);
            CHECK(m.sink_mm.value < 2);
            CHECK(m.hover_mm.value < 2);
            CHECK(m.swing_sink_mm.value < 2);
            CHECK(m.pelvis_acceleration.value <= 4.0);
            CHECK(m.knee.speed_rad_s.value <= 10);
            CHECK(m.hip.speed_rad_s.value <= 6);
            CHECK(m.ankle.speed_rad_s.value <= 8);
            for (const JointMeasures* j : {&m.knee, &m.hip, &m.ankle, &m.spine, &m.neck, &m.arm}) {
                CHECK(j->acceleration_rad_s2.value <= 400);
            }
            CHECK(m.join_acceleration_ratio.value <= 1.5);
            CHECK(m.join_position_m.value <= 1e-6);
            CHECK(m.join_pelvis_m_s.value <= 0.05);
            CHECK(m.limit_excess_deg.value <= 1e-4);
        }
    }
}

TEST_CASE("feet are planted for the duty factor's part of the period, to a frame [oracle]") {
    const figure::Figure f = figure::make_mannequin(1.75);
    const Walk w{.steps = 5};
    const Chain chain = walked(f, w);
    const double frame = 1.0 / 24, n = w.n_s;
    int whole = 0;
    for (const Planted& p : chain.planted()) {
        if (p.begin_s > 1.1 * n && p.end_s < 3.9 * n) {  // plantings between whole steps
            CHECK(std::fabs(p.end_s - p.begin_s - w.duty * 2 * n) <= frame);
            ++whole;
        }
    }
    CHECK(whole >= 1);
    // What geometry sees agrees with what the phases say.
    const Measures m = chain.measured();
    for (const Planted& p : chain.planted()) {
        const bool seen = std::any_of(m.detected.begin(), m.detected.end(), [&](const Planted& d) {
            return d.side == p.side && std::fabs(d.begin_s - p.begin_s) <= frame &&
                   std::fabs(d.end_s - p.end_s) <= frame;
        });
        CAPTURE(p.begin_s);
        CHECK(seen);
    }
}

TEST_CASE(
    "the body follows the formula: strokes x/2, x, ..., x/2, at most 0.1 m off at every border "
    "[oracle]") {
    const figure::Figure f = figure::make_mannequin(1.7);
    for (const int steps : {1, 3, 6}) {
        const Walk w{.height_m = 1.7, .steps = steps};
        const Chain chain = walked(f, w);
        const double start = chain.at(0).pelvis.position_world.z;
        double formula = 0;
        std::size_t k = 0;
        for (const double join : chain.joins()) {
            formula += k++ == 0 ? w.stroke_m / 2 : w.stroke_m;
            CHECK(std::fabs(chain.at(join).pelvis.position_world.z - start - formula) <= 0.1);
        }
        const Controls end = chain.at(chain.now_s());
        CHECK(std::fabs(end.pelvis.position_world.z - start - steps * w.stroke_m) <= 0.01);
        // At rest again, feet together and nobody drifted aside.
        CHECK(end.legs[0].ankle_world.z == doctest::Approx(steps * w.stroke_m).epsilon(1e-9));
        CHECK(end.legs[1].ankle_world.z == doctest::Approx(steps * w.stroke_m).epsilon(1e-9));
        CHECK(end.legs[0].ankle_world.x == doctest::Approx(f.stance_half_width_m).epsilon(1e-9));
        CHECK(end.legs[1].ankle_world.x == doctest::Approx(-f.stance_half_width_m).epsilon(1e-9));
    }
}

TEST_CASE("four single-limb movements side by side are the step [agree]") {
    const figure::Figure f = figure::make_mannequin(1.75);
    Chain one(f, standing(f, {}, 0.4)), four(f, standing(f, {}, 0.4));
    Side side = Side::kRight;
    for (const StepKind kind : {StepKind::kFirstHalf, StepKind::kWhole, StepKind::kLastHalf}) {
        StepSpec spec{.transfer = side, .kind = kind};
        one.run({make_step(one.context(), spec)}, step_duration_s(spec));
        const MotionContext context = four.context();
        std::vector<MovementPtr> parts;
        for (const LimbSet limbs : {support_limbs(side), transfer_limbs(side),
                                    limb_set(Limb::kLeftArm), limb_set(Limb::kRightArm)}) {
            spec.limbs = limbs;
            parts.push_back(make_step(context, spec));
        }
        four.run(std::move(parts), step_duration_s(spec));
        side = other(side);
    }
    for (double t = 0; t <= one.now_s(); t += 0.01) {
        const auto a = one.world(t), b = four.world(t);
        for (std::size_t j = 0; j < a.size(); ++j) {
            CHECK(length(a[j].translation - b[j].translation) < 1e-9);
        }
    }
}

TEST_CASE(
    "walking again starts where the last walk ended, and leads with the same foot or the other "
    "[law]") {
    const figure::Figure f = figure::make_mannequin(1.75);
    Chain chain(f, standing(f, {0.5, 0, 1}, -2));
    for (const Side first : {Side::kRight, Side::kLeft}) {
        Side side = first;
        for (const StepKind kind :
             {StepKind::kFirstHalf, StepKind::kWhole, StepKind::kWhole, StepKind::kLastHalf}) {
            const StepSpec spec{.transfer = side, .kind = kind};
            chain.run({make_step(chain.context(), spec)}, step_duration_s(spec));
            side = other(side);
        }
    }
    const Measures m = chain.measured();
    INFO(report(m));
    CHECK(m.slip_mm.value < 1);
    CHECK(m.hover_mm.value < 2);
    CHECK(m.join_pelvis_m_s.value < 0.05);
    const Controls end = chain.at(chain.now_s());
    const Vec3 middle = (end.legs[0].ankle_world + end.legs[1].ankle_world) * 0.5;
    CHECK(middle.x == doctest::Approx(0.5 + 3.6 * std::sin(-2.0)));
    CHECK(middle.z == doctest::Approx(1 + 3.6 * std::cos(-2.0)));
}

TEST_CASE("other strokes, durations and duty factors walk without slipping [law]") {
    for (const double height : {1.6, 1.8}) {
        const figure::Figure f = figure::make_mannequin(height);
        for (const Walk& w :
             {Walk{height, 0.3, 20.0 / 24, 0.62, 3}, Walk{height, 0.45, 16.0 / 24, 0.62, 3},
              Walk{height, 0.68, 24.0 / 24, 0.62, 3}, Walk{height, 0.6, 20.0 / 24, 0.55, 3},
              Walk{height, 0.6, 24.0 / 24, 0.7, 3}, Walk{height, 0.5, 14.0 / 24, 0.62, 3},
              Walk{height, 0.6, 20.0 / 24, 0.75, 3}, Walk{height, 0.6, 20.0 / 24, 0.5, 3},
              Walk{height, 0.0, 20.0 / 24, 0.62, 3}}) {
            const Chain chain = walked(f, w);
            const Measures m = chain.measured(240);
            CAPTURE(w.stroke_m);
            CAPTURE(w.n_s);
            CAPTURE(w.duty);
            INFO(report(m));
            CHECK(m.slip_mm.value < 1);
            CHECK(m.sink_mm.value < 2);
            CHECK(m.hover_mm.value < 2);
            CHECK(m.limit_excess_deg.value <= 1e-4);
            CHECK(m.join_position_m.value <= 1e-6);
            CHECK(m.join_pelvis_m_s.value <= 0.05);
            CHECK(m.join_foot_m_s.value <= 0.2);
        }
    }
}

TEST_CASE("a step that is not followed comes to a halt and stays [law]") {
    const figure::Figure f = figure::make_mannequin(1.75);
    for (const StepKind kind : {StepKind::kFirstHalf, StepKind::kLastHalf}) {
        Chain chain(f, standing(f, {}, 0));
        const StepSpec spec{.transfer = Side::kRight, .kind = StepKind::kFirstHalf};
        chain.run({make_step(chain.context(), spec)}, step_duration_s(spec));
        if (kind == StepKind::kLastHalf) {
            const StepSpec next{.transfer = Side::kLeft, .kind = kind};
            chain.run({make_step(chain.context(), next)}, 5);
        } else {
            chain.run({}, 3);
        }
        const Measures m = chain.measured(240);
        INFO(report(m));
        CHECK(m.slip_mm.value < 1);
        CHECK(m.hover_mm.value < 2);
        const auto a = chain.world(chain.now_s() - 0.01), b = chain.world(chain.now_s());
        CHECK(length(a[f.hips.value].translation - b[f.hips.value].translation) < 1e-3);
    }
}

TEST_CASE(
    "below a duty factor of 0.5 the figure runs: both feet leave the ground, and the run's figures "
    "hold [law]") {
    for (const double height : {1.6, 1.75, 1.9}) {
        const figure::Figure f = figure::make_mannequin(height);
        const Walk w{height, 0.8, 10.0 / 24, 0.4, 5};
        const Chain chain = walked(f, w);
        const Measures m = chain.measured();
        CAPTURE(height);
        INFO(report(m));
        CHECK(m.slip_mm.value < 1);
        CHECK(m.sink_mm.value < 2);
        CHECK(m.hover_mm.value < 2);
        CHECK(m.swing_sink_mm.value < 2);
        CHECK(m.rise_mm <= 80);
        CHECK(m.knee.speed_rad_s.value <= 18);
        CHECK(m.hip.speed_rad_s.value <= 12);
        CHECK(m.ankle.speed_rad_s.value <= 14);
        CHECK(m.spine.speed_rad_s.value <= 5);
        for (const JointMeasures* j : {&m.knee, &m.hip, &m.ankle, &m.spine, &m.neck, &m.arm}) {
            CHECK(j->acceleration_rad_s2.value <= 1200);
        }
        CHECK(m.join_acceleration_ratio.value <= 1.5);
        CHECK(m.join_position_m.value <= 1e-6);
        CHECK(m.join_pelvis_m_s.value <= 0.05);
        CHECK(m.join_hand_m_s.value <= 0.2);
        CHECK(m.join_foot_m_s.value <= 0.2);
        CHECK(m.limit_excess_deg.value <= 1e-4);
        // In the middle of a border nobody stands; a foot stands for the duty factor's part of the
        // period.
        for (std::size_t k = 0; k + 1 < chain.joins().size(); ++k) {
            for (const Planted& p : chain.planted()) {
                CHECK(!(p.begin_s < chain.joins()[k] && p.end_s > chain.joins()[k]));
            }
        }
        for (const Planted& p : chain.planted()) {
            if (p.begin_s > 0.5 && p.end_s < chain.now_s() - 0.4) {
                CHECK(p.end_s - p.begin_s == doctest::Approx(w.duty * 2 * w.n_s).epsilon(1e-6));
            }
        }
        // While it flies the pelvis falls freely.
        constexpr double h = 1e-3;
        const double t = chain.joins()[2] + 0.01;
        const double a =
            (chain.at(t + h).pelvis.position_world.y - 2 * chain.at(t).pelvis.position_world.y +
             chain.at(t - h).pelvis.position_world.y) /
            (h * h);
        CHECK(a == doctest::Approx(-9.81).epsilon(0.01));
    }
}

TEST_CASE(
    "steps, turns and stands in any order that feet allow, cut anywhere: nothing jumps, no foot "
    "slides [law]") {
    const figure::Figure f = figure::make_mannequin(1.75);
    std::uint32_t state = 5;
    auto next = [&](int n) {
        return static_cast<int>((state = state * 1664525u + 1013904223u) >> 8) % n;
    };
    for (int trial = 0; trial < 80; ++trial) {
        Chain chain(f, standing(f, {}, 0.5 * trial));
        std::string story;
        bool cut = false;
        for (int k = 0; k < 8; ++k) {
            const Controls now = chain.at(chain.now_s());
            const Vec3 ahead = rotate(now.legs[0].foot_rotation_world, {0, 0, 1});
            const double gap = dot(now.legs[0].ankle_world - now.legs[1].ankle_world, ahead);
            const Side behind = std::fabs(gap) < 0.1 ? (next(2) == 0 ? Side::kLeft : Side::kRight)
                                : gap > 0            ? Side::kRight
                                                     : Side::kLeft;
            const int what = cut ? 3 + next(2) : next(5);
            double natural = 0.5;
            MovementPtr movement;
            if (what < 3) {
                const StepKind kind = std::fabs(gap) < 0.1 ? StepKind::kFirstHalf
                                      : next(2) == 0       ? StepKind::kWhole
                                                           : StepKind::kLastHalf;
                const StepSpec spec{.transfer = behind, .kind = kind};
                movement = make_step(chain.context(), spec);
                natural = step_duration_s(spec);
                story += kind == StepKind::kFirstHalf ? "first"
                         : kind == StepKind::kWhole   ? "whole"
                                                      : "last";
            } else if (what == 3) {
                movement = make_turn(
                    chain.context(),
                    {.heading_rad = heading_of(now.pelvis.rotation_world) + 0.3 * (next(9) - 4),
                     .duration_s = cut ? 1.0 : 0.5});
                natural = cut ? 1 : 0.5;
                story += "turn";
            } else {
                movement = make_idle(chain.context(), {});
                natural = 0.8;
                story += "idle";
            }
            cut = what < 3 && next(3) == 0;
            const double part = cut ? 0.1 + 0.1 * next(9) : 1;
            story += (behind == Side::kLeft ? "L" : "R") + std::to_string(part).substr(0, 4) + " ";
            chain.run({std::move(movement)}, natural * part);
        }
        const Measures m = chain.measured(240);
        CAPTURE(story);
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

TEST_CASE(
    "steps cut and begun anew at once, by any leg: feet stay out of the floor and stand still "
    "[law]") {
    const figure::Figure f = figure::make_mannequin(1.75);
    int sunk = 0, slipped = 0;
    constexpr int kTrials = 100;
    for (int trial = 0; trial < kTrials; ++trial) {
        std::uint32_t state = static_cast<std::uint32_t>(trial) * 7919u + 13u;
        auto next = [&](int n) {
            return static_cast<int>((state = state * 1664525u + 1013904223u) >> 8) % n;
        };
        Chain chain(f, standing(f, {}, 0.5 * trial));
        std::string story;
        for (int k = 0; k < 8; ++k) {
            const Controls now = chain.at(chain.now_s());
            const Vec3 ahead = rotate(now.legs[0].foot_rotation_world, {0, 0, 1});
            const double gap = dot(now.legs[0].ankle_world - now.legs[1].ankle_world, ahead);
            // Mostly the hind leg; one time in four whichever.
            const Side side = next(4) == 0 || std::fabs(gap) < 0.1
                                  ? (next(2) == 0 ? Side::kLeft : Side::kRight)
                              : gap > 0 ? Side::kRight
                                        : Side::kLeft;
            const int what = next(6);
            double natural = 0.8;
            MovementPtr movement;
            if (what < 4) {
                const StepKind kind = std::fabs(gap) < 0.1 ? StepKind::kFirstHalf
                                      : next(2) == 0       ? StepKind::kWhole
                                                           : StepKind::kLastHalf;
                const StepSpec spec{.transfer = side, .kind = kind};
                movement = make_step(chain.context(), spec);
                natural = step_duration_s(spec);
            } else if (what == 4) {
                movement = make_turn(
                    chain.context(),
                    {.heading_rad = heading_of(now.pelvis.rotation_world) + 0.3 * (next(9) - 4),
                     .duration_s = 1});
                natural = 1;
            } else {
                movement = make_idle(chain.context(), {});
            }
            const double part = next(2) == 0   ? 1
                                : next(2) == 0 ? 0.02 + 0.03 * next(5)
                                               : 0.1 + 0.1 * next(9);
            story += std::to_string(what) + (side == Side::kLeft ? "L" : "R") +
                     std::to_string(part).substr(0, 4) + " ";
            chain.run({std::move(movement)}, natural * part);
        }
        chain.run({make_idle(chain.context(), {})}, 1);
        const Measures m = chain.measured(240);
        CAPTURE(trial);
        CAPTURE(story);
        INFO(report(m));
        CHECK(m.join_position_m.value < 1e-6);
        CHECK(m.join_pelvis_m_s.value < 0.05);
        CHECK(m.limit_excess_deg.value < 1e-4);
        CHECK(m.hover_mm.value < 8);
        CHECK(m.swing_sink_mm.value < 15);
        CHECK(m.slip_mm.value < 15);
        sunk += m.swing_sink_mm.value > 2;
        slipped += m.slip_mm.value > 1;
    }
    CHECK(sunk <= kTrials * 3 / 100);
    CHECK(slipped <= kTrials * 3 / 100);
}

TEST_CASE(
    "feet half as long as the leg shorten what is too long a stroke, and walk it without a jerk "
    "[law]") {
    // A robot's: legs of 0.5 m, 0.15 m from the middle, ankles near the floor.
    const auto robot = [](double ball_m) {
        figure::HumanoidMeasures measures = figure::mannequin_measures(1.5);
        measures.leg_m = 0.503;
        measures.ankle_height_m = 0.015;
        measures.hips_height_m = 0.52;
        measures.stance_half_width_m = 0.15;
        for (figure::HumanoidMeasures::Leg& leg : measures.legs) {
            leg.hip.x = leg.hip.x > 0 ? 0.15 : -0.15;
            leg.thigh_m = 0.2;
            leg.shank_m = 0.303;
            leg.heel_foot = {0, -0.015, -0.037};
            leg.toes = {0, 0, ball_m};
            leg.ball_foot = {0, -0.015, ball_m};
            leg.toe_tip_foot = {0, -0.015, ball_m + 0.001};
        }
        return figure::make_humanoid(measures);
    };
    for (const double ball_m : {0.18, 0.21, 0.245, 0.272, 0.3}) {
        const figure::Figure f = robot(ball_m);
        const double most_m = longest_stroke_m(f, 0.62);
        CHECK((most_m < 0.62 * f.leg_m) == (ball_m > 0.2));
        if (ball_m < 0.2) {
            continue;
        }
        for (const double n_s : {20.0 / 24, 1.0, 28.0 / 24}) {
            for (const double stroke_m : {0.15, 0.2, 0.24, 0.3, 0.44, 0.8}) {
                const Chain chain = walked(f, {.stroke_m = stroke_m, .n_s = n_s, .steps = 4});
                const Measures m = chain.measured();
                CAPTURE(ball_m);
                CAPTURE(n_s);
                CAPTURE(stroke_m);
                INFO(report(m));
                CHECK(m.slip_mm.value < 1);
                CHECK(m.swing_sink_mm.value < 2);
                CHECK(m.pelvis_acceleration.value <= 4.1);
                CHECK(m.knee.speed_rad_s.value <= 10);
                CHECK(m.hip.speed_rad_s.value <= 6.5);
                CHECK(m.knee.acceleration_rad_s2.value <= 400);
                CHECK(m.hip.acceleration_rad_s2.value <= 400);
                CHECK(m.ankle.acceleration_rad_s2.value <= 400);
                for (const Step& step : m.steps) {
                    CHECK(step.knee_deg <= 70);
                    CHECK(step.clearance_mm >= 10);
                }
            }
        }
    }
    const figure::Figure man = figure::make_mannequin(1.75);
    CHECK(longest_stroke_m(man, 0.62) == doctest::Approx(0.87 * man.leg_m));
}

TEST_CASE("absurd durations, strokes and duty factors give a movement too [hostile]") {
    std::uint32_t state = 9;
    auto next = [&](int n) {
        return static_cast<int>((state = state * 1664525u + 1013904223u) >> 8) % n;
    };
    const double durations[] = {0.0005, 0.01, 0.042, 0.1, 0.3, 1, 7};
    const double strokes[] = {0, 0.001, 0.2, 0.6, 1.5, 40};
    const double duties[] = {0.0, 0.2, 0.35, 0.49, 0.5, 0.51, 0.62, 0.8, 0.95};
    for (const double height : {0.5, 1.1, 1.75, 3.0}) {
        const figure::Figure f = figure::make_mannequin(height);
        figure::Pose pose;
        for (int trial = 0; trial < 150; ++trial) {
            Chain chain(f, standing(f, {}, 0));
            for (int k = 0; k < 4; ++k) {
                const StepSpec spec{.transfer = next(2) == 0 ? Side::kLeft : Side::kRight,
                                    .kind = static_cast<StepKind>(next(3)),
                                    .stroke_m = strokes[next(6)],
                                    .duration_s = durations[next(7)],
                                    .duty_factor = duties[next(9)]};
                const int what = next(8);
                MovementPtr movement =
                    what == 0 ? make_turn(chain.context(spec.duration_s), {.heading_rad = 3.0 * k})
                    : what == 1 ? make_idle(chain.context(spec.duration_s), {})
                                : make_step(chain.context(), spec);
                CHECK(movement->duration.ticks > 0);
                chain.run({std::move(movement)}, step_duration_s(spec));
            }
            for (int i = 0; i <= 20; ++i) {
                const SolveOutcome outcome =
                    solve_controls(f, chain.at(chain.now_s() * i / 20), pose);
                CHECK(std::isfinite(outcome.clamped_rad));
                for (const Transform& t : pose.parent_from_joint) {
                    CHECK(std::isfinite(t.translation.x + t.translation.y + t.translation.z +
                                        t.rotation.w));
                }
            }
        }
    }
}
