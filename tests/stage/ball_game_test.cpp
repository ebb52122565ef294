// SPDX-License-Identifier: MIT
// The column "throw, catch" of the table of good motion, measured on a performance of the ball game
// at 480 Hz.
#include <algorithm>

#include "doctest/doctest.h"
#include "exchange.h"
#include "support/measure.h"
#include "support/measure_prop.h"

using namespace puppetri;
using namespace puppetri::test;

namespace {

constexpr double kRate_hz = 480;
constexpr motion::PropIndex kBall{0};

struct Watched {
    explicit Watched(Game g) : game(std::move(g)), performance(*game.performance) {
        for (const double height : {1.75, 1.68}) {
            figures.push_back(figure::make_mannequin(height));
        }
    }
    static SimTime at(double t_s) {
        return {static_cast<std::int64_t>(std::nearbyint(t_s * kTicksPerSecond))};
    }

    BallMeasure hands_of(int who) {
        return BallMeasure(
            {.figure = figures[static_cast<std::size_t>(who)],
             .sample = [this, who](double t, std::span<Transform> world) { joints(who, t, world); },
             .ball = [this](double t) { return ball(t); }});
    }
    void joints(int who, double t, std::span<Transform> world) {
        performance.pose({static_cast<std::uint32_t>(who)}, at(t), pose);
        figure::to_model_space(figures[static_cast<std::size_t>(who)].skeleton, pose, world);
    }
    Vec3 ball(double t) const { return performance.world_from_prop(kBall, at(t)).translation; }
    std::string holder(double t) const { return performance.holder(kBall, at(t)); }

    Game game;
    const stage::Performance& performance;
    std::vector<figure::Figure> figures;
    figure::Pose pose;
};

Watched& game() {
    static Watched watched(play_game(4));
    return watched;
}

const char* hands(int who) { return who == 0 ? "ana.hands" : "rui.hands"; }

}  // namespace

TEST_CASE("a game of four exchanges raises no word of complaint [unit]") {
    for (const Diagnostic& d : game().game.diagnostics) {
        FAIL_CHECK(d.code << ": " << d.element << ": " << d.message);
    }
}

TEST_CASE("the ball has exactly one holder at any time, in the order of the game [law]") {
    Watched& w = game();
    for (const Exchange& e : w.game.exchanges) {
        const int catcher = 1 - e.thrower;
        CHECK(w.holder(e.face.seconds()) == hands(e.thrower));
        CHECK(w.holder(e.release.seconds() - 1e-6) == hands(e.thrower));
        CHECK(w.holder(e.release.seconds()) == "air");
        CHECK(w.holder(e.caught.seconds() - 1e-6) == "air");
        CHECK(w.holder(e.caught.seconds()) == hands(catcher));
    }
    std::vector<std::string> order;
    for (double t = 0; t < w.performance.duration().seconds(); t += 1 / kRate_hz) {
        const std::string now = w.holder(t);
        if (order.empty() || order.back() != now) {
            order.push_back(now);
        }
    }
    CHECK(order == std::vector<std::string>{"ana.hands", "air", "rui.hands", "air", "ana.hands",
                                            "air", "rui.hands", "air", "ana.hands"});
}

TEST_CASE(
    "palms stay on the held ball within 1 mm, between frames too, and within 5 mm at release and "
    "catch [law]") {
    Watched& w = game();
    BallMeasure of[2] = {w.hands_of(0), w.hands_of(1)};
    double worst = 0;
    for (double t = 0; t < w.performance.duration().seconds(); t += 1 / 479.3) {
        const std::string holder = w.holder(t);
        if (holder != "air") {
            worst = std::fmax(worst, of[holder == "ana.hands" ? 0 : 1].palms_off_m(t));
        }
    }
    CHECK(worst < 0.001);
    for (const Exchange& e : w.game.exchanges) {
        CHECK(of[e.thrower].palms_off_m(e.release.seconds()) < 0.005);
        CHECK(of[e.thrower].palms_off_m(e.release.seconds() - 1e-6) < 0.001);
        CHECK(of[1 - e.thrower].palms_off_m(e.caught.seconds() - 1e-6) < 0.005);
        CHECK(of[1 - e.thrower].palms_off_m(e.caught.seconds()) < 0.001);
    }
}

TEST_CASE("the ball never jumps, not even from holder to holder [law]") {
    Watched& w = game();
    const double h = 1e-5;
    double worst_m_s = 0;
    for (const Exchange& e : w.game.exchanges) {
        for (const SimTime t : {e.release, e.caught}) {
            worst_m_s = std::fmax(
                worst_m_s, length(w.ball(t.seconds() + h) - w.ball(t.seconds() - h)) / (2 * h));
        }
    }
    CHECK(worst_m_s < 9);
}

TEST_CASE("flights are parabolas under standard gravity within 1 mm [oracle]") {
    Watched& w = game();
    for (const Exchange& e : w.game.exchanges) {
        CHECK(w.hands_of(0).off_parabola_m(e.release.seconds(), e.caught.seconds(), kRate_hz) <
              0.001);
    }
}

TEST_CASE("an automatic flight over distance d lasts sqrt(2 d / g) [oracle]") {
    Watched& w = game();
    for (const Exchange& e : w.game.exchanges) {
        Vec3 way = w.ball(e.caught.seconds()) - w.ball(e.release.seconds());
        way.y = 0;
        const double expected = std::sqrt(2 * length(way) / 9.80665),
                     real = (e.caught - e.release).seconds();
        CHECK(real >= expected - 1e-9);
        CHECK(real <= expected + 0.001);
        CHECK(length(way) > 1.2);
        CHECK(length(way) < 3);
    }
}

TEST_CASE("at the release hands and ball have one velocity: 0.2 m/s, 5 degrees [law]") {
    Watched& w = game();
    const double h = 1e-4;
    for (const Exchange& e : w.game.exchanges) {
        const double t = e.release.seconds();
        BallMeasure m = w.hands_of(e.thrower);
        const Vec3 ball = m.ball_velocity(t, h);
        CHECK(length(ball) > 3);
        for (int side = 0; side < 2; ++side) {
            for (const Vec3 hand : {m.palm_velocity(side, t, -h), m.wrist_velocity(side, t, -h)}) {
                CHECK(length(ball - hand) < 0.2);
                CHECK(degrees_between(ball, hand) < 5);
            }
        }
    }
}

TEST_CASE("hands give way for at least 0.1 s after a catch [law]") {
    Watched& w = game();
    const double h = 1e-4;
    for (const Exchange& e : w.game.exchanges) {
        const double t = e.caught.seconds();
        BallMeasure m = w.hands_of(1 - e.thrower);
        const Vec3 incoming = m.ball_velocity(t - h, -h);
        for (double s = 0; s <= 0.1; s += 0.005) {
            for (int side = 0; side < 2; ++side) {
                CHECK(dot(m.palm_velocity(side, t + s, h), incoming) > 0);
            }
        }
    }
}

TEST_CASE(
    "arms turn at most 20 rad/s and the rest 6, the spine 3, accelerating at most 1500 rad/s2 "
    "[law]") {
    Watched& w = game();
    for (int who = 0; who < 2; ++who) {
        std::vector<double> joins;
        for (const Exchange& e : w.game.exchanges) {
            for (const SimTime t : {e.face, e.throw_begin, e.release, e.caught, e.catch_end}) {
                joins.push_back(t.seconds());
            }
        }
        const Measures m = measure(
            {.figure = w.figures[static_cast<std::size_t>(who)],
             .sample = [&](double t, std::span<Transform> world) { w.joints(who, t, world); },
             .begin_s = 0,
             .end_s = w.performance.duration().seconds(),
             .rate_hz = kRate_hz,
             .planted = {},
             .joins_s = joins});
        INFO(report(m));
        CHECK(m.arm.speed_rad_s.value < 20);
        CHECK(m.arm.acceleration_rad_s2.value < 1500);
        for (const JointMeasures* part : {&m.knee, &m.hip, &m.ankle, &m.neck, &m.toes}) {
            CHECK(part->speed_rad_s.value < 6);
            CHECK(part->acceleration_rad_s2.value < 1500);
        }
        CHECK(m.spine.speed_rad_s.value < 3);
        CHECK(m.limit_excess_deg.value < 1e-6);
        CHECK(m.join_position_m.value < 1e-6);
        CHECK(m.join_pelvis_m_s.value < 0.05);
        CHECK(m.join_hand_m_s.value < 0.2);
        CHECK(m.join_foot_m_s.value < 0.2);
        CHECK(m.swing_sink_mm.value < 2);
    }
}

TEST_CASE(
    "release and catch are markers, with actor and prop, at the borders of the movements [unit]") {
    Watched& w = game();
    std::vector<stage::StageEvent> found;
    for (const stage::StageEvent& event : w.performance.events()) {
        if (!event.prop.empty()) {
            found.push_back(event);
        }
    }
    REQUIRE(found.size() == 2 * w.game.exchanges.size());
    for (std::size_t i = 0; i < w.game.exchanges.size(); ++i) {
        const Exchange& e = w.game.exchanges[i];
        CHECK(found[2 * i].name == "release");
        CHECK(found[2 * i].at == e.release);
        CHECK(found[2 * i].actor == (e.thrower == 0 ? "ana" : "rui"));
        CHECK(found[2 * i + 1].name == "catch");
        CHECK(found[2 * i + 1].at == e.caught);
        CHECK(found[2 * i + 1].prop == "ball");
    }
}
