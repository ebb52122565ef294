// SPDX-License-Identifier: MIT
// A walk that the net cuts at any instant, and the turn that follows, measured at 480 Hz.
#include <doctest/doctest.h>

#include <cmath>
#include <cstdlib>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "puppetri/math/rotation.h"
#include "support/example_motion.h"
#include "support/motion_table.h"

using namespace puppetri;
using test::Example;
using test::Measures;

namespace {

// Who walks five steps is told to face somewhere after `ms` milliseconds.
Example cut_walk(int ms, int degrees, const std::string& height) {
    scene::MemoryFiles files;
    files.add("cut.pup",
              "language 1\nscene \"cut\"\nframes 24 per second, until 7.5 s\n"
              "cast { ana: mannequin { height " +
                  height +
                  " m } }\n"
                  "event noise at " +
                  std::to_string(ms) +
                  " ms\n"
                  "place walks does ana.walk(steps: 5) tokens 1\n"
                  "place turns does ana.face(" +
                  std::to_string(degrees) +
                  " deg)\n"
                  "place rests does ana.idle(9 s)\n"
                  "stop: now walks -> turns on noise\n"
                  "rest: turns -> rests\n");
    auto loaded = scene::load(files, "cut.pup");
    REQUIRE(loaded.has_value());
    Example e;
    e.name = "cut";
    e.scene = std::make_unique<scene::Scene>(std::move(*loaded));
    auto performed = scene::perform(*e.scene);
    REQUIRE(performed.has_value());
    REQUIRE_FALSE(performed->fault.has_value());
    e.performed = std::move(*performed);
    return e;
}

}  // namespace

TEST_CASE(
    "a walk that is cut at any of 40 instants finishes its stride and turns, within the table "
    "[law]") {
    // Without PUPPETRI_LONG one angle for each instant.
    const bool every = std::getenv("PUPPETRI_LONG") != nullptr;
    constexpr int kInstants = 40, kDegrees[] = {90, -130, 20, 170, -60};
    for (int i = 0; i < kInstants; ++i) {
        const int ms = 20 + 104 * i;  // over all six parts of the walk
        for (int k = 0; k < (every ? 5 : 1); ++k) {
            const int degrees = kDegrees[(i + k) % 5];
            const Example e = cut_walk(ms, degrees, i % 2 == 0 ? "1.75" : "1.6");
            const Measures m = test::measured_on_stage(e, 0, 0, e.end_s());
            CAPTURE(ms);
            CAPTURE(degrees);
            INFO(test::report(m));
            test::check_rows("cut", "ana", test::table_of_stage(m));
            // It has turned in the end.
            std::vector<Transform> world(e.figure(0).skeleton.joints.size());
            figure::Pose pose;
            e.performance().pose({0}, SimTime{7 * kTicksPerSecond}, pose);
            figure::to_model_space(e.figure(0).skeleton, pose, world);
            const double heading = heading_of(world[e.figure(0).hips.value].rotation);
            CHECK(std::fabs(turn_between(heading, radians(degrees))) < 0.1);
        }
    }
}
