// SPDX-License-Identifier: MIT
#include "puppetri/motion/turn.h"

#include <doctest/doctest.h>

#include <cstdlib>

#include "chain.h"
#include "draw.h"
#include "puppetri/math/rotation.h"

using namespace puppetri;
using namespace puppetri::motion;
using namespace puppetri::test;

TEST_CASE("explore turn [skip]" * doctest::skip()) {
    const double angle = std::getenv("A") ? std::atof(std::getenv("A")) : 90;
    const double t = std::getenv("T") ? std::atof(std::getenv("T")) : 0.5;
    const figure::Figure f =
        figure::make_mannequin(std::getenv("H") ? std::atof(std::getenv("H")) : 1.75);
    Chain chain(f, standing(f, {}, 0));
    chain.run({make_idle(chain.context(), {})}, 1);
    chain.run({make_turn(chain.context(t), {.heading_rad = radians(angle)})}, t + 0.2);
    chain.run({make_turn(chain.context(t), {.heading_rad = 0})}, t + 0.2);
    std::printf("%s", report(chain.measured()).c_str());
    const int n = 12;
    Drawing d(f, 0.9 * n + 0.3, 4.2, 110);
    for (int i = 0; i < n; ++i) {
        const auto world = chain.world(1 + i * t / (n - 1));
        d.add(world, 0.5 + 0.9 * i, 2, true, {});
        d.add(world, 0.5 + 0.9 * i, 4.1, false, {});
    }
    d.save("turn.ppm");
}
