// SPDX-License-Identifier: MIT
// Who waits is alive: it breathes, it shifts its weight, it follows the ball.
#include "doctest/doctest.h"
#include "exchange.h"
#include "puppetri/figure/mannequin.h"

using namespace puppetri;
using namespace puppetri::test;

namespace {

// Largest way of any joint between two instants.
double moved_m(const stage::Performance& p, std::uint32_t who, SimTime a, SimTime b) {
    const figure::Skeleton& s = *p.actors()[who].skeleton;
    figure::Pose pose;
    std::vector<Transform> x(s.joints.size()), y(s.joints.size());
    p.pose({who}, a, pose);
    figure::to_model_space(s, pose, x);
    p.pose({who}, b, pose);
    figure::to_model_space(s, pose, y);
    double most = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        most = std::fmax(most, length(x[i].translation - y[i].translation));
    }
    return most;
}

// Degrees between where the eyes point and where the ball is.
double gaze_off_deg(const stage::Performance& p, std::uint32_t who, SimTime at) {
    const figure::Figure f = figure::make_mannequin(who == 0 ? 1.75 : 1.68);
    figure::Pose pose;
    std::vector<Transform> world(f.skeleton.joints.size());
    p.pose({who}, at, pose);
    figure::to_model_space(f.skeleton, pose, world);
    const Transform head = world[f.head.value];
    const Vec3 way = p.world_from_prop({0}, at).translation - head * f.eyes_head;
    return std::acos(dot(normalized(way), rotate(head.rotation, {0, 0, 1}))) * 180 / kPi;
}

}  // namespace

TEST_CASE(
    "a thrower that waits three seconds for the other is never a statue, and keeps the ball "
    "[law]") {
    const SimTime late = ms(3000);
    const Game game = play_game(1, late);
    const stage::Performance& p = *game.performance;
    const Exchange& e = game.exchanges[0];
    for (SimTime t = e.face + frames(12); t < e.throw_begin - ms(400); t = t + ms(100)) {
        CHECK(moved_m(p, 0, t, t + ms(400)) > 0.0008);
        CHECK(moved_m(p, 1, t, t + ms(400)) > 0.0008);
        CHECK(moved_m(p, 0, t, t + ms(10)) < 0.02);
        CHECK(p.holder({0}, t) == "ana.hands");
    }
}

TEST_CASE("who shall catch follows the ball with its eyes [law]") {
    const Game game = play_game(2);
    for (const Exchange& e : game.exchanges) {
        const auto catcher = static_cast<std::uint32_t>(1 - e.thrower);
        for (SimTime t = e.throw_begin + ms(400); t < e.caught; t = t + ms(50)) {
            CHECK(gaze_off_deg(*game.performance, catcher, t) < 48);
        }
    }
}

TEST_CASE("figures whom nobody tells anything stand alive for a minute [law]") {
    stage::Stage stage({two_players(), {}});
    const auto p = stage.finish({60 * kTicksPerSecond});
    for (SimTime t; t < SimTime{59 * kTicksPerSecond}; t = t + ms(700)) {
        for (std::uint32_t who = 0; who < 2; ++who) {
            const double way = moved_m(*p, who, t, t + ms(500));
            CHECK(way > 0.0005);
            CHECK(way < 0.1);
        }
    }
    CHECK(p->holder({0}, ms(30'000)) == "ana.hands");
}
