// SPDX-License-Identifier: MIT
// The reference scenes on the stage, each figure measured at 480 Hz over the whole performance against the table of good
// motion: walks, turns, throws and catches as the nets string them together, joins included.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
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
    auto at = [](double t) { return SimTime{static_cast<std::int64_t>(std::nearbyint(t * kTicksPerSecond))}; };
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
                const bool on = performance.phase({a}, leg, at(i / kRate_hz)) == motion::Phase::kSupport;
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
            if (entry.actor == actor.name && entry.start.ticks > 0 && entry.start.seconds() < end_s) {
                input.joins_s.push_back(entry.start.seconds());
            }
        }
        std::sort(input.joins_s.begin(), input.joins_s.end());
        input.joins_s.erase(std::unique(input.joins_s.begin(), input.joins_s.end()), input.joins_s.end());
        list.push_back({actor.name, test::measure(input)});
    }
    return list;
}

}  // namespace

TEST_CASE("explore scene [skip]" * doctest::skip()) {
    const char* name = std::getenv("SCENE");
    for (const Measured& m : measured(name ? name : "03_ball/ball.pup", std::getenv("UNTIL") ? std::atof(std::getenv("UNTIL")) : 40)) {
        std::printf("== %s\n%s", m.actor.c_str(), test::report(m.measures).c_str());
    }
}

TEST_CASE("trace scene [skip]" * doctest::skip()) {
    io::DiskFiles files;
    auto scene = scene::load(files, std::string(PUP_SOURCE_DIR "/examples/") + std::getenv("SCENE"));
    auto performed = scene::perform(*scene);
    const stage::Performance& p = *performed->performance;
    const std::uint32_t a = std::atoi(std::getenv("ACTOR"));
    const figure::Figure f = figure::make_mannequin(p.actors()[a].skeleton->height_m);
    figure::Pose pose;
    std::vector<Transform> world(f.skeleton.joints.size());
    for (const auto& e : p.score()) {
        if (e.actor == p.actors()[a].name && e.start.seconds() < std::atof(std::getenv("TO")) && e.end.seconds() > std::atof(std::getenv("FROM")))
            std::printf("%s %s %.3f .. %.3f left %.3f limbs %x\n", e.place.c_str(), e.movement.c_str(), e.start.seconds(), e.end.seconds(), e.left.seconds(), e.limbs.bits);
    }
    for (double t = std::atof(std::getenv("FROM")); t < std::atof(std::getenv("TO")); t += 1.0 / 48) {
        p.pose({a}, {static_cast<std::int64_t>(t * kTicksPerSecond)}, pose);
        figure::to_model_space(f.skeleton, pose, world);
        const Vec3 h = world[f.hips.value].translation;
        std::printf("%.4f pelvis %.4f %.4f %.4f", t, h.x, h.y, h.z);
        for (int s = 0; s < 2; ++s) {
            const Quat k = conjugate(world[f.legs[s].hip.value].rotation) * world[f.legs[s].knee.value].rotation;
            const Vec3 an = world[f.legs[s].ankle.value].translation;
            std::printf(" | %c knee %5.1f ankle %.3f %.3f %.3f", "LR"[s], 2 * std::atan2(k.x, k.w) * 57.2958, an.x, an.y, an.z);
        }
        std::printf("\n");
    }
}
