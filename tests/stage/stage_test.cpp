// SPDX-License-Identifier: MIT
// The movement host at its borders: cuts, late and lost balls, limbs that nobody moves or two want
// to move, and random interleavings of everything.
#include "puppetri/stage/stage.h"

#include <algorithm>

#include "doctest/doctest.h"
#include "exchange.h"
#include "puppetri/base/random.h"
#include "puppetri/figure/mannequin.h"
#include "support/measure.h"
#include "support/measure_prop.h"

using namespace puppetri;
using namespace puppetri::test;
using C = Calls;
using motion::ActorIndex;
using motion::PropIndex;
using motion::SetIndex;

namespace {

bool has(const Diagnostics& list, const char* code, Severity severity = Severity::kWarning) {
    return std::any_of(list.begin(), list.end(), [&](const Diagnostic& d) {
        return d.code == code && d.severity == severity;
    });
}

// Worst values over a whole take, seen at 240 Hz.
void worsen(Worst& worst, double value, double at_s, const std::string& where) {
    if (value > worst.value) {
        worst = {value, at_s, where};
    }
}
std::string told(const char* what, const Worst& worst, const stage::Performance& p) {
    std::string text = std::string(what) + " " + std::to_string(worst.value) + " at " +
                       std::to_string(worst.at_s) + " " + worst.where + "\n";
    for (const stage::ScoreEntry& row : p.score()) {
        if (row.start.seconds() <= worst.at_s && row.start.seconds() > worst.at_s - 2) {
            text += "  " + std::to_string(row.start.seconds()) + " " + row.actor + " " +
                    row.movement + " ends " + std::to_string(row.end.seconds()) + " left " +
                    std::to_string(row.left.seconds()) + "\n";
        }
    }
    return text;
}

struct Sanity {
    Worst fastest_m_s, off_m, depth_m, excess_rad;
    bool finite = true, one_holder = true;
};

Sanity inspect(const stage::Performance& p, const stage::Cast& cast) {
    Sanity s;
    std::vector<figure::Figure> figures;
    for (const stage::Actor& a : cast.actors) {
        figures.push_back(figure::make_mannequin(a.height_m));
    }
    figure::Pose pose;
    std::vector<std::vector<Vec3>> before(figures.size());
    const double h = 1.0 / 240;
    for (double t = 0; t < p.duration().seconds(); t += h) {
        const SimTime at{static_cast<std::int64_t>(t * kTicksPerSecond)};
        for (std::uint32_t i = 0; i < figures.size(); ++i) {
            const figure::Figure& f = figures[i];
            std::vector<Transform> world(f.skeleton.joints.size());
            p.pose({i}, at, pose);
            figure::to_model_space(f.skeleton, pose, world);
            std::vector<Vec3> places;
            for (std::size_t j = 0; j < world.size(); ++j) {
                const Vec3 x = world[j].translation;
                s.finite = s.finite && std::isfinite(x.x + x.y + x.z + world[j].rotation.w);
                const std::string where = cast.actors[i].name + " " + f.skeleton.joints[j].name;
                worsen(s.depth_m, -x.y, t, where);
                worsen(s.excess_rad,
                       figure::limit_excess_rad(f.limits[j], pose.parent_from_joint[j].rotation), t,
                       where);
                if (!before[i].empty()) {
                    worsen(s.fastest_m_s, length(x - before[i][j]) / h, t, where);
                }
                places.push_back(x);
            }
            before[i] = places;
        }
        const std::string holder = p.holder({0}, at);
        const bool ana = holder == "ana.hands", rui = holder == "rui.hands";
        s.one_holder = s.one_holder && (ana || rui || holder == "air" || holder == "floor");
        if (ana || rui) {
            const std::uint32_t who = ana ? 0 : 1;
            BallMeasure m(
                {.figure = figures[who],
                 .sample =
                     [&](double time, std::span<Transform> world) {
                         p.pose({who}, {static_cast<std::int64_t>(time * kTicksPerSecond)}, pose);
                         figure::to_model_space(figures[who].skeleton, pose, world);
                     },
                 .ball =
                     [&](double time) {
                         return p
                             .world_from_prop({0},
                                              {static_cast<std::int64_t>(time * kTicksPerSecond)})
                             .translation;
                     }});
            worsen(s.off_m, m.palms_off_m(t), t, holder);
        }
    }
    return s;
}

}  // namespace

TEST_CASE("a throw that is cut keeps the ball and goes on from its pose [law]") {
    for (const std::int64_t cut_ms : {50, 300, 600, 800, 849}) {
        Hand hand(two_players());
        const auto face =
            hand.add("face", C::carrying(C::with(C::actor("face", 0), "toward", ActorIndex{1}), 0));
        const auto throws = hand.add(
            "throw",
            C::with(C::with(C::actor("throw", 0), "ball", PropIndex{0}), "to", ActorIndex{1}));
        hand.open();
        const auto a = hand.begin(face, ms(100), ms(500));
        hand.end(a, ms(600));
        const auto b = hand.begin(throws, ms(600));
        hand.cut(b, ms(600 + cut_ms));
        const auto p = hand.stage().finish(ms(4000));
        CHECK(p->holder({0}, ms(3999)) == "ana.hands");
        CHECK(p->score()[1].end == ms(600 + cut_ms));
        const Sanity s = inspect(*p, two_players());
        CHECK(s.finite);
        CHECK(s.off_m.value < 0.001);
        CHECK(s.excess_rad.value < 1e-6);
        CHECK(s.fastest_m_s.value < 12);
        for (const stage::StageEvent& e : p->events()) {
            CHECK(e.name != "release");
        }
    }
}

TEST_CASE(
    "a ball that is thrown without a flight in the net flies, bounces, and lies on the floor "
    "[unit]") {
    Hand hand(two_players());
    const auto throws = hand.add(
        "throw", C::with(C::with(C::actor("throw", 0), "ball", PropIndex{0}), "to", ActorIndex{1}));
    hand.open();
    const auto token = hand.begin(throws, ms(500));
    hand.end(token, token.ready + ms(700));
    const auto p = hand.stage().finish(ms(12'000));
    CHECK(p->holder({0}, token.ready - ms(1)) == "ana.hands");
    CHECK(p->holder({0}, token.ready + ms(1)) == "air");
    CHECK(p->holder({0}, ms(11'000)) == "floor");
    CHECK(p->world_from_prop({0}, ms(11'000)).translation.y == doctest::Approx(0.11));
    CHECK(inspect(*p, two_players()).one_holder);
}

TEST_CASE(
    "hands close on air where the ball is elsewhere: a warning names the place, the ball stays "
    "[unit]") {
    Hand hand(two_players());
    const auto catches = hand.add("b.getting", C::with(C::actor("catch", 1), "ball", PropIndex{0}));
    hand.open();
    const auto token = hand.begin(catches, ms(100));
    CHECK(token.ready == ms(800));
    CHECK(has(hand.stage().diagnostics(), "out-of-reach"));
    CHECK(hand.stage().diagnostics()[0].element == "place b.getting");
    CHECK(!hand.stage().diagnostics()[0].remedy.empty());
    hand.end(token, token.ready);
    const auto p = hand.stage().finish(ms(2000));
    CHECK(p->holder({0}, ms(1999)) == "ana.hands");
    CHECK(inspect(*p, two_players()).off_m.value < 0.001);
}

TEST_CASE("who holds another ball does not catch, and keeps what it holds [unit]") {
    stage::Cast cast = two_players();
    cast.props.push_back({.name = "second", .held_by = ActorIndex{1}});
    Hand hand(cast);
    const auto catches = hand.add("b.getting", C::with(C::actor("catch", 1), "ball", PropIndex{0}));
    hand.open();
    const auto token = hand.begin(catches, ms(100));
    hand.end(token, token.ready);
    CHECK(has(hand.stage().diagnostics(), "hands-full"));
    const auto p = hand.stage().finish(ms(2000));
    CHECK(p->holder({0}, ms(1999)) == "ana.hands");
    CHECK(p->holder({1}, ms(1999)) == "rui.hands");
}

TEST_CASE("a stroke longer than the legs is told, with the longest they can do [unit]") {
    for (const double stroke_m : {0.7, 0.8}) {
        Hand hand(two_players());
        const auto step = hand.add(
            "a.P4",
            C::with(C::with(C::actor("step", 0), "side", motion::Side::kLeft), "stroke", stroke_m));
        hand.open();
        hand.begin(step, ms(100));
        CHECK(has(hand.stage().diagnostics(), "long-stroke") == (stroke_m > 0.75));
    }
}

TEST_CASE(
    "carrying and throwing what another holds is told, and the ball stays where it is [unit]") {
    Hand hand(two_players());
    const auto carry = hand.add("b.carry", C::with(C::actor("carry", 1), "ball", PropIndex{0}));
    const auto throws =
        hand.add("b.throw",
                 C::with(C::with(C::actor("throw", 1), "ball", PropIndex{0}), "to", ActorIndex{0}));
    hand.open();
    const auto a = hand.begin(carry, ms(100), ms(500));
    hand.end(a, ms(600));
    const auto b = hand.begin(throws, ms(600));
    hand.end(b, b.ready);
    CHECK(has(hand.stage().diagnostics(), "not-held"));
    const auto p = hand.stage().finish(ms(3000));
    CHECK(p->holder({0}, ms(2999)) == "ana.hands");
    CHECK(inspect(*p, two_players()).off_m.value < 0.001);
}

TEST_CASE(
    "one limb in two movements at once is told, one after the other in one instant is not [unit]") {
    Hand hand(two_players());
    const auto idle = hand.add("a.idle", C::actor("idle", 1)),
               turn = hand.add("a.turn", C::actor("turn", 1));
    hand.open();
    const auto a = hand.begin(idle, ms(100));
    // The net gives before it takes: both are in one instant.
    const auto b = hand.begin(turn, ms(500), ms(500));
    hand.end(a, ms(500));
    CHECK_FALSE(has(hand.stage().diagnostics(), "limb-driven-twice"));
    hand.begin(idle, ms(700));
    hand.end(b, ms(1000));
    CHECK(has(hand.stage().diagnostics(), "limb-driven-twice"));
}

TEST_CASE("a leg transferred beside a whole step is told, also the second time [unit]") {
    Hand hand(two_players());
    const auto step =
        hand.add("a.step", C::with(C::actor("step", 1), "side", motion::Side::kRight));
    const auto first = hand.add("a.first", C::limb("transfer", 1, motion::Limb::kLeftLeg)),
               again = hand.add("a.again", C::limb("transfer", 1, motion::Limb::kLeftLeg));
    hand.open();
    const auto s = hand.begin(step, ms(100));
    const auto a = hand.begin(first, ms(200));
    hand.end(a, ms(400));
    // The leg is the first transfer's now, but the step has not ended.
    const auto b = hand.begin(again, ms(500));
    hand.end(s, ms(900));
    hand.end(b, ms(1400));
    int told = 0;
    for (const Diagnostic& d : hand.stage().diagnostics()) {
        told += d.code == "limb-driven-twice";
    }
    CHECK(told == 2);
}

TEST_CASE("long and fast throws get a warning, at 6 m and 9 m/s [unit]") {
    stage::Cast cast = two_players();
    cast.actors[1].position_world = {5.4, 0, 0};
    Hand hand(cast);
    const auto flies = hand.add(
        "flight", C::with(C::with(C::prop("fly", 0), "from", ActorIndex{0}), "to", ActorIndex{1}));
    hand.open();
    const auto far = hand.begin(flies, ms(100));
    hand.end(far, far.ready);
    CHECK(has(hand.stage().diagnostics(), "far-throw"));
    CHECK_FALSE(has(hand.stage().diagnostics(), "fast-throw"));
    hand.begin(flies, far.ready + ms(1000), ms(300));
    CHECK(has(hand.stage().diagnostics(), "fast-throw"));
}

TEST_CASE("a flight longer than any that is declared is refused, with its remedy [unit]") {
    for (const double away_m : {15.0, 30.0}) {
        stage::Cast cast = two_players();
        cast.actors[1].position_world = {away_m, 0, 0};
        stage::Play play;
        play.cast = cast;
        play.actions = {{C::with(C::prop("fly", 0), "to", ActorIndex{1}), "flight", "", {}, {}}};
        const auto declared = stage::declared_durations(play);
        REQUIRE(declared.size() == 1);
        stage::Stage stage(play);
        const SimTime lasts =
            stage.begin(net::ActionIndex{0}, net::ActivityIndex{0}, ms(100), {-1}, {});
        CHECK(declared[0].has(lasts) == (away_m < 16));
        CHECK((lasts.ticks < 0) ==
              has(stage.diagnostics(), "duration-not-declared", Severity::kError));
    }
}

TEST_CASE(
    "a duration that the net prescribes is kept to the tick, also for throws and flights [unit]") {
    Hand hand(two_players());
    const auto throws = hand.add(
        "throw", C::with(C::with(C::actor("throw", 0), "ball", PropIndex{0}), "to", ActorIndex{1}));
    const auto flies = hand.add(
        "fly", C::with(C::with(C::prop("fly", 0), "from", ActorIndex{0}), "to", ActorIndex{1}));
    hand.open();
    const SimTime lasts{kTicksPerSecond * 7 / 9};
    const auto a = hand.begin(throws, ms(100), lasts);
    CHECK(a.ready == ms(100) + lasts);
    hand.end(a, a.ready);
    const auto b = hand.begin(flies, a.ready, lasts);
    CHECK(b.ready == a.ready + lasts);
}

TEST_CASE("a prop or an actor may come as an attribute of the token [unit]") {
    Hand hand(two_players());
    auto call = C::actor("face", 0);
    call.arguments.push_back({"toward", motion::TokenAttribute{1}});
    const auto face = hand.add("face", call);
    hand.open();
    const std::int64_t attributes[] = {0, 1};
    const SimTime lasts = hand.stage().begin(net::ActionIndex{face}, net::ActivityIndex{0}, ms(100),
                                             {-1}, attributes);
    hand.stage().left(net::ActivityIndex{0}, ms(100) + lasts);
    const auto p = hand.stage().finish(ms(3000));
    figure::Pose pose;
    p->pose({0}, ms(2900), pose);
    CHECK(heading_of(pose.parent_from_joint[0].rotation) == doctest::Approx(kPi / 2).epsilon(0.05));
}

TEST_CASE("events of a movement are raised at their absolute time [unit]") {
    stage::Play play;
    play.cast = two_players();
    stage::Action action;
    action.call = C::with(C::with(C::actor("throw", 0), "ball", PropIndex{0}), "to", ActorIndex{1});
    action.place = "throw";
    action.raises = {{"release", net::EventIndex{5}}};
    play.actions = {action};
    stage::Stage stage(play);
    const SimTime lasts =
        stage.begin(net::ActionIndex{0}, net::ActivityIndex{0}, ms(250), {-1}, {});
    const auto raised = stage.raised(net::ActivityIndex{0});
    REQUIRE(raised.size() == 1);
    CHECK(raised[0].at == ms(250) + lasts);
    CHECK(raised[0].event == net::EventIndex{5});
}

TEST_CASE(
    "random movements, ended or cut at random times, never break a figure or lose the ball [law]") {
    for (std::uint64_t seed = 0; seed < 12; ++seed) {
        CAPTURE(seed);
        Hand hand(two_players());
        std::vector<std::uint32_t> actions[2];
        for (std::uint32_t i = 0; i < 2; ++i) {
            const ActorIndex other{1 - i};
            const motion::BoundCall calls[] = {
                C::with(C::actor("face", i), "toward", other),
                C::carrying(C::with(C::actor("face", i), "toward", SetIndex{0}), 0),
                C::with(C::with(C::actor("ready", i), "ball", PropIndex{0}), "from", other),
                C::actor("idle", i),
                C::with(C::actor("turn", i), "by", -1.0),
                C::with(C::actor("half_step", i), "side", motion::Side::kLeft),
                C::with(C::actor("step", i), "side", motion::Side::kRight),
                C::carrying(C::with(C::actor("walk", i), "steps", std::int64_t{2}), 0),
                C::with(C::actor("reach", i), "to", other),
                C::with(C::actor("carry", i), "ball", PropIndex{0}),
                C::with(C::with(C::actor("throw", i), "ball", PropIndex{0}), "to", other),
                C::limb("swing_forward", i, motion::Limb::kLeftArm),
                C::limb("swing_backward", i, motion::Limb::kRightArm),
            };
            for (const motion::BoundCall& call : calls) {
                actions[i].push_back(hand.add("place", call));
            }
        }
        hand.open();
        RandomStream random{stream_key(seed, "stage_test", "interleaving")};
        Hand::Token running[2];
        SimTime until[2];
        bool busy[2] = {false, false}, cuts[2] = {false, false};
        SimTime now;
        for (int n = 0; n < 24; ++n) {
            const int who = !busy[0] ? 0 : !busy[1] ? 1 : until[0] <= until[1] ? 0 : 1;
            if (busy[who]) {
                now = std::max(now, until[who]);
                if (cuts[who]) {
                    hand.cut(running[who], now);
                } else {
                    hand.end(running[who], now);
                }
                busy[who] = false;
                if (random.uniform() < 0.3) {
                    now = now + ms(1 + static_cast<std::int64_t>(
                                           random.uniform() * 200));  // nobody moves it for a while
                }
            }
            const auto choice = static_cast<std::size_t>(random.uniform() *
                                                         static_cast<double>(actions[who].size()));
            running[who] = hand.begin(actions[who][choice], now);
            REQUIRE(running[who].ready >= now);
            cuts[who] = random.uniform() < 0.4;
            const double part = cuts[who] ? random.uniform() : 1 + 0.2 * random.uniform();
            until[who] = now + SimTime{static_cast<std::int64_t>(
                                   part * static_cast<double>((running[who].ready - now).ticks))};
            busy[who] = true;
        }
        const auto p = hand.stage().finish(now + ms(1500));
        const Sanity s = inspect(*p, two_players());
        INFO(told("off", s.off_m, *p)
             << told("fast", s.fastest_m_s, *p) << told("deep", s.depth_m, *p));
        CHECK(s.finite);
        CHECK(s.one_holder);
        CHECK(s.off_m.value < 0.001);
        CHECK(s.excess_rad.value < 1e-6);
        CHECK(s.fastest_m_s.value < 30);
        CHECK(s.depth_m.value < 0.002);
    }
}
