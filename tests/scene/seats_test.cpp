// SPDX-License-Identifier: MIT
// Going to places and to seats, resting there, and leaving again.
#include <doctest/doctest.h>

#include "measured.h"

using namespace puppetri;
using namespace puppetri::scene;

namespace {

struct Played {
    Scene scene;
    Performed performed;
    figure::Figure figure;

    const stage::ScoreEntry& row(const std::string& place) const {
        for (const stage::ScoreEntry& r : performed.performance->score()) {
            if (r.place == place) {
                return r;
            }
        }
        FAIL("no such place: " << place);
        return performed.performance->score().front();
    }
    std::vector<Transform> at(SimTime t) const {
        figure::Pose pose;
        performed.performance->pose({0}, t, pose);
        std::vector<Transform> world(figure.skeleton.joints.size());
        to_model_space(figure.skeleton, pose, world);
        return world;
    }
    Vec3 hips(SimTime t) const { return at(t)[figure.hips.value].translation; }
    // Midway between the ankles, on the floor.
    Vec3 stands(SimTime t) const {
        const auto world = at(t);
        const Vec3 m = (world[figure.legs[0].ankle.value].translation +
                        world[figure.legs[1].ankle.value].translation) *
                       0.5;
        return {m.x, 0, m.z};
    }
    double heading_deg(SimTime t) const {
        const Vec3 ahead = rotate(at(t)[figure.legs[0].ankle.value].rotation, {0, 0, 1});
        return std::atan2(ahead.x, ahead.z) * 180 / 3.14159265358979;
    }
};

// The calls one after the other, in places p0, p1, ...
Played play(const std::string& figure, double height_m, const std::vector<std::string>& calls,
            const std::string& cast = "") {
    std::string text = "language 1\nscene \"s\"\nuntil 40 s\ncast {\n ana: mannequin { height " +
                       std::to_string(height_m) + " m, " + figure + " }\n" + cast + "}\n";
    for (std::size_t k = 0; k < calls.size(); ++k) {
        text += "place p" + std::to_string(k) + " does ana." + calls[k] +
                (k == 0 ? " tokens 1\n" : "\n");
        if (k > 0) {
            text += "t" + std::to_string(k) + ": p" + std::to_string(k - 1) + " -> p" +
                    std::to_string(k) + "\n";
        }
    }
    text += "end { p" + std::to_string(calls.size() - 1) + " }\n";
    MemoryFiles files;
    files.add("scene.pup", text);
    Scene scene = must(load(files, "scene.pup"));
    Performed p = performed(scene);
    return {std::move(scene), std::move(p), figure::make_mannequin(height_m)};
}

}  // namespace

TEST_CASE("it goes to a place and stands there, whatever direction and distance [oracle]") {
    int number = 0;
    for (const double height_m : {1.5, 1.75, 1.9}) {
        for (const double way_deg : {0.0, 50.0, -95.0, 170.0}) {
            for (const double distance_m : {0.3, 1.1, 3.7}) {
                const double facing = std::fmod(77.0 * ++number, 360) - 180;
                const double x = 0.4 + distance_m * std::sin(way_deg / 57.29577951),
                             z = -0.2 + distance_m * std::cos(way_deg / 57.29577951);
                const std::string point =
                    "(" + std::to_string(x) + ", 0, " + std::to_string(z) + ") m";
                const std::string call =
                    "go(" + point + ", facing: " + std::to_string(facing) + " deg)";
                CAPTURE(call);
                CAPTURE(height_m);
                const Played p =
                    play("at (0.4, 0, -0.2) m, facing 20 deg", height_m, {call, "idle()"});
                CHECK(p.performed.notes.empty());
                const SimTime end = p.row("p0").end;
                CHECK(length(p.stands(end) - Vec3{x, 0, z}) < 0.005);
                CHECK(std::fabs(std::remainder(p.heading_deg(end) - facing, 360)) < 0.1);
                if (number % 9 == 0) {
                    check_good(measured(p.performed, p.scene), call);
                }
            }
        }
    }
}

TEST_CASE("it goes before actors and props, and as fast as its place prescribes [unit]") {
    const std::string others =
        " rui: mannequin { at (0, 0, 3) m }\n box: box { size (0.2, 0.2, 0.2) m, at (2, 0.1, 0) m "
        "}\n";
    const Played to_actor = play("at (0, 0, 0) m", 1.75, {"go(rui)", "idle()"}, others);
    CHECK(length(to_actor.stands(to_actor.row("p0").end) - Vec3{0, 0, 3 - 0.91}) <
          0.03);  // it sways
    const Played to_prop =
        play("at (0, 0, 0) m", 1.75, {"go(box, before: 50 cm)", "idle()"}, others);
    CHECK(length(to_prop.stands(to_prop.row("p0").end) - Vec3{2, 0, 0}) ==
          doctest::Approx(0.5).epsilon(0.01));
    const Played timed = play("at (0, 0, 0) m", 1.75, {"go((0, 0, 3) m) takes 6 s", "idle()"});
    CHECK(timed.row("p0").end == SimTime{6 * kTicksPerSecond});
    CHECK(length(timed.stands(timed.row("p0").end) - Vec3{0, 0, 3}) < 0.005);
    check_good(measured(timed.performed, timed.scene), "a way of 6 s");
}

TEST_CASE("it walks to a seat, sits down on it, stays, does things there, and walks away [law]") {
    for (const double height_m : {1.5, 1.75, 1.9}) {
        CAPTURE(height_m);
        const Played p =
            play("at (0, 0, 0) m", height_m,
                 {"go((1.2, 0, 2) m, facing: 200 deg, seat: 45 cm)", "sit(45 cm)",
                  "idle(lasting: 3 s)", "eat(2)", "wave(2)", "bow(30 deg)", "look((0, 1, 1) m)",
                  "sit(45 cm)", "stand_up()", "go((-1, 0, 1) m)", "idle()"});
        CHECK(p.performed.notes.empty());
        check_good(measured(p.performed, p.scene), "a visit to a seat");
        // Its hips are over the seat from the end of sitting down to the beginning of standing up.
        const SimTime begin = p.row("p1").end, end = p.row("p8").start;
        for (SimTime t = begin; t < end; t = t + SimTime{kTicksPerSecond / 10}) {
            const Vec3 hips = p.hips(t);
            CHECK(length(Vec3{hips.x - 1.2, 0, hips.z - 2}) < 0.006);
            CHECK(std::fabs(hips.y - (0.45 + 0.052 * height_m)) < 0.005);
        }
        // It lives.
        const auto head = [&](SimTime t) { return p.at(t)[p.figure.head.value].translation; };
        const SimTime rests = p.row("p2").start;
        CHECK(length(head(rests + SimTime{kTicksPerSecond}) -
                     head(rests + SimTime{2 * kTicksPerSecond})) > 0.0005);
        CHECK(length(p.stands(p.row("p9").end) - Vec3{-1, 0, 1}) < 0.005);
    }
}

TEST_CASE("who sits and shall walk at once is told to stand up first [unit]") {
    for (const char* call : {"walk(steps: 2)", "turn(90 deg)", "jump()", "go((0, 0, 3) m)"}) {
        const Played p = play("at (0, 0, 0) m", 1.75, {"sit()", call, "idle()"});
        REQUIRE(p.performed.notes.size() == 1);
        CHECK(p.performed.notes[0].code == "seated");
    }
    const Played up = play("at (0, 0, 0) m", 1.75, {"sit()", "stand_up()", "walk(steps: 2)"});
    CHECK(up.performed.notes.empty());
}
