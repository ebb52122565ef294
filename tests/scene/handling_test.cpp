// SPDX-License-Identifier: MIT
// Picking up, handing over, embracing.
#include <doctest/doctest.h>

#include "measured.h"
#include "puppetri/math/rotation.h"

using namespace puppetri;
using namespace puppetri::scene;

namespace {

const char* const kHandling = R"(language 1
scene "Handling"
until 9 s
cast {
  ana: mannequin { at (0, 0, 0) m }
  rui: mannequin { at (0, 0, 0.92) m, facing 180 deg }
  ball: sphere { diameter 22 cm, at (0, 0.11, 0.4) m }
}
place a does ana.pick_up(ball) tokens 1
place b does ana.hand_over(ball, to: rui)
place c does ana.idle(lasting: 1 s)
place w tokens 1
place r does rui.turn(90 deg)
place s does rui.idle(lasting: 1 s)
picked: a -> b
given: b -> c
on: c + w -> r
stop: r -> s
end { s }
)";

SimTime at(double t_s) { return {static_cast<std::int64_t>(t_s * kTicksPerSecond)}; }

Vec3 palm(const stage::Performance& p, std::uint32_t who, int side, double t_s) {
    static const figure::Figure figure = figure::make_mannequin(1.75);
    figure::Pose pose;
    p.pose({who}, at(t_s), pose);
    std::vector<Transform> world(figure.skeleton.joints.size());
    to_model_space(figure.skeleton, pose, world);
    const auto i = static_cast<std::size_t>(side);
    return (world[figure.arms[i].hand.value] * figure.arms[i].hand_from_palm).translation;
}

// When an event of that name last was; 0 if never.
double last(const stage::Performance& shown, std::string_view name) {
    double at_s = 0;
    for (const stage::StageEvent& e : shown.events()) {
        at_s = e.name == name ? e.at.seconds() : at_s;
    }
    return at_s;
}

}  // namespace

TEST_CASE("a ball is picked up off the floor, handed over, and carried on, without a jump [law]") {
    MemoryFiles files;
    files.add("scene.pup", kHandling);
    const Scene scene = must(load(files, "scene.pup"));
    const Performed p = performed(scene);
    CHECK_MESSAGE(p.notes.empty(), told(p.notes));
    check_good(measured(p, scene, 0), "ana");
    check_good(measured(p, scene, 1), "rui");
    const stage::Performance& shown = *p.performance;
    const double grasp = last(shown, "grasp"), given = last(shown, "hand_over");
    REQUIRE(grasp > 0.5);
    REQUIRE(given > grasp);
    CHECK(shown.holder({0}, at(grasp - 0.01)) == "floor");
    CHECK(shown.holder({0}, at(grasp + 0.01)) == "ana.hands");
    CHECK(shown.holder({0}, at(given - 0.01)) == "ana.hands");
    CHECK(shown.holder({0}, at(given + 0.01)) == "rui.hands");
    CHECK(shown.holder({0}, shown.duration()) == "rui.hands");
    // Palms on the ball while it is held; it lies still before, and never jumps.
    Vec3 before = shown.world_from_prop({0}, at(0)).translation;
    for (double t = 0; t < 9; t += 1.0 / 120) {
        const Vec3 ball = shown.world_from_prop({0}, at(t)).translation;
        CHECK_MESSAGE(length(ball - before) < 3.0 / 120 + 1e-6, t << " s");
        before = ball;
        if (t < grasp) {
            CHECK(length(ball - Vec3{0, 0.11, 0.4}) < 1e-9);
            continue;
        }
        const std::uint32_t holder = t < given ? 0 : 1;
        for (int side = 0; side < 2; ++side) {
            CHECK(std::fabs(length(palm(shown, holder, side, t) - ball) - 0.11) < 0.005);
        }
    }
    // Both have it in their hands when it changes.
    for (int side = 0; side < 2; ++side) {
        const Vec3 ball = shown.world_from_prop({0}, at(given)).translation;
        CHECK(std::fabs(length(palm(shown, 0, side, given) - ball) - 0.11) < 0.01);
        CHECK(std::fabs(length(palm(shown, 1, side, given) - ball) - 0.11) < 0.01);
    }
}

TEST_CASE("boxes are picked up, carried and handed over between flat palms [law]") {
    struct Case {
        const char* box;
        Vec3 size;
        double facing_deg;
    };
    const Case cases[] = {{"(0.3, 0.2, 0.25) m", {0.3, 0.2, 0.25}, 0},
                          {"(0.3, 0.2, 0.25) m", {0.3, 0.2, 0.25}, 90},
                          {"(0.2, 0.3, 0.4) m", {0.2, 0.3, 0.4}, -25},
                          {"(0.22, 0.16, 0.6) m", {0.22, 0.16, 0.6}, 10},
                          {"(0.6, 0.16, 0.22) m", {0.6, 0.16, 0.22}, 100}};
    for (const Case& c : cases) {
        CAPTURE(c.box);
        CAPTURE(c.facing_deg);
        const double a = c.facing_deg / 57.29577951308232;
        const auto at_distance = [&](double m, double y) {
            return "(" + std::to_string(m * std::sin(a)) + ", " + std::to_string(y) + ", " +
                   std::to_string(m * std::cos(a)) + ") m";
        };
        std::string text = kHandling;
        const auto put = [&](const std::string& from, const std::string& to) {
            REQUIRE(text.find(from) != std::string::npos);
            text.replace(text.find(from), from.size(), to);
        };
        put("at (0, 0, 0) m", "facing " + std::to_string(c.facing_deg) + " deg");
        put("at (0, 0, 0.92) m, facing 180 deg", "at " + at_distance(0.92, 0) + ", facing " +
                                                     std::to_string(c.facing_deg + 180) + " deg");
        put("sphere { diameter 22 cm, at (0, 0.11, 0.4) m }",
            std::string("box { size ") + c.box + ", at " + at_distance(0.4, c.size.y / 2) + " }");
        MemoryFiles files;
        files.add("scene.pup", text);
        const Scene scene = must(load(files, "scene.pup"));
        const Performed p = performed(scene);
        CHECK_MESSAGE(p.notes.empty(), told(p.notes));
        check_good(measured(p, scene, 0), "ana");
        check_good(measured(p, scene, 1), "rui");
        const stage::Performance& shown = *p.performance;
        const double grasp = last(shown, "grasp"), given = last(shown, "hand_over");
        CHECK(shown.holder({0}, at(given + 0.01)) == "rui.hands");
        Transform before = shown.world_from_prop({0}, at(0));
        for (double t = 0; t < 8.5; t += 1.0 / 120) {
            const Transform box = shown.world_from_prop({0}, at(t));
            CHECK_MESSAGE(length(box.translation - before.translation) < 3.0 / 120 + 1e-6, t);
            CHECK_MESSAGE(angle_between(box.rotation, before.rotation) < 8.0 / 120 + 1e-6, t);
            before = box;
            if (t < grasp) {
                continue;
            }
            // Each palm lies on a face: one coordinate is half the size, the others are inside it.
            const std::uint32_t holder = t < given ? 0 : 1;
            for (int side = 0; side < 2; ++side) {
                const Vec3 palm_box = inverse(box) * palm(shown, holder, side, t);
                const double x = std::fabs(palm_box.x), z = std::fabs(palm_box.z);
                const bool on_x = std::fabs(x - c.size.x / 2) < 0.004 && z < 0.02,
                           on_z = std::fabs(z - c.size.z / 2) < 0.004 && x < 0.02;
                CHECK_MESSAGE((on_x || on_z), t << " s, side " << side << ": " << palm_box.x << " "
                                                << palm_box.y << " " << palm_box.z);
                CHECK_MESSAGE(std::fabs(palm_box.y) < 0.02, t << " s: " << palm_box.y);
            }
        }
    }
}

TEST_CASE("what lies too far is not picked up, and nobody far off is handed anything [unit]") {
    const auto notes = [](const std::string& cast, const std::string& call) {
        MemoryFiles files;
        files.add("scene.pup", "language 1\nscene \"s\"\nuntil 4 s\ncast {\n ana: mannequin\n" +
                                   cast + "}\nplace p does ana." + call + " tokens 1\nend { p }\n");
        const Scene scene = must(load(files, "scene.pup"));
        const Performed p = performed(scene);
        return p.notes.empty() ? std::string() : p.notes.front().code;
    };
    CHECK(notes(" ball: sphere { at (0, 0.11, 2) m }\n", "pick_up(ball)") == "out-of-reach");
    // A plank; a board that a palm fits beside.
    CHECK(notes(" ball: box { size (0.4, 0.02, 0.15) m, at (0, 0.01, 0.4) m }\n",
                "pick_up(ball)") == "too-flat");
    CHECK(notes(" ball: box { size (0.4, 0.08, 0.15) m, at (0, 0.04, 0.4) m }\n",
                "pick_up(ball)") == "");
    CHECK(notes(" ball: sphere { at (0, 0.11, 0.4) m }\n", "pick_up(ball)") == "");
    CHECK(notes(" ball: box { size (0.8, 0.3, 0.8) m, at (0, 0.15, 0.4) m }\n", "pick_up(ball)") ==
          "out-of-reach");
    CHECK(notes(" rui: mannequin { at (0, 0, 3) m }\n ball: sphere { held by ana.hands }\n",
                "hand_over(ball, to: rui)") == "out-of-reach");
    CHECK(notes(" rui: mannequin { at (0, 0, 0.9) m }\n ball: sphere { at (0, 0.11, 3) m }\n",
                "hand_over(ball, to: rui)") == "not-held");
    CHECK(notes(" rui: mannequin { at (0, 0, 3) m }\n", "hug(rui)") == "out-of-reach");
}

TEST_CASE("two who embrace each other have their hands on each other's back, not inside [law]") {
    MemoryFiles files;
    files.add("scene.pup", R"(language 1
scene "Embrace"
until 5 s
cast {
  ana: mannequin { at (0, 0, 0) m }
  rui: mannequin { at (0, 0, 0.37) m, facing 180 deg }
}
place a does ana.hug(rui) tokens 1
place b does rui.hug(ana) tokens 1
place c does ana.idle()
place d does rui.idle()
ac: a -> c
bd: b -> d
end { c and d }
)");
    const Scene scene = must(load(files, "scene.pup"));
    const Performed p = performed(scene);
    CHECK_MESSAGE(p.notes.empty(), told(p.notes));
    check_good(measured(p, scene, 0), "ana");
    check_good(measured(p, scene, 1), "rui");
    const figure::Figure figure = figure::make_mannequin(1.75);
    for (double t = 0.3; t < 3.6; t += 0.05) {
        for (std::uint32_t who = 0; who < 2; ++who) {
            figure::Pose pose;
            p.performance->pose({1 - who}, at(t), pose);
            std::vector<Transform> world(figure.skeleton.joints.size());
            to_model_space(figure.skeleton, pose, world);
            for (int side = 0; side < 2; ++side) {
                const Vec3 hand =
                    inverse(world[figure.upper_chest.value]) * palm(*p.performance, who, side, t);
                // A trunk as an ellipse of 30 cm by 17 cm.
                const double inside =
                    hand.x * hand.x / (0.15 * 0.15) + hand.z * hand.z / (0.085 * 0.085);
                CHECK_MESSAGE(inside > 1, t << " s: " << hand.x << " " << hand.y << " " << hand.z);
                if (t > 1.55 && t < 1.9) {
                    CHECK_MESSAGE(hand.z < -0.07, hand.z);
                    CHECK_MESSAGE(hand.z > -0.17, hand.z);
                    CHECK_MESSAGE(std::fabs(hand.x) < 0.16, hand.x);
                }
            }
        }
    }
}
