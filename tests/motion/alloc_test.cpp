// SPDX-License-Identifier: MIT
// A counting allocator: after warm-up a pose costs no allocation.
#include <doctest/doctest.h>

#include <chrono>
#include <cstdio>

#include "puppetri/motion/gait.h"
#include "puppetri/motion/idle.h"
#include "puppetri/motion/solve_controls.h"
#include "puppetri/motion/turn.h"
#include "support/count_allocations.h"

using namespace puppetri;
using namespace puppetri::motion;

TEST_CASE("sampling a movement and solving its pose allocate nothing after warm-up [alloc]") {
    const figure::Figure f = figure::make_mannequin(1.75);
    const MotionContext context{
        .figure = f, .now = standing(f, {}, 0), .rate = {}, .at = {}, .seed = 3};
    const MovementPtr movements[] = {make_step(context, {.kind = StepKind::kFirstHalf}),
                                     make_idle(context, {}),
                                     make_turn(context, {.heading_rad = 1})};
    figure::Pose pose;
    Controls controls = context.now;
    solve_controls(f, controls, pose);
    for (const MovementPtr& movement : movements) {
        const auto before = test::allocations();
        for (int i = 0; i < 500; ++i) {
            movement->sample(i * 0.002, controls);
            solve_controls(f, controls, pose);
        }
        CHECK(test::allocations() == before);
    }
}

TEST_CASE("cost of a pose and of preparing a step [skip]" * doctest::skip()) {
    const figure::Figure f = figure::make_mannequin(1.75);
    const MotionContext context{
        .figure = f, .now = standing(f, {}, 0), .rate = {}, .at = {}, .seed = 3};
    const MovementPtr step = make_step(context, {.kind = StepKind::kFirstHalf});
    figure::Pose pose;
    Controls controls = context.now;
    using Clock = std::chrono::steady_clock;
    auto us = [](Clock::time_point a, Clock::time_point b, int n) {
        return std::chrono::duration<double, std::micro>(b - a).count() / n;
    };
    const auto t0 = Clock::now();
    for (int i = 0; i < 20000; ++i)
        step->sample(i * 2e-5, controls);
    const auto t1 = Clock::now();
    for (int i = 0; i < 20000; ++i)
        solve_controls(f, controls, pose);
    const auto t2 = Clock::now();
    for (int i = 0; i < 200; ++i)
        make_step(context, {.kind = StepKind::kFirstHalf});
    const auto t3 = Clock::now();
    std::printf("sample %.2f us, solve %.2f us, prepare %.0f us\n", us(t0, t1, 20000),
                us(t1, t2, 20000), us(t2, t3, 200));
}
