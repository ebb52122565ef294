// SPDX-License-Identifier: MIT
// The ball game as its scene file has it, with walks between the throws, against the table of good
// motion: measured on the performance at 480 Hz. (read_back_test.cpp measures the exported files.)
#include <doctest/doctest.h>

#include <cmath>
#include <memory>

#include "puppetri/io/disk_files.h"
#include "puppetri/scene/perform.h"
#include "support/measure.h"
#include "support/measure_prop.h"

using namespace puppetri;

namespace {

constexpr double kRate_hz = 480;

SimTime at(double t_s) {
    return {static_cast<std::int64_t>(std::nearbyint(t_s * kTicksPerSecond))};
}

struct Played {
    scene::Performed performed;
    const stage::Performance& performance() const { return *performed.performance; }
    double end_s() const { return performance().duration().seconds(); }
};

const Played& ball_game() {
    static const Played played = [] {
        io::DiskFiles files;
        auto loaded = scene::load(files, PUP_SOURCE_DIR "/examples/03_ball/ball.pup");
        REQUIRE(loaded);
        static const scene::Scene scene = std::move(*loaded);
        auto performed = scene::perform(scene);
        REQUIRE(performed);
        return Played{std::move(*performed)};
    }();
    return played;
}

struct Watched {
    explicit Watched(std::uint32_t actor)
        : who{actor},
          figure(figure::make_mannequin(
              ball_game().performance().actors()[actor].skeleton->height_m)) {}

    void joints(double t_s, std::span<Transform> world) {
        ball_game().performance().pose(who, at(t_s), pose);
        figure::to_model_space(figure.skeleton, pose, world);
    }
    std::string name() const { return ball_game().performance().actors()[who.value].name; }

    std::vector<test::Planted> planted() const {
        std::vector<test::Planted> list;
        const stage::Performance& p = ball_game().performance();
        for (int side = 0; side < 2; ++side) {
            const motion::Limb leg = side == 0 ? motion::Limb::kLeftLeg : motion::Limb::kRightLeg;
            double begin_s = -1;
            for (double t = 0; t <= p.duration().seconds() + 1 / kRate_hz; t += 1 / kRate_hz) {
                const bool stands = t <= p.duration().seconds() &&
                                    p.phase(who, leg, at(t)) == motion::Phase::kSupport;
                if (stands && begin_s < 0) {
                    begin_s = t;
                } else if (!stands && begin_s >= 0) {
                    list.push_back({side, begin_s, t - 1 / kRate_hz});
                    begin_s = -1;
                }
            }
        }
        return list;
    }
    std::vector<double> joins() const {
        std::vector<double> list;
        for (const stage::ScoreEntry& row : ball_game().performance().score()) {
            const double t = row.start.seconds();
            if (row.actor == name() && t > 0.01 && t < ball_game().end_s() - 0.1) {
                list.push_back(t);
            }
        }
        return list;
    }

    stage::ActorIndex who;
    figure::Figure figure;
    figure::Pose pose;
};

}  // namespace

TEST_CASE("the ball game raises no note and six throws [unit]") {
    for (const Diagnostic& note : ball_game().performed.notes) {
        FAIL_CHECK(note.code << ": " << note.element << ": " << note.message);
    }
    int releases = 0;
    for (const stage::StageEvent& event : ball_game().performance().events()) {
        releases += event.name == "release";
    }
    CHECK(releases >= 6);
}

TEST_CASE("walking, turning, throwing and catching keep to the table, joins included [law]") {
    for (std::uint32_t who = 0; who < 2; ++who) {
        Watched w(who);
        const test::Measures m = test::measure(
            {.figure = w.figure,
             .sample = [&](double t, std::span<Transform> world) { w.joints(t, world); },
             .begin_s = 0,
             .end_s = ball_game().end_s(),
             .rate_hz = kRate_hz,
             .planted = w.planted(),
             .joins_s = w.joins()});
        INFO(w.name() << "\n" << report(m));
        CHECK(m.slip_mm.value < 1);
        CHECK(m.sink_mm.value < 2);
        CHECK(m.hover_mm.value < 2);
        CHECK(m.swing_sink_mm.value < 2);
        CHECK(m.arm.speed_rad_s.value < 20);
        CHECK(m.arm.acceleration_rad_s2.value < 1500);
        CHECK(m.knee.speed_rad_s.value < 10);
        CHECK(m.hip.speed_rad_s.value < 6.3);
        CHECK(m.ankle.speed_rad_s.value < 8);
        CHECK(m.spine.speed_rad_s.value < 3);
        for (const test::JointMeasures* part : {&m.knee, &m.hip, &m.ankle, &m.spine, &m.neck}) {
            CHECK(part->acceleration_rad_s2.value < 400);
        }
        CHECK(m.limit_excess_deg.value < 1e-6);
        CHECK(m.join_position_m.value < 1e-6);
        CHECK(m.join_pelvis_m_s.value < 0.05);
        CHECK(m.join_hand_m_s.value < 0.2);
        CHECK(m.join_foot_m_s.value < 0.2);
        CHECK(m.join_acceleration_ratio.value < 1.5);
    }
}

TEST_CASE(
    "palms stay on the carried, swung and caught ball within 1 mm, between frames too [law]") {
    const stage::Performance& p = ball_game().performance();
    for (std::uint32_t who = 0; who < 2; ++who) {
        Watched w(who);
        test::BallMeasure hands(
            {.figure = w.figure,
             .sample = [&](double t, std::span<Transform> world) { w.joints(t, world); },
             .ball = [&](double t) { return p.world_from_prop({0}, at(t)).translation; }});
        double worst_m = 0, worst_at_s = 0;
        int seen = 0;
        for (double t = 0; t < ball_game().end_s(); t += 1 / 113.7) {
            if (p.holder({0}, at(t)) == w.name() + ".hands") {
                ++seen;
                const double off_m = hands.palms_off_m(t);
                if (off_m > worst_m) {
                    worst_m = off_m;
                    worst_at_s = t;
                }
            }
        }
        CHECK(seen > 800);
        CHECK_MESSAGE(worst_m < 0.001, "at ", worst_at_s);
    }
}

TEST_CASE("figures look at whom they throw to, and stand squarely to the ball they catch [law]") {
    const stage::Performance& p = ball_game().performance();
    for (const stage::StageEvent& event : p.events()) {
        if (event.name != "catch") {
            continue;
        }
        const std::uint32_t who = event.actor == p.actors()[0].name ? 0 : 1;
        Watched w(who);
        std::vector<Transform> world(w.figure.skeleton.joints.size());
        w.joints(event.at.seconds(), world);
        const Vec3 chest = rotate(world[w.figure.upper_chest.value].rotation, {0, 0, 1});
        const Vec3 from = p.world_from_prop({0}, event.at - at(0.3)).translation -
                          world[w.figure.upper_chest.value].translation;
        CHECK(test::degrees_between({chest.x, 0, chest.z}, {from.x, 0, from.z}) < 20);
    }
}
