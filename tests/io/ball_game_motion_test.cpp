// SPDX-License-Identifier: MIT
// The column "throw, catch" of the table of good motion, measured on the performances of the ball
// games in the examples: hands and balls. (stage_motion_test.cpp measures the joints,
// read_back_test.cpp the exported files.)
#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "support/example_motion.h"
#include "support/measure_prop.h"

using namespace puppetri;
using test::Example;

namespace {

constexpr const char* kGames[] = {"01_toss/toss.pup",      "03_ball/ball.pup",
                                  "03_ball/figure5.pup",   "03_ball/impatient.pup",
                                  "03_ball/two_balls.pup", "03_ball/waits.pup"};

SimTime at(double t_s) {
    return {static_cast<std::int64_t>(std::nearbyint(t_s * kTicksPerSecond))};
}

// One actor and one ball.
struct Watched {
    Watched(const Example& watched, std::uint32_t actor, std::uint32_t prop)
        : e(watched), who{actor}, ball{prop}, figure(watched.figure(actor)) {}

    void joints(double t_s, std::span<Transform> world) {
        e.performance().pose(who, at(t_s), pose);
        figure::to_model_space(figure.skeleton, pose, world);
    }
    bool holds(double t_s) const {
        return e.performance().holder(ball, at(t_s)) == e.actor(who.value) + ".hands";
    }
    test::BallMeasure hands() {
        return test::BallMeasure(
            {.figure = figure,
             .sample = [this](double t, std::span<Transform> world) { joints(t, world); },
             .ball =
                 [this](double t) {
                     return e.performance().world_from_prop(ball, at(t)).translation;
                 }});
    }

    const Example& e;
    stage::ActorIndex who;
    stage::PropIndex ball;
    figure::Figure figure;
    figure::Pose pose;
};

std::uint32_t number_of(const Example& e, const std::string& actor) {
    std::uint32_t i = 0;
    while (e.actor(i) != actor) {
        ++i;
    }
    return i;
}

}  // namespace

TEST_CASE("the ball game raises no note and six throws [unit]") {
    const Example& e = test::example("03_ball/ball.pup");
    for (const Diagnostic& note : e.performed.notes) {
        FAIL_CHECK(note.code << ": " << note.element << ": " << note.message);
    }
    int releases = 0;
    for (const stage::StageEvent& event : e.performance().events()) {
        releases += event.name == "release";
    }
    CHECK(releases >= 6);
}

TEST_CASE(
    "palms stay on the carried, swung and caught ball within 1 mm, between frames too [law]") {
    for (const char* name : kGames) {
        const Example& e = test::example(name);
        int seen = 0;
        for (std::uint32_t prop = 0; prop < e.performance().props().size(); ++prop) {
            for (std::uint32_t who = 0; who < e.actors(); ++who) {
                Watched w(e, who, prop);
                test::BallMeasure hands = w.hands();
                double worst_m = 0, worst_at_s = 0;
                for (double t = 0; t < e.end_s(); t += 1 / 113.7) {
                    if (w.holds(t)) {
                        ++seen;
                        const double off_m = hands.palms_off_m(t);
                        if (off_m > worst_m) {
                            worst_m = off_m;
                            worst_at_s = t;
                        }
                    }
                }
                CHECK_MESSAGE(worst_m < 0.001, name, " at ", worst_at_s);
            }
        }
        CHECK(seen > 40 * e.end_s());
    }
}

TEST_CASE(
    "balls leave and reach hands as the table asks: velocities, palms, give, parabola [law]") {
    for (const char* name : kGames) {
        const Example& e = test::example(name);
        double released_s = -1;
        for (const stage::StageEvent& event : e.performance().events()) {
            if (event.prop.empty() || event.at.seconds() > e.end_s() - 0.2) {
                continue;
            }
            CAPTURE(name);
            CAPTURE(event.at.seconds());
            Watched w(e, number_of(e, event.actor), 0);
            test::BallMeasure hands = w.hands();
            const double t = event.at.seconds(), h = 1e-4;
            if (event.name == "release") {
                released_s = t;
                const Vec3 ball = hands.ball_velocity(t, h);
                CHECK(hands.palms_off_m(t) < 0.005);
                CHECK(length(ball) > 3);
                CHECK(length(ball) < 9);
                for (const int side : {0, 1}) {
                    const Vec3 palm = hands.palm_velocity(side, t, -h);
                    CHECK(length(ball - palm) < 0.2);
                    CHECK(test::degrees_between(ball, palm) < 5);
                }
            } else {
                REQUIRE(event.name == "catch");
                CHECK(hands.palms_off_m(t - 1e-6) < 0.005);
                CHECK(hands.off_parabola_m(released_s, t, 480) < 0.001);
                const Vec3 incoming = hands.ball_velocity(t - h, -h);
                for (double s = 0; s <= 0.1; s += 0.01) {
                    for (const int side : {0, 1}) {
                        CHECK(dot(hands.palm_velocity(side, t + s, h), incoming) > 0);
                    }
                }
            }
        }
    }
}

TEST_CASE("figures look at whom they throw to, and stand squarely to the ball they catch [law]") {
    for (const char* name : kGames) {
        const Example& e = test::example(name);
        for (const stage::StageEvent& event : e.performance().events()) {
            if (event.name != "catch") {
                continue;
            }
            Watched w(e, number_of(e, event.actor), 0);
            std::vector<Transform> world(w.figure.skeleton.joints.size());
            w.joints(event.at.seconds(), world);
            const Vec3 chest = rotate(world[w.figure.upper_chest.value].rotation, {0, 0, 1});
            const Vec3 from = e.performance().world_from_prop({0}, event.at - at(0.3)).translation -
                              world[w.figure.upper_chest.value].translation;
            CHECK(test::degrees_between({chest.x, 0, chest.z}, {from.x, 0, from.z}) < 20);
        }
    }
}
