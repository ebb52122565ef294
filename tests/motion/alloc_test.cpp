// SPDX-License-Identifier: MIT
// A counting allocator: after warm-up a pose costs no allocation.
#include <doctest/doctest.h>

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
