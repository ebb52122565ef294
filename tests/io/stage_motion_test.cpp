// SPDX-License-Identifier: MIT
// The reference scenes on the stage, each figure measured at 480 Hz over the whole performance
// against the table of good motion: walks, turns, throws and catches as the nets string them
// together, joins included.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "puppetri/io/disk_files.h"
#include "puppetri/scene/perform.h"
#include "support/measure.h"

using namespace puppetri;

namespace {

constexpr double kRate_hz = 480;

struct Measured {
    std::string actor;
    test::Measures measures;
};

// Measures every actor of an example. `until_s` cuts long performances.
std::vector<Measured> measured(const std::string& name, double until_s) {
    io::DiskFiles files;
    auto scene = scene::load(files, PUP_SOURCE_DIR "/examples/" + name);
    REQUIRE(scene);
    auto performed = scene::perform(*scene);
    REQUIRE(performed);
    const stage::Performance& performance = *performed->performance;
    const double end_s = std::min(until_s, performance.duration().seconds());
    auto at = [](double t) {
        return SimTime{static_cast<std::int64_t>(std::nearbyint(t * kTicksPerSecond))};
    };
    std::vector<Measured> list;
    for (std::uint32_t a = 0; a < performance.actors().size(); ++a) {
        const auto& actor = performance.actors()[a];
        const figure::Figure figure = figure::make_mannequin(actor.skeleton->height_m);
        figure::Pose pose;
        test::MeasureInput input{.figure = figure,
                                 .sample =
                                     [&](double t, std::span<Transform> world) {
                                         performance.pose({a}, at(t), pose);
                                         figure::to_model_space(figure.skeleton, pose, world);
                                     },
                                 .begin_s = 0,
                                 .end_s = end_s,
                                 .rate_hz = kRate_hz,
                                 .planted = {},
                                 .joins_s = {}};
        for (int side = 0; side < 2; ++side) {
            const motion::Limb leg = side == 0 ? motion::Limb::kLeftLeg : motion::Limb::kRightLeg;
            bool was = false;
            const int count = static_cast<int>(end_s * kRate_hz);
            for (int i = 0; i <= count; ++i) {
                const bool on =
                    performance.phase({a}, leg, at(i / kRate_hz)) == motion::Phase::kSupport;
                if (on && !was) {
                    input.planted.push_back({side, i / kRate_hz, i / kRate_hz});
                }
                if (on) {
                    input.planted.back().end_s = i / kRate_hz;
                }
                was = on;
            }
        }
        for (const stage::ScoreEntry& entry : performance.score()) {
            if (entry.actor == actor.name && entry.start.ticks > 0 &&
                entry.start.seconds() < end_s) {
                input.joins_s.push_back(entry.start.seconds());
            }
        }
        std::sort(input.joins_s.begin(), input.joins_s.end());
        input.joins_s.erase(std::unique(input.joins_s.begin(), input.joins_s.end()),
                            input.joins_s.end());
        list.push_back({actor.name, test::measure(input)});
    }
    return list;
}

// What holds for whatever the net strings together.
void check_joins_and_feet(const test::Measures& m) {
    CHECK(m.slip_mm.value <= 1);
    CHECK(m.sink_mm.value <= 2);
    CHECK(m.hover_mm.value <= 2);
    CHECK(m.swing_sink_mm.value <= 2);
    CHECK(m.join_position_m.value <= 1e-6);
    CHECK(m.join_pelvis_m_s.value <= 0.05);
    CHECK(m.join_hand_m_s.value <= 0.2);
    CHECK(m.join_foot_m_s.value <= 0.2);
    CHECK(m.join_acceleration_ratio.value <= 1.5);
    CHECK(m.limit_excess_deg.value <= 1e-4);
    CHECK(m.knee.speed_rad_s.value <= 10);
    CHECK(m.hip.speed_rad_s.value <= 6);
    CHECK(m.ankle.speed_rad_s.value <= 8);
    CHECK(m.spine.speed_rad_s.value <= 3);
    CHECK(m.neck.speed_rad_s.value <= 6);
    CHECK(m.arm.speed_rad_s.value <= 20);
    for (const test::JointMeasures* j : {&m.knee, &m.hip, &m.ankle, &m.spine, &m.neck}) {
        CHECK(j->acceleration_rad_s2.value <= 400);
    }
    CHECK(m.arm.acceleration_rad_s2.value <= 1500);
}

}  // namespace

TEST_CASE(
    "the walk on the stage keeps the figures of a good walk, also with a place for every limb "
    "[law]") {
    for (const char* name : {"02_walk/figure.pup", "02_walk/limbs.pup", "02_walk/legs.pup"}) {
        for (const Measured& one : measured(name, 10)) {
            const test::Measures& m = one.measures;
            CAPTURE(name);
            INFO(test::report(m));
            check_joins_and_feet(m);
            CHECK(m.knee_stance_deg.value <= 25);
            CHECK(m.pelvis_acceleration.value <= 4);
            CHECK(m.rise_mm >= 20);
            CHECK(m.rise_mm <= 60);
            CHECK(m.sway_mm >= 20);
            CHECK(m.sway_mm <= 50);
            CHECK(m.steps.size() == 4);
            for (const test::Step& step : m.steps) {
                CHECK(step.knee_deg >= 50);
                CHECK(step.knee_deg <= 70);
                CHECK(step.clearance_mm >= 10);
                CHECK(step.clearance_mm <= 60);
            }
        }
    }
}

TEST_CASE(
    "the ball game on the stage: walks, turns, throws and catches join without a jerk or a slip "
    "[law]") {
    for (const Measured& one : measured("03_ball/ball.pup", 24)) {
        CAPTURE(one.actor);
        INFO(test::report(one.measures));
        check_joins_and_feet(one.measures);
    }
}
