// SPDX-License-Identifier: MIT
#include "puppetri/motion/idle.h"

#include <doctest/doctest.h>

#include "chain.h"

using namespace puppetri;
using namespace puppetri::motion;
using namespace puppetri::test;

TEST_CASE(
    "a standing figure lives: it breathes and shifts its weight, and its feet never move [law]") {
    for (const double height : {1.5, 1.75, 1.9}) {
        const figure::Figure f = figure::make_mannequin(height);
        Chain chain(f, standing(f, {1, 0, 2}, 0.0));
        chain.run({make_idle(chain.context(), {})}, 12);
        const Measures m = chain.measured(120);
        INFO(report(m));
        CHECK(m.slip_mm.value < 0.1);
        CHECK(m.sink_mm.value < 0.1);
        CHECK(m.hover_mm.value < 0.1);
        CHECK(m.limit_excess_deg.value < 1e-4);
        CHECK(m.knee_stance_deg.value < 25);
        CHECK(m.sway_mm > 5);
        CHECK(m.sway_mm < 60);
        CHECK(m.arm.speed_rad_s.value > 1e-3);
        CHECK(m.spine.speed_rad_s.value < 3);
    }
}
