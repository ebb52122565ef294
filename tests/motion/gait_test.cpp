// SPDX-License-Identifier: MIT
#include "puppetri/motion/gait.h"

#include <doctest/doctest.h>

#include <algorithm>

#include "chain.h"
#include "draw.h"

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

void draw(const figure::Figure& f, const Chain& chain, const char* name, double dt) {
    const double T = chain.now_s();
    const int n = int(T / dt) + 1, columns = 12, rows = (n + columns - 1) / columns;
    Drawing d(f, 0.9 * columns + 0.3, rows * 2.05 + 0.1, 110);
    for (int i = 0; i < n; ++i) {
        const auto world = chain.world(i * dt);
        const Vec3 hips = world[f.hips.value].translation;
        const double y = 2.0 + 2.05 * (i / columns);
        d.floor(y);
        d.add(world, 0.5 + 0.9 * (i % columns), y, false, {0, 0, hips.z});
    }
    d.save(name);
}

}  // namespace

TEST_CASE("explore walk [skip]" * doctest::skip()) {
    Walk w;
    if (const char* s = std::getenv("H"))
        w.height_m = std::atof(s);
    if (const char* s = std::getenv("X"))
        w.stroke_m = std::atof(s);
    if (const char* s = std::getenv("N"))
        w.n_s = std::atof(s) / 24;
    if (const char* s = std::getenv("D"))
        w.duty = std::atof(s);
    if (const char* s = std::getenv("K"))
        w.steps = std::atoi(s);
    const figure::Figure f = figure::make_mannequin(w.height_m);
    const Chain chain = walked(f, w);
    std::printf("%s", report(chain.measured()).c_str());
    for (const auto& p : chain.planted())
        std::printf("planted %d %.4f %.4f\n", p.side, p.begin_s, p.end_s);
    draw(f, chain, "walk.ppm", 1.0 / 24);
    if (std::getenv("TRACE")) {
        for (double t = 0; t <= chain.now_s() + 1e-9; t += 1.0 / 48) {
            const auto world = chain.world(t);
            const Controls c = chain.at(t);
            const Vec3 p = world[f.hips.value].translation;
            std::printf("%.4f pelvis %.4f %.4f %.4f ", t, p.x, p.y, p.z);
            for (int s = 0; s < 2; ++s) {
                const Quat k = conjugate(world[f.legs[s].hip.value].rotation) *
                               world[f.legs[s].knee.value].rotation;
                std::printf(
                    "| %c knee %5.1f ankle y %.4f z %.4f pitch %6.1f ", "LR"[s],
                    2 * std::atan2(k.x, k.w) * 57.2958, c.legs[s].ankle_world.y,
                    c.legs[s].ankle_world.z,
                    std::asin(rotate(c.legs[s].foot_rotation_world, {0, 0, 1}).y) * 57.2958);
            }
            std::printf("\n");
        }
    }
}
